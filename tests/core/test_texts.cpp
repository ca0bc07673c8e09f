// Tests the catalogues of the station's texts, which have one file per language.
#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <stdexcept>

#include "physics/boundary_fit.hpp"
#include "physics/boundary_map.hpp"
#include "physics/centre_line.hpp"
#include "physics/field.hpp"
#include "physics/warning.hpp"
#include "physics/zone.hpp"
#include "station/core/fault.hpp"
#include "station/core/read_file.hpp"
#include "station/core/texts.hpp"
#include "station/core/toml.hpp"
#include "station/store/error.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

std::set<std::string> keys_of(const std::string& language) {
  std::set<std::string> keys;
  for (const auto& [key, said] : core::catalogue(language)) keys.insert(key);
  return keys;
}

std::multiset<std::string> places_in(const std::string& said) {
  static const std::regex place("%[0-9]");
  return {std::sregex_token_iterator(said.begin(), said.end(), place), std::sregex_token_iterator()};
}

/// A word of an English sentence that no text in another language contains; "" if there is none. Names of
/// commands, files and settings are not sentences.
std::string english_word(const std::string& said) {
  static const std::regex word(
      "\\b(the|is|are|of|and|or|with|have|cannot|be|by|from|this|that|which|than)\\b");
  std::smatch found;
  return std::regex_search(said, found, word) ? found.str() : "";
}

/// The source of a file without comments and without messages that are thrown.
std::string code_of(const std::string& file) {
  static const std::regex comment("//[^\n]*|#include[^\n]*|throw [^;]*;");
  return std::regex_replace(core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/" + file), comment, "");
}

/// All texts of a table of a catalogue, and of the tables in it, as the reader of TOML files finds them.
void collect(const core::Value& table, const std::string& above,
             std::map<std::string, std::string, std::less<>>& found) {
  for (const auto& [key, place, value] : table.entries)
    if (value.kind == core::Value::Kind::table)
      collect(value, above + key + ".", found);
    else if (key != "read_by_native_speaker")
      found[above + key] = value.string;
}

/// All quoted words in the station's sources, and the words among them that are given to text().
struct Quoted {
  std::set<std::string> words, asked_for;
};

Quoted quoted() {
  static const std::regex word("\"([a-z_.]+)\""), use("\\b(?:text|fill)\\(\\s*\"([a-z_.]+)\"");
  Quoted all;
  const auto add = [](const std::regex& what, const std::string& source, std::set<std::string>& to) {
    for (std::sregex_iterator found(source.begin(), source.end(), what), end; found != end; ++found)
      to.insert((*found)[1]);
  };
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::string(TURNPOINT_SOURCE_DIR) + "/station")) {
    const auto kind = entry.path().extension();
    if (kind != ".cpp" && kind != ".hpp" && kind != ".qml") continue;
    const auto source = core::read_file(entry.path().string());
    add(word, source, all.words), add(use, source, all.asked_for);
  }
  return all;
}

}  // namespace

TEST_CASE("every language has the texts of the participant's pages and of faults; others may be English",
          "[texts]") {
  REQUIRE(core::languages() == std::vector<std::string>{"ar", "de", "en", "es", "ja", "zh"});
  for (const auto& language : core::languages()) {
    INFO(language);
    const auto keys = keys_of(language);
    for (const auto& key : keys_of("en")) {
      INFO(key);
      const bool needed = key.find('.') == std::string::npos || key.starts_with("fault.");
      if (needed) CHECK(keys.contains(key));
      if (!keys.contains(key)) CHECK(core::text(key, language) == core::text(key, "en"));
    }
    for (const auto& [key, said] : core::catalogue(language)) {
      INFO(key);
      CHECK_FALSE(said.empty());
      CHECK(places_in(said) == places_in(core::text(key, "en")));
    }
  }
}

TEST_CASE("a catalogue is a TOML file, and says what such a file says", "[texts]") {
  for (const auto& language : core::languages()) {
    const auto file = std::string(TURNPOINT_SOURCE_DIR) + "/station/core/texts/" + language + ".toml";
    std::map<std::string, std::string, std::less<>> found;
    collect(core::parse_toml(core::read_file(file), file), "", found);
    CHECK(found.size() > 500);
    CHECK(found == core::catalogue(language));
  }
}

TEST_CASE("no text in another language has kept an English sentence", "[texts]") {
  CHECK(english_word("the amplifier cannot be armed") == "the");
  CHECK(english_word("sudo swapoff -a").empty());
  for (const auto& language : core::languages()) {
    if (language == "en") continue;
    for (const auto& [key, said] : core::catalogue(language)) {
      INFO(language << " " << key << ": " << said);
      CHECK(english_word(said).empty());
      static const std::regex sentence("[a-z]{2,} [a-z]{2,} [a-z]{2,}");
      const auto& english = core::text(key, "en");
      if (std::regex_search(english, sentence)) CHECK(said != english);
    }
  }
}

TEST_CASE("what the screen and the command line both say is never a sentence in the sources", "[texts]") {
  static const std::regex quoted("\"([^\"\n]*)\"");
  for (const char* file :
       {"station/maintenance/doctor.cpp", "station/io/probe.cpp", "station/session/self_test.cpp",
        "station/session/self_test_rig.cpp", "station/analysis/course.cpp", "station/analysis/diffusion.cpp",
        "station/analysis/finger.cpp", "station/analysis/judgements.cpp", "station/analysis/mixed_fit.cpp",
        "station/analysis/psychometric_fit.cpp", "station/analysis/psychometric_posterior.cpp",
        "station/analysis/response_signal.cpp", "station/analysis/settings.cpp", "station/analysis/trade.cpp",
        "station/report/summary.cpp", "station/rig/calibration.cpp", "station/session/exposure.cpp"}) {
    const auto code = code_of(file);
    CHECK(code.size() > 1000);
    for (std::sregex_iterator found(code.begin(), code.end(), quoted), end; found != end; ++found) {
      if ((*found)[1] == "time outside the decision" || (*found)[1] == " of ")
        continue;  // measures' names in exports
      INFO(file << ": " << (*found)[1]);
      CHECK(english_word((*found)[1]).empty());
    }
  }
}

// The test does not look at messages of the system, at errors of the program itself, or at what only goes to
// a log.
TEST_CASE("what the operator's pages show is never a sentence in their sources, nor where it is thrown",
          "[texts]") {
  static const std::regex quoted("\"([^\"\n]*)\""),
      left_out("//[^\n]*|#include[^\n]*|(logic_error|system_error|qWarning)[^;]*;");
  const std::string root = std::string(TURNPOINT_SOURCE_DIR) + "/";
  std::vector<std::string> files;
  for (const char* file : {"station/maintenance/force_weights.cpp", "station/maintenance/bridge_reader.cpp",
                           "station/maintenance/disks.cpp", "station/maintenance/panel_latency.cpp",
                           "station/session/prepare.cpp", "station/rig/fits.cpp"})
    files.push_back(root + file);
  for (const auto& entry : std::filesystem::directory_iterator(root + "station/ui/operator"))
    if (entry.path().extension() == ".cpp") files.push_back(entry.path().string());
  CHECK(files.size() > 20);
  for (const auto& file : files) {
    const auto code = std::regex_replace(core::read_file(file), left_out, "");
    for (std::sregex_iterator found(code.begin(), code.end(), quoted), end; found != end; ++found) {
      INFO(file << ": " << (*found)[1]);
      const auto words = (*found)[1].str();
      CHECK((words.find(' ') == std::string::npos || english_word(words).empty()));
    }
  }
}

TEST_CASE("one thing has one word on the screen, on the command line and in the pages", "[texts]") {
  const std::string root = TURNPOINT_SOURCE_DIR;
  // the words that are not used, from the glossary's second table
  std::string words;
  static const std::regex row("\n\\| ([^|\n]+) \\| [^|\n]+ \\|"), comma(", ");
  const auto glossary = core::read_file(root + "/station/glossary.md");
  const auto listed = glossary.substr(glossary.find("## Words that are not used"));
  for (std::sregex_iterator found(listed.begin(), listed.end(), row), end; found != end; ++found)
    if ((*found)[1] != "instead of")
      words += (words.empty() ? "" : "|") + std::regex_replace((*found)[1].str(), comma, "|");
  REQUIRE(words.starts_with("subject|testee|"));
  const std::regex unused("\\b(" + words + ")s?\\b", std::regex::icase);
  const auto in = [&](const std::string& text) {
    std::smatch found;
    return std::regex_search(text, found, unused) ? found.str() : "";
  };
  CHECK(in("All Subjects sit down") == "Subjects");
  CHECK(in("the subjective point").empty());

  for (const auto& [key, said] : core::catalogue("en")) {
    INFO(key << ": " << said);
    CHECK(in(said).empty());
    const bool for_participants = key.find('.') == std::string::npos || key.starts_with("fault.");
    CHECK((for_participants || said.find("xperimenter") == std::string::npos));
  }
  static const std::regex quoted("\"([A-Za-z-][^\"\n]* [^\"\n]*)\""),
      address("\\(?(https?|file):[^ )]*|`[^`]*`");
  for (const auto* folder : {"station", "protocols", "deploy", "physics"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root + "/" + folder)) {
      const auto path = entry.path().string();
      INFO(path);
      if (path.ends_with(".md") && !path.ends_with("glossary.md"))
        CHECK(in(std::regex_replace(core::read_file(path), address, "")).empty());
      if (path.find("/station/cli/") == std::string::npos || !path.ends_with(".cpp")) continue;
      const auto source = core::read_file(path);
      for (std::sregex_iterator found(source.begin(), source.end(), quoted), end; found != end; ++found)
        CHECK(in((*found)[1]).empty());
    }
}

TEST_CASE("who is asked to slide reads that it is on the surface, not on the glass of the screen",
          "[texts]") {
  const std::map<std::string, std::string> surface{{"ar", "\u0627\u0644\u0633\u0637\u062d"},
                                                   {"de", "Oberfl\u00e4che"},
                                                   {"en", "surface"},
                                                   {"es", "superficie"},
                                                   {"ja", "\u8868\u9762"},
                                                   {"zh", "\u8868\u9762"}};
  for (const auto& language : core::languages())
    for (const char* key : {"slide_here", "slide_now", "stroke_now", "training_text", "measuring_text"}) {
      INFO(language << " " << key << ": " << core::text(key, language));
      CHECK(core::text(key, language).find(surface.at(language)) != std::string::npos);
    }
}

TEST_CASE("a number that can be one stands behind its noun", "[texts]") {
  static const std::regex many(
      "%[0-9] (points|days|sessions|files|copies|tones|trials|participants|answers|pages|studies)\\b");
  // these numbers are at least 2: a shorter time is said in hours, an export has several files
  const std::set<std::string> never_one{"backup_old", "backup_days", "operator.ago_days",
                                        "operator.exported"};
  int seen = 0;
  for (const auto& [key, said] : core::catalogue("en")) {
    const auto table = key.substr(0, key.find('.'));
    if (key != table && table != "operator" && table != "state" && table != "live" && table != "design")
      continue;
    INFO(key << ": " << said);
    const bool found = std::regex_search(said, many);
    seen += found ? 1 : 0;
    CHECK((!found || never_one.contains(key)));
  }
  CHECK(seen == static_cast<int>(never_one.size()));
}

TEST_CASE("every text is used, and every text that the program requests exists", "[texts]") {
  const auto source = quoted();
  const auto keys = keys_of("en");
  CHECK(source.asked_for.size() > 40);
  for (const auto& key : source.asked_for) {
    INFO(key);
    CHECK(keys.count(key) == 1);
  }
  std::set<std::string> of_faults{"fault.safe"};
  for (const auto kind : core::fault_kinds)
    for (const char* part : {".called", ".happened", ".safe", ".to_do"})
      of_faults.insert(std::string("fault.") + core::name(kind) + part);
  for (const auto cause : core::proof_causes)
    of_faults.insert(std::string("proof_cause.") + core::name(cause));
  for (const char* code : physics::warning_codes) of_faults.insert(std::string("physics_warning.") + code);
  for (const char* code : physics::refusal_codes) of_faults.insert(std::string("physics_refusal.") + code);
  for (const char* name : store::store_error_names) of_faults.insert(std::string("store_error.") + name);
  const auto schema = core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/protocol.schema.json");
  const auto goals = core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/station/view/goals.cpp");
  for (const auto& key : keys) {
    INFO(key);
    // The designer asks for the text of every key that the schema knows, and of every goal.
    const auto last = "\"" + key.substr(key.rfind('.') + 1) + "\"";
    if (key.starts_with("design.keys.")) {
      CHECK(schema.find(last) != std::string::npos);
      continue;
    }
    if (key.starts_with("design.words.")) {  // design.words.KEY.VALUE
      const auto name = key.substr(13, key.rfind('.') - 13);
      CHECK(schema.find("\"" + name + "\"") != std::string::npos);
      CHECK(schema.find(last) != std::string::npos);
      continue;
    }
    if (key.starts_with("design.goals.")) {
      CHECK(goals.find("{" + last) != std::string::npos);
      continue;
    }
    CHECK((source.words.count(key) == 1 || of_faults.count(key) == 1));
  }
  for (const auto kind : core::fault_kinds) {
    INFO(core::name(kind));
    CHECK(keys.count(std::string("fault.") + core::name(kind) + ".happened") == 1);
    CHECK(keys.count(std::string("fault.") + core::name(kind) + ".to_do") == 1);
  }
}

TEST_CASE(
    "de-CH gives German, an unknown language gives English, and an unknown key is an error of the program",
    "[texts]") {
  CHECK(core::text("proceed", "de-CH") == "Weiter");
  CHECK(core::text("proceed", "fi") == "Continue");
  CHECK_THROWS_AS(core::text("no_such_key", "en"), std::logic_error);
}

TEST_CASE("a phrase is said in a language that is chosen later", "[texts]") {
  const auto range =
      core::Phrase{"check.range", "", {core::plain("5 %1"), core::plain("4"), core::plain("6")}};
  const core::Phrase phrase{"check.minutes", "", {range}};
  CHECK(core::say(phrase, "en") == "5 %1 (4 to 6) min");
  CHECK(core::say(phrase, "de") == "5 %1 (4 bis 6) min");
  CHECK(core::say(core::plain("50 %"), "ja") == "50 %");
  // in Arabic, which runs from right to left, a value is kept apart from the sentence around it
  CHECK(core::say(core::phrase("below %1", {core::plain("-30")}), "ar") == "below \u2068-30\u2069");
  CHECK(core::say(core::phrase("a sentence of no catalogue"), "de") == "a sentence of no catalogue");
  CHECK(core::say({"", "", {core::plain("main: "), {"practice", "", {}}}}, "de") == "main: \u00dcbung");
  CHECK(core::say({"check.range", "", {core::plain("1")}}, "en") == "1 (%2 to %3)");
  CHECK_THROWS_AS(core::say({"no_such_key", "", {}}, "en"), std::logic_error);
}

TEST_CASE("a fault and a cause are named in each language, in English as in messages", "[texts]") {
  for (const auto kind : core::fault_kinds) {
    CHECK(core::say(core::phrase_of({kind, ""}), "en") == core::describe(kind));
    for (const auto& language : core::languages())
      if (language != "en") CHECK(core::say(core::phrase_of({kind, ""}), language) != core::describe(kind));
  }
  for (const auto cause : core::proof_causes)
    if (cause != core::ProofCause::none)
      CHECK(core::say(core::phrase_of(cause), "en") == core::describe(cause));
  const core::Fault gone{core::FaultKind::lines_gone, "No such device"};
  CHECK(core::say(core::phrase_of(gone), "en") == core::describe(gone));
  CHECK(core::say(core::phrase_of(gone), "de") == "GPIO-Leitungen getrennt: No such device");
}

TEST_CASE("the physics library's warnings are said in each language, in English as the library says them",
          "[texts]") {
  using namespace physics;
  std::map<std::string, Warning> warnings;
  const auto gather = [&](const Surface& surface, double frequency_Hz) {
    const Tone tone{frequency_Hz, 1e-6, 0};
    for (const auto& one : surface_warnings(surface)) warnings[one.code] = one;
    for (const auto& one : tone_warnings(surface, {&tone, 1})) warnings[one.code] = one;
  };
  auto brass = seed_brass();
  for (const double frequency_Hz : {1e3, 20e3, 45e3, 200e3}) gather(brass, frequency_Hz);
  auto cut = brass;
  cut.length_m /= 4;
  gather(cut, 45e3);
  const Tone resonant{nearest_resonance_Hz(brass, 19600).value() * (1 + 1e-7), 1, 0};
  const double x_m = 0.1;
  const auto field = evaluate(brass, {&resonant, 1}, {&x_m, 1}, Model::mode, Normalise::drive);
  for (const auto& one : describe(brass, {&resonant, 1}, field).warnings) warnings[one.code] = one;
  brass.tension_Pa = 100e6;
  brass.modulus_Pa = 100e9;
  brass.poisson = 0.34;
  brass.bending = Bending::off;
  brass.yield_strength_Pa = 90e6;
  gather(brass, 45e3);
  auto plate = aluminium_plate();
  plate.theory = PlateTheory::kirchhoff;
  gather(plate, 45e3);
  plate.quality_factor = 1e6;
  gather(plate, 45e3);
  auto rubber = seed_brass();
  rubber.density_kg_m3 = 1000, rubber.tension_Pa = 17640, rubber.thickness_m = 0.02e-3;
  rubber.taper = LinearTaper{0.05, 0.1};
  gather(rubber, 30);
  for (double frequency_Hz = 23e3; frequency_Hz < 24e3; frequency_Hz += 10) gather(plate, frequency_Hz);

  for (const char* code : warning_codes) {
    INFO(code);
    REQUIRE(warnings.count(code) == 1);
    core::Phrase phrase{std::string("physics_warning.") + code, "", {}};
    for (const auto& value : warnings[code].values) phrase.values.push_back(core::plain(value));
    CHECK(core::say(phrase, "en") == warnings[code].text);
    for (const auto& language : core::languages())
      for (const auto& value : warnings[code].values)
        CHECK(core::say(phrase, language).find(value) != std::string::npos);
  }
}

TEST_CASE("what the physics library refuses is said in each language, in English as the library says it",
          "[texts]") {
  using namespace physics;
  std::map<std::string, Statement> refusals;
  const auto gather = [&](const auto& attempt) {
    try {
      attempt();
    } catch (const Refused& refused) {
      refusals[refused.why().code] = refused.why();
    }
  };
  const auto brass = seed_brass();
  auto strip = brass;
  std::get<LinearTaper>(strip.taper).slope = 0;
  gather([&] { BoundaryMap(strip, {}); });
  auto lossy = brass;
  lossy.quality_factor = 2;
  auto cut = brass;
  cut.length_m /= 4;
  auto lossless = cut;
  lossless.quality_factor = std::numeric_limits<double>::infinity();
  for (const auto& surface : {brass, lossy, cut, lossless})
    for (double frequency_Hz = 1e3; frequency_Hz < 60e3; frequency_Hz *= 1.1)
      gather([&] { drive_amplitude_m(surface, frequency_Hz, 1e-6); });
  const MeasuredBoundary low{5e3, 0.15, 1e-3}, vague{30e3, 0.15, 0};
  auto plate = aluminium_plate();
  for (const auto* one : {&low, &vague}) gather([&] { fit_boundaries(plate, {}, {one, 1}); });
  plate.sd.thickness_m = 0.02 * plate.thickness_m;
  gather([&] { fit_boundaries(plate, {}, {&low, 1}); });
  const auto zone = [&](const auto& change) {
    gather([&] {
      ZoneRequest request;
      request.from_m = 0.02, request.boundary_m = 0.06, request.friction = 0.7, request.tones = 1;
      request.band = {20e3, 60e3, 500};
      change(request);
      design_zone(brass, FrictionMap(), request);
    });
  };
  zone([](ZoneRequest& r) { r.boundary_m = 1; });
  zone([](ZoneRequest& r) { r.friction = 0.01; });
  zone([](ZoneRequest& r) { r.edge = Edge::friction(0.5); });
  zone([](ZoneRequest& r) { r.band = {59e3, 60e3, 500}; });
  CHECK(refusals.size() >= 8);
  for (const auto& [code, refusal] : refusals) {
    INFO(code);
    CHECK(std::count(refusal_codes.begin(), refusal_codes.end(), code) == 1);
    core::Phrase phrase{"physics_refusal." + code, "", {}};
    for (const auto& value : refusal.values) phrase.values.push_back(core::plain(value));
    CHECK(core::say(phrase, "en") == refusal.text);
    for (const auto& language : core::languages())
      for (const auto& value : refusal.values)
        CHECK(core::say(phrase, language).find(value) != std::string::npos);
  }
}

TEST_CASE("a language is known to be spoken or not, and to have been read by a native speaker or not",
          "[texts]") {
  CHECK(core::translation("en-GB") == core::Translation::read);
  CHECK(core::translation("de-CH") == core::Translation::participant_read);
  CHECK(core::translation("ar") == core::Translation::unread);
  CHECK(core::translation("fi") == core::Translation::none);
}

TEST_CASE("what a participant reads of a fault has no path and no error code", "[texts]") {
  // a path, what SQLite or the C library says of an error, and names of errors
  static const std::regex raw(
      "/|\\\\|sqlite|SQL|errno|[Nn]o "
      "such|Input/output|\\bE[A-Z]{3,}\\b|[A-Z]\\w*(Error|Exception)\\b|0x[0-9a-f]|status [0-9]");
  CHECK(std::regex_search("/srv/lab.db: SQLITE_FULL", raw));
  for (const auto& language : core::languages())
    for (const auto kind : core::fault_kinds) {
      const auto text = core::fault_text(kind, language);
      for (const auto& said : {text.happened, text.safe, text.to_do}) {
        INFO(language << " " << core::name(kind) << ": " << said);
        CHECK_FALSE(std::regex_search(said, raw));
      }
    }
}

TEST_CASE("every fault says what happened, what is safe and what to do in each language", "[texts]") {
  std::set<std::string> pages;
  for (const auto kind : core::fault_kinds)
    for (const auto& language : core::languages()) {
      const auto text = core::fault_text(kind, language);
      INFO(core::name(kind) << " " << language);
      CHECK_FALSE(text.happened.empty());
      CHECK_FALSE(text.safe.empty());
      CHECK_FALSE(text.to_do.empty());
      if (language != "en") CHECK(text.happened != core::fault_text(kind, "en").happened);
      CHECK(pages.insert(text.happened).second);  // two kinds of fault must not have the same text
    }
  CHECK(core::fault_text(core::FaultKind::amplifier, "fi").safe ==
        core::fault_text(core::FaultKind::amplifier, "en").safe);
}
