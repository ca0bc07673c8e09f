#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "station/core/number.hpp"
#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/protocol/protocol.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
namespace fs = std::filesystem;

namespace {

const std::string shipped = std::string(TURNPOINT_SOURCE_DIR) + "/protocols/";

protocol::Protocol with(const std::string& file, const std::string& from, const std::string& to) {
  auto source = core::read_file(shipped + file);
  const auto at = source.find(from);
  REQUIRE(at != std::string::npos);
  return protocol::parse(source.replace(at, from.size(), to), "p.toml");
}

const protocol::Block& block(const protocol::Protocol& protocol, std::size_t i) {
  return std::get<protocol::Block>(protocol.plan.at(i));
}

std::string instruction(const protocol::Block& block) {
  return std::get<std::string>(block.fixed.at("instruction"));
}

}  // namespace

TEST_CASE("every shipped protocol loads, and no two have the same id", "[protocol]") {
  std::map<std::string, std::string> ids;
  for (const auto* folder : {"", "gallery"})
    for (const auto& entry : fs::directory_iterator(shipped + folder)) {
      if (entry.path().extension() != ".toml") continue;
      INFO(entry.path().string());
      const auto protocol = protocol::load(entry.path().string());
      CHECK(protocol.id == entry.path().stem().string());
      CHECK(ids.emplace(protocol.id, protocol.path).second);
    }
  CHECK(ids.size() >= 10);
}

TEST_CASE("the demo has ten trials of boundary localisation with one tone", "[protocol]") {
  const auto demo = protocol::load(shipped + "demo.toml");
  REQUIRE(demo.procedures.size() == 1);
  CHECK(demo.procedures[0].values.size() * static_cast<std::size_t>(demo.procedures[0].repeats) == 10);
  CHECK(demo.task.kind == protocol::TaskKind::single_interval);
  CHECK(demo.task.question.size() == 3);
  CHECK(demo.languages == std::vector<std::string>{"en", "de", "ja"});
  const auto& scene = demo.scenes.at("edge");
  CHECK(protocol::evaluate(*scene.boundary_mm, {{"mark_mm", 150.0}, {"offset_mm", -12.0}}) == 138.0);
  CHECK(scene.edge.name == "p50");
  CHECK(demo.timing.iti_s.low == 0.6);
  CHECK_FALSE(demo.seed.has_value());
}

TEST_CASE("an answer is right if its comparison is true, and at 0 no answer is right", "[protocol]") {
  const auto demo = protocol::load(shipped + "demo.toml");
  REQUIRE(demo.task.correct_answer.size() == 2);
  const auto right = [&](double offset_mm) {
    std::string ids;
    for (const auto& [id, comparison] : demo.task.correct_answer)
      if (holds(comparison, {{"offset_mm", offset_mm}})) ids += id;
    return ids;
  };
  CHECK(right(-12) == "left");
  CHECK(right(12) == "right");
  CHECK(right(0).empty());
}

TEST_CASE("a scene takes from its base what it does not state, and zones are merged key by key",
          "[protocol]") {
  const auto change = protocol::load(shipped + "speed-accuracy.toml");
  const auto& after = change.scenes.at("after");
  REQUIRE(after.zone.has_value());
  CHECK(after.zone->from_mm == 60.0);
  CHECK(after.zone->tones == 3);
  CHECK(after.tolerance.level_dB == 0.1);
  CHECK(protocol::evaluate(*after.zone->friction, {{"change", -0.4}}) == Approx(0.39));
  CHECK(change.task.intervals == std::vector<std::vector<std::string>>{{"before", "after"}});
  CHECK(change.task.foreperiod_s->high == 2.5);
  const auto contrast = protocol::load(shipped + "friction-2ifc.toml");
  CHECK(contrast.scenes.at("comparison").friction_contrast_dB.has_value());
  CHECK_FALSE(contrast.scenes.at("reference").friction_contrast_dB.has_value());
}

TEST_CASE("a sequence runs A S S A for one participant and S A A S for the next", "[protocol]") {
  const auto protocol = protocol::load(shipped + "speed-accuracy.toml");
  const auto order = [&](int index) {
    std::string letters;
    for (const auto& block : block_order(protocol, index))
      letters += (block.practice ? "p" : "m") + instruction(block).substr(0, 1);
    return letters;
  };
  CHECK(order(0) == "pspamsmamams");
  CHECK(order(1) == "papsmamsmsma");
  CHECK(order(2) == order(0));
  CHECK_THROWS_AS(block_order(protocol, -1), std::invalid_argument);
}

TEST_CASE("in a Williams square each condition follows each other equally often", "[protocol]") {
  for (const int n : {2, 3, 4, 5, 6}) {
    std::string levels;
    for (int i = 0; i < n; ++i)
      levels += (i ? ", \"" : "\"") + std::string(1, static_cast<char>('a' + i)) + "\"";
    auto source = core::read_file(shipped + "speed-accuracy.toml");
    const auto factor = source.find("[scene.before]");
    source.insert(factor, "[[factor]]\nname = \"order\"\nlevels = [" + levels + "]\n");
    for (std::size_t at; (at = source.find("over = \"instruction\"")) != std::string::npos;)
      source.replace(at, 20, "over = \"order\"");
    source.replace(source.find("anticipation_s"), 0, "deadline_s = 3.0\n");
    source.replace(source.find("cycles = 2\n"), 11, "");
    source.replace(source.find("mirror = true"), 13, "");
    const auto protocol = protocol::parse(source, "p.toml");
    std::map<std::string, int> follows;
    const int rows = n % 2 == 0 ? n : 2 * n;
    for (int index = 0; index < rows; ++index) {
      std::string last;
      for (const auto& block : block_order(protocol, index)) {
        if (block.practice) continue;
        const auto here = std::get<std::string>(block.fixed.at("order"));
        if (!last.empty()) ++follows[last + here];
        last = here;
      }
    }
    CHECK(follows.size() == static_cast<std::size_t>(n * (n - 1)));
    for (const auto& [pair, count] : follows) CHECK(count == (n % 2 == 0 ? 1 : 2));
  }
}

TEST_CASE("arithmetic on factors is linear, with the usual precedence", "[protocol]") {
  const auto value = [](const std::string& expression) {
    const auto protocol = with("demo.toml", "\"mark_mm + offset_mm\"", "\"" + expression + "\"");
    return evaluate(*protocol.scenes.at("edge").boundary_mm, {{"mark_mm", 150.0}, {"offset_mm", -20.0}});
  };
  CHECK(value("mark_mm + offset_mm") == 130.0);
  CHECK(value("mark_mm - 0.5 * offset_mm") == 160.0);
  CHECK(value("2 * (mark_mm + offset_mm) / 4 - -1") == 66.0);
  CHECK(value("mark_mm * 2 - mark_mm") == 150.0);
  CHECK(value("abs(offset_mm - 30)") == 50.0);
  CHECK(value("+170.5e0") == 170.5);
}

TEST_CASE("factors can be multiplied, and the extremes of a product are found at the ends of their ranges",
          "[protocol]") {
  const auto source = [](const std::string& expression) {
    auto text = core::read_file(shipped + "friction-weber.toml");
    const std::string product = "\"reference * (1 - proportion)\"";
    text.replace(text.find(product), product.size(), "\"" + expression + "\"");
    return text;
  };
  const auto value = [&](const std::string& expression) {
    const auto protocol = protocol::parse(source(expression), "p.toml");
    return evaluate(*protocol.scenes.at("comparison").zone->friction,
                    {{"reference", 0.8}, {"proportion", 0.25}, {"end_mm", 185.0}});
  };
  CHECK(value("reference * (1 - proportion)") == Approx(0.6).epsilon(1e-15));
  CHECK(value("(1 - proportion) * reference") == Approx(0.6).epsilon(1e-15));
  CHECK(value("reference - proportion * reference") == Approx(0.6).epsilon(1e-15));
  CHECK(value("2 * reference * proportion / 4 + 0.5") == Approx(0.6).epsilon(1e-15));
  CHECK(value("(reference - 1) * (proportion - 1)") == Approx(0.15).epsilon(1e-15));
  CHECK(value("(reference - proportion) * (1 + 0) - 0.01 * reference * proportion * 2 * 0") ==
        Approx(0.55).epsilon(1e-15));
  // Friction must be below 1. The largest product is 0.85 * (1 + 0.17) in the first case, which is allowed,
  // and 0.85 * (1 + 0.18) in the second, which is not. Only the upper ends of both ranges together show this.
  CHECK_NOTHROW(protocol::parse(source("reference * (1 + 0.37 * proportion)"), "p.toml"));
  CHECK_THROWS_AS(protocol::parse(source("reference * (1 + 0.41 * proportion)"), "p.toml"), core::BadInput);
}

TEST_CASE("for_each makes one procedure for each level, and the block runs all of them", "[protocol]") {
  const auto protocol = protocol::load(shipped + "friction-weber.toml");
  REQUIRE(protocol.procedures.size() == 3);
  const std::vector<std::pair<std::string, double>> expected{
      {"weber-0.65", 0.65}, {"weber-0.75", 0.75}, {"weber-0.85", 0.85}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    auto name = expected[i].first;
    std::replace(name.begin(), name.end(), '.', '_');
    CHECK(protocol.procedures[i].name == name);
    CHECK(std::get<double>(protocol.procedures[i].with.at("reference")) == expected[i].second);
    CHECK(block(protocol, 1).procedures.at(i) == name);
  }
}

TEST_CASE("a grid in the file becomes values, with both ends exact", "[protocol]") {
  const auto oddity = protocol::load(shipped + "two-spots-oddity.toml");
  const auto& spec = oddity.procedures.at(0);
  REQUIRE(spec.stimuli.values.size() == 25);
  CHECK(spec.stimuli.values.front() == 2.0);
  CHECK(spec.stimuli.values.back() == 40.0);
  CHECK(spec.stimuli.values[12] == Approx(std::sqrt(80.0)).epsilon(1e-12));
  CHECK(spec.nuisance == std::vector<std::string>{"lapse"});
  const auto contrast = protocol::load(shipped + "friction-2ifc.toml");
  CHECK(contrast.procedures.at(0).threshold.values.size() == 28);
  CHECK(contrast.procedures.at(0).prior_threshold.normal->second == 8.0);
}

TEST_CASE("a copied procedure differs only in the keys that it states", "[protocol]") {
  const auto protocol = protocol::load(shipped + "boundary-adaptive.toml");
  const auto& upper = protocol.procedures.at(0);
  const auto& lower = protocol.procedures.at(1);
  CHECK(lower.name == "lower");
  CHECK(lower.start == -20.0);
  CHECK(lower.target == 0.25);
  CHECK(lower.step_down == upper.step_down);
  CHECK(lower.tracks == "right");
  CHECK(lower.stop.trials == 40);
}

TEST_CASE("blocks and sequences keep the order of the file", "[protocol]") {
  const auto protocol = protocol::load(shipped + "boundary-constant.toml");
  REQUIRE(protocol.plan.size() == 2);
  CHECK(block(protocol, 0).name == "practice");
  CHECK(block(protocol, 0).levels == std::vector<double>{-28, 28});
  CHECK(block(protocol, 0).pass->retries == 2);
  CHECK(block(protocol, 1).break_after->trials == 40);
}

TEST_CASE("the defaults that were used are named", "[protocol]") {
  const auto used = protocol::load(shipped + "no-touch-control.toml").defaults_used;
  const auto has = [&](const char* line) { return std::find(used.begin(), used.end(), line) != used.end(); };
  CHECK(has("random.seed = \"per-session\""));
  CHECK(has("scene.edge.ramp_ms = 50"));
  CHECK(has("block.no-touch.feedback = \"none\""));
  CHECK(has("resume.warmup = 0"));
  CHECK_FALSE(has("scene.edge.rove_dB = 2"));
}

TEST_CASE("a missing protocol file is bad input", "[protocol]") {
  CHECK_THROWS_AS(protocol::load("no/such/protocol.toml"), core::BadInput);
}

TEST_CASE("a file with far too many items, keys or bytes is refused within a second", "[protocol]") {
  const auto demo = core::read_file(shipped + "demo.toml");
  std::string factors, values, keys;
  for (int i = 0; i < 100'000; ++i)
    factors += "[[factor]]\nname=\"f" + std::to_string(i) + "\"\nlevels=[1]\n";
  for (int i = 0; i < 1'000'000; ++i) values += "1,";
  for (int i = 0; i < 50'000; ++i) keys += "a.";
  const auto refused = [](const std::string& source) -> std::string {
    [[maybe_unused]] const auto begin = std::clock();
    std::string said;
    try {
      protocol::parse(source, "p.toml");
    } catch (const core::BadInput& bad) {
      said = format(bad.problems().front());
    }
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    CHECK(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC < 1);
#endif
    return said;
  };
  const auto says = [&](const std::string& source, const char* part) {
    const auto said = refused(source);
    INFO(said);
    CHECK(said.find(part) != std::string::npos);
  };
  says(demo + factors, "at most 100");
  says(demo + "[more]\nx = [" + values + "1]\n", "at most 10000");
  says(demo + "[more]\n" + keys + "a = 1\n", "parts");
  const TemporaryFolder folder;
  std::ofstream(folder / "p.toml") << demo << "# " << std::string(core::most_text_bytes, '#') << "\n";
  CHECK_THROWS_AS(protocol::load(folder / "p.toml"), core::BadInput);
}

TEST_CASE("the samples of a table can stand in a file, and a session stores them with the protocol",
          "[protocol]") {
  const TemporaryFolder folder;
  auto text = core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/grating-periods.toml");
  const auto exchange = [&text](const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
  };
  exchange("shape = \"sine\"", "shape = \"table\", samples_file = \"grating.csv\"");
  exchange("shape = \"sine\"", "samples_file = 'grating.csv', shape = \"table\"");
  const auto file = folder / "p.toml", table = folder / "grating.csv";
  std::ofstream(file) << text;
  const auto write = [&table](const std::string& numbers) { std::ofstream(table) << numbers; };
  const auto refused = [&] {
    try {
      protocol::load(file);
    } catch (const core::BadInput& error) {
      std::string all;
      for (const auto& problem : error.problems()) all += format(problem) + "\n";
      return all;
    }
    return std::string("not refused");
  };
  const auto contains = [](const std::string& all, const std::string& what) {
    return all.find(what) != std::string::npos;
  };
  CHECK(contains(refused(), file + ":25:"));
  CHECK(contains(refused(), "grating.csv cannot be read"));
  write(
      "\xEF\xBB\xBF"
      "share\r\n0\r\n0.25\r\n1\r\n  0.125 \r\n\r\n");
  const auto loaded = protocol::load(file);
  const auto samples = [](const protocol::Protocol& from, const char* scene) {
    return from.scenes.at(scene).follow->parts.at(0).samples;
  };
  const std::vector<double> expected{0, 0.25, 1, 0.125};
  CHECK(samples(loaded, "standard") == expected);
  CHECK(samples(loaded, "comparison") == expected);
  CHECK(contains(loaded.source, "samples = [0, 0.25, 1, 0.125]"));
  CHECK_FALSE(contains(loaded.source, "samples_file"));
  CHECK(contains(loaded.source, "\n# samples of line 25: grating.csv, SHA-256 " +
                                    core::sha256(core::read_file(table)) + "\n# samples of line "));
  CHECK(loaded.sha256 == core::sha256(loaded.source));
  // All lines but those of the tables are as they were, so messages name the lines of the file.
  std::istringstream before(text), after(loaded.source);
  int others = 0;
  for (std::string was, is; std::getline(before, was) && std::getline(after, is);)
    others += was != is ? 1 : 0;
  CHECK(others == 2);
  // A resumed session needs no file, and what is stored is never completed again.
  std::filesystem::remove(table);
  const auto resumed = protocol::parse(loaded.source, "elsewhere/p.toml");
  CHECK(samples(resumed, "standard") == expected);
  CHECK(resumed.source == loaded.source);
  write("0\n0.5\n1\n");
  CHECK(protocol::load(file).sha256 != loaded.sha256);
  write("0\n0.5\n\n1.5\n");
  CHECK(contains(refused(), "grating.csv:4:1: \"1.5\" is not a number from 0 to 1"));
  write("0\n0,5\n");
  CHECK(contains(refused(), "grating.csv:2:1: \"0,5\" is not a number"));
  write("share\nshare\n0\n1\n");
  CHECK(contains(refused(), "grating.csv:2:1:"));
  write("nan\n0\n1\n");
  CHECK(contains(refused(), "grating.csv:1:1:"));
  write("1\n");
  CHECK(contains(refused(), "has 1 numbers; allowed: 2 to 2048"));
  std::string many;
  for (int k = 0; k < 2049; ++k) many += "0.5\n";
  write(many);
  CHECK(contains(refused(), "has 2049 numbers; allowed: 2 to 2048"));
  write("0\n1\n");
  exchange("samples_file = \"grating.csv\"", "samples_file = \"grating.csv\", samples = [0, 1]");
  std::ofstream(file) << text;
  CHECK(contains(refused(), "both \"samples\" and \"samples_file\""));
}
