#include "station/view/choices.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>

#include "station/core/number.hpp"
#include "station/core/texts.hpp"
#include "station/protocol/interludes.hpp"
#include "station/store/backup.hpp"
#include "station/store/read.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::view {

CueAdvice cue_advice(const std::string& cue) {
  struct Keys {
    const char *name, *advice;
  };
  static const std::map<std::string, Keys> all{
      {"pitch", {"cue.pitch", "cue.pitch_advice"}},
      {"loudness", {"cue.loudness", "cue.loudness_advice"}},
      {"amplitude at the wide end", {"cue.amplitude", "cue.amplitude_advice"}},
      {"stripe pitch at the wide end", {"cue.stripes", "cue.stripes_advice"}},
      {"edge sharpness", {"cue.edge", "cue.edge_advice"}},
      {"strip width", {"cue.width", "cue.width_advice"}},
      {"duration", {"cue.duration", "cue.duration_advice"}},
      {"always the same key", {"cue.same_key", "cue.same_key_advice"}}};
  const auto found = all.find(cue);
  if (found == all.end()) throw std::logic_error("there is no advice for the cue \"" + cue + "\"");
  return {{found->second.name, "", {}}, {found->second.advice, "", {}}};
}

namespace fs = std::filesystem;

namespace {

using core::number;
using core::Phrase, core::phrase, core::plain;

/// Low, median and high as they are shown.
using Shown = std::array<std::string, 3>;

Shown shown(const rehearsal::Spread& spread, double unit) {
  const auto one = [unit](double value) { return number(std::round(value / unit * 10) / 10, 4); };
  return {one(spread.low), one(spread.median), one(spread.high)};
}

Phrase range(const rehearsal::Spread& spread, double unit) {
  const auto [low, median, high] = shown(spread, unit);
  return low == high ? plain(median) : phrase("check.range", {plain(median), plain(low), plain(high)});
}

std::string joined(const std::set<std::string>& list) {
  std::string text;
  for (const auto& item : list) text += (text.empty() ? "" : ", ") + item;
  return text;
}

void add_tones(const rehearsal::Check& check, CheckWords& words) {
  const auto& sights = check.survey.sights;
  if (sights.empty()) return;
  double low = sights.front().lowest_Hz, high = 0, moved_um = 0, friction = 1;
  for (const auto& sight : sights) {
    low = std::min(low, sight.lowest_Hz);
    high = std::max(high, sight.highest_Hz);
    moved_um = std::max(moved_um, sight.displacement_um);
    friction = std::min(friction, sight.lowest_friction);
  }
  const auto kHz = [](double Hz) { return plain(number(1e-3 * Hz, 4)); };
  words.facts.emplace_back(phrase("check.tones"), phrase("check.kilohertz", {kHz(low), kHz(high)}));
  words.facts.emplace_back(phrase("check.moves"), plain(number(moved_um, 3) + " \u00b5m"));
  words.facts.emplace_back(phrase("check.friction"), phrase("check.of_rest", {plain(number(friction, 3))}));
  words.facts.emplace_back(phrase("check.models"), plain(joined(check.survey.models)));
}

/// The visit to which a block belongs, its name and instruction, and its number of trials.
Phrase describe(const rehearsal::CheckedBlock& block) {
  Phrase title;
  if (block.session > 0) title.values.push_back({"check.session", "", {plain(block.session)}});
  if (!block.group.empty()) {
    if (!title.values.empty()) title.values.push_back(plain(", "));
    title.values.push_back({"check.group", "", {plain(block.group)}});
  }
  if (!title.values.empty()) title.values.push_back(plain(": "));
  title.values.push_back(plain(block.name));
  if (!block.instruction.empty() && block.instruction != block.name)
    title.values.push_back(plain(" (" + block.instruction + ")"));
  return {"check.block_trials",
          "",
          {title, range(block.trials, 1), phrase("check.minutes", {range(block.duration_s, 60)})}};
}

/// A number of the blocks of one part of the session: that of the only one or, if they differ, between which
/// values it lies in all of them.
Phrase range(const std::vector<const rehearsal::CheckedBlock*>& blocks,
             rehearsal::Spread rehearsal::CheckedBlock::*what, double unit) {
  auto whole = blocks.front()->*what;
  const auto first = shown(whole, unit);
  if (std::ranges::all_of(blocks, [&](const auto* block) { return shown(block->*what, unit) == first; }))
    return range(whole, unit);
  for (const auto* block : blocks) {
    whole.low = std::min(whole.low, (block->*what).low);
    whole.high = std::max(whole.high, (block->*what).high);
  }
  const auto [low, median, high] = shown(whole, unit);
  return plain(low == high ? low : low + "\u2013" + high);
}

/// How many of these blocks each visit has, as "4 × "; nothing if it is one.
std::string times(const std::vector<const rehearsal::CheckedBlock*>& blocks) {
  std::map<std::string, int> by_visit;
  for (const auto* block : blocks) ++by_visit[block->visit];
  const auto [least, most] = std::minmax_element(by_visit.begin(), by_visit.end(),
                                                 [](auto& a, auto& b) { return a.second < b.second; });
  if (most->second == 1) return "";
  const auto fewest = least->second == most->second ? "" : std::to_string(least->second) + "\u2013";
  return fewest + std::to_string(most->second) + " \u00d7 ";
}

void add_lengths(const rehearsal::Check& check, CheckWords& words) {
  std::map<std::string, std::vector<const rehearsal::CheckedBlock*>> by_name;
  const auto add_pages = [&](const std::vector<rehearsal::CheckedInterlude>& parts) {
    for (const auto& [kind, name, pages] : parts)
      if (pages > 0)
        words.lengths[{protocol::name(kind), name}] =
            phrase(kind == protocol::InterludeKind::questionnaire ? "design.number_of_questions"
                                                                  : "design.number_of_pages",
                   {plain(pages)});
  };
  for (const auto& block : check.blocks) {
    by_name[block.name].push_back(&block);
    add_pages(block.before);
    add_pages(block.after);
  }
  for (const auto& [name, blocks] : by_name) {
    const auto count = plain(times(blocks));
    words.lengths[{"block", name}] = {
        "",
        "",
        {phrase("operator.trials"), plain(": "), count, range(blocks, &rehearsal::CheckedBlock::trials, 1),
         plain("   \u00b7   "), count,
         phrase("check.minutes", {range(blocks, &rehearsal::CheckedBlock::duration_s, 60)})}};
  }
}

/// The parts of the session without trials, in the order in which they come.
void add_interludes(const std::vector<rehearsal::CheckedInterlude>& parts, CheckWords& words) {
  for (const auto& [kind, name, pages] : parts)
    words.facts.emplace_back(Phrase{std::string("design.keys.") + protocol::name(kind), "", {}},
                             pages > 1 ? phrase("check.pages", {plain(name), plain(pages)}) : plain(name));
}

void add_remarks(const std::vector<core::Problem>& problems, CheckWords::Remark::Kind kind,
                 CheckWords& words) {
  for (const auto& problem : problems)
    words.remarks.push_back({kind, fs::path(problem.place.file).filename().string(), problem.place.line,
                             problem.what, problem.allowed});
}

}  // namespace

std::vector<ProtocolEntry> list_protocols(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    // Skip hidden files such as the lock files of Emacs.
    if (entry.path().extension() == ".toml" && entry.path().filename().string().front() != '.')
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<ProtocolEntry> list;
  for (const auto& file : files) {
    ProtocolEntry entry;
    entry.path = file.string();
    try {
      const auto protocol = protocol::load(entry.path);
      entry.id = protocol.id, entry.version = protocol.version, entry.title = protocol.title;
      entry.languages = protocol.languages;
    } catch (const core::BadInput& bad) {
      for (const auto& problem : bad.problems()) entry.problems.push_back(phrase_of(problem));
    } catch (const std::exception& error) {
      // Keep the error with this file and continue, so that the list contains the other files too.
      entry.problems = {core::phrase_of(error)};
    }
    list.push_back(std::move(entry));
  }
  return list;
}

std::string folder_for_studies(const std::string& protocols, const std::string& database) {
  if (::access(protocols.c_str(), W_OK) == 0) return protocols;
  return (fs::absolute(database).parent_path() / "protocols").string();
}

std::vector<ProtocolEntry> list_studies(const std::string& protocols, const std::string& database) {
  auto list = list_protocols(protocols);
  const auto own = folder_for_studies(protocols, database);
  if (own != protocols && fs::is_directory(own))
    for (auto& entry : list_protocols(own)) list.push_back(std::move(entry));
  return list;
}

std::vector<std::string> known_participants(const std::string& database) {
  if (!fs::exists(database)) return {};
  return store::participants(database);
}

BackupNote backup_note(const std::string& database) {
  constexpr int old_hours = 7 * 24;
  const auto last = store::last_backup(database);
  if (!last) return {};
  const auto age_ns = system::realtime_ns() - last->realtime_ns;
  if (age_ns < 0) return {BackupNote::State::ahead, 0};
  const auto hours = static_cast<int>(age_ns / 3'600'000'000'000);
  return {hours < old_hours ? BackupNote::State::recent : BackupNote::State::old, hours};
}

std::optional<InterruptedNote> interrupted_note(const std::string& database) {
  if (!fs::exists(database)) return std::nullopt;
  const auto found = store::interrupted_session(database);
  if (!found) return std::nullopt;
  return InterruptedNote{found->session.session_id, found->session.start.participant,
                         found->session.start.protocol_id, found->session.trials, found->age_s};
}

CheckWords words_of(const rehearsal::Check& check) {
  CheckWords words;
  for (const auto& problem : check.problems) words.problems.push_back(phrase_of(problem));
  for (const auto& warning : check.warnings) words.warnings.push_back(phrase_of(warning));
  using Kind = CheckWords::Remark::Kind;
  add_remarks(check.problems, Kind::problem, words);
  add_remarks(check.warnings, Kind::warning, words);
  add_remarks(check.notes, Kind::note, words);
  if (!check.problems.empty()) return words;
  words.languages = check.languages;
  words.facts.emplace_back(phrase("operator.rig"), plain(check.rig_name));
  words.facts.emplace_back(phrase("operator.trials"), range(check.trials, 1));
  words.facts.emplace_back(phrase("check.duration"), phrase("check.minutes", {range(check.duration_s, 60)}));
  for (const auto& block : check.blocks) {
    add_interludes(block.before, words);
    words.facts.emplace_back(phrase(block.practice ? "practice" : "design.keys.block"), describe(block));
    add_interludes(block.after, words);
  }
  add_lengths(check, words);
  add_tones(check, words);
  for (const auto& cue : check.cues.reports) {
    const bool leaks = cue.above_chance();
    const auto percent = [](double share) { return plain(std::lround(100 * share)); };
    const auto [name, advice] = cue_advice(cue.cue);
    words.cues.push_back({cue.task.empty() ? name : Phrase{"", cue.task + ", ", {name}},
                          {"check.alone", "", {percent(cue.accuracy), percent(cue.chance)}},
                          leaks,
                          leaks ? advice : Phrase()});
  }
  std::stable_sort(words.cues.begin(), words.cues.end(),
                   [](const auto& a, const auto& b) { return a.leaks > b.leaks; });
  return words;
}

std::string age_in_words(double age_s) {
  if (age_s < 0) return "dated in the future: a clock was wrong";
  const auto whole = [](double value, const char* unit) { return number(std::floor(value), 4) + " " + unit; };
  if (age_s < 120) return whole(age_s, "s old");
  if (age_s < 7200) return whole(age_s / 60, "min old");
  if (age_s < 172800) return whole(age_s / 3600, "h old");
  return whole(age_s / 86400, "days old");
}

}  // namespace turnpoint::view
