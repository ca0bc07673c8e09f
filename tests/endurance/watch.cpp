#include "tests/endurance/watch.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "station/store/error.hpp"
#include "station/store/read.hpp"

namespace endurance {

using namespace turnpoint;
using session::PageKind;

namespace {

// time within which the guard guarantees to switch the amplifier off
constexpr std::int64_t kAtOnce_ns = 1'000'000;
// time allowed after the last stimulus for ramp, converter and amplifier
constexpr std::int64_t kTail_ns = 250'000'000;
constexpr std::size_t kEnough = 8;  // number of memory samples needed to judge growth

bool is_trial_page(PageKind kind) {
  return kind == PageKind::cue || kind == PageKind::stimulus || kind == PageKind::pause ||
         kind == PageKind::adjust;
}

}  // namespace

bool AmplifierWatch::must_be_low() const { return !armed_ || !present_.empty(); }

std::string AmplifierWatch::why_low() const {
  return !present_.empty() ? *present_.begin() + " lasts" : "not armed since: " + last_cause_;
}

// Checks the time since the last check, during which nothing changed.
void AmplifierWatch::check(std::int64_t until_ns) {
  const auto from_ns = std::exchange(now_ns_, std::max(now_ns_, until_ns));
  if (!high_) return;
  high_ns_ += now_ns_ - from_ns;
  if (told_) return;
  const bool unsafe = must_be_low() && now_ns_ - std::max(from_ns, low_since_ns_) > kAtOnce_ns;
  const bool idle = !trial_page_ && now_ns_ - std::max(page_ns_, on_since_ns_) > kTail_ns;
  if (!unsafe && !idle) return;
  told_ = true;
  violations_.push_back(fmt::format("amplifier: on at {:.3f} s, {}", 1e-9 * static_cast<double>(now_ns_),
                                    unsafe ? why_low() : "with no trial on the screen"));
}

void AmplifierWatch::line(std::int64_t time_ns, bool high) {
  check(time_ns);
  if (high == high_) return;
  ++changes_;
  high_ = high;
  told_ = false;
  if (!high) {
    if (!highs_.empty()) highs_.back().second = now_ns_;
    return;
  }
  on_since_ns_ = now_ns_;
  highs_.emplace_back(now_ns_, INT64_MAX);
  if (!must_be_low()) return;
  told_ = true;
  violations_.push_back(
      fmt::format("amplifier: switched on at {:.3f} s, {}", 1e-9 * static_cast<double>(now_ns_), why_low()));
}

void AmplifierWatch::begin(std::int64_t time_ns) {
  cause(time_ns, "the program's start");
  stimuli_.clear();
  highs_.clear();
}

void AmplifierWatch::cause(std::int64_t time_ns, const std::string& what) {
  check(time_ns);
  armed_ = false;
  last_cause_ = what;
  low_since_ns_ = now_ns_;
}

void AmplifierWatch::armed(std::int64_t time_ns) {
  check(time_ns);
  if (!present_.empty())
    violations_.push_back(fmt::format("amplifier: armed at {:.3f} s while {} lasts",
                                      1e-9 * static_cast<double>(now_ns_), *present_.begin()));
  armed_ = true;
}

void AmplifierWatch::page(std::int64_t time_ns, PageKind kind) {
  check(time_ns);
  if (trial_page_ || is_trial_page(kind)) page_ns_ = now_ns_;
  trial_page_ = is_trial_page(kind);
}

void AmplifierWatch::trial_ended(std::int64_t time_ns, bool answered, std::int64_t answered_ns) {
  check(time_ns);
  for (const auto& [on_ns, off_ns] : stimuli_) {
    if (!answered) break;
    const auto until_ns = std::min(off_ns, answered_ns);
    const bool driven = std::any_of(highs_.begin(), highs_.end(), [&, on = on_ns](const auto& high) {
      return high.first <= on && high.second >= until_ns;
    });
    if (!driven)
      violations_.push_back(fmt::format("amplifier: off during the stimulus at {:.3f} s of an answered trial",
                                        1e-9 * static_cast<double>(on_ns)));
  }
  stimuli_.clear();
  highs_.clear();
  if (high_) highs_.emplace_back(now_ns_, INT64_MAX);
}

namespace {

/// All research data of a trial as text, to compare trials.
std::string fingerprint(const core::TrialRow& row, bool times) {
  auto text = fmt::format("{}/{} {} {} {} {} {:016x}", row.trial_in_block, store::name(row.type),
                          row.procedure, row.level.value_or(0), store::name(row.outcome),
                          row.given.response.value_or("-"), row.learned.state_hash);
  for (const auto& tone : row.tones) text += fmt::format(" {:a} {:a}", tone.frequency_Hz, tone.amplitude_um);
  if (times)
    text += fmt::format(" {} {} {:a}", row.trial_index, row.timing.onset_ns,
                        row.timing.response_time_s.value_or(-1));
  return text;
}

std::vector<std::string> that_count(const store::StoredSession& session) {
  std::vector<std::string> trials;
  for (const auto& block : session.blocks)
    for (const auto& trial : block.trials)
      if (trial.type != core::TrialType::warmup && trial.outcome != core::Outcome::fault &&
          trial.outcome != core::Outcome::aborted)
        trials.push_back(fingerprint(trial, false));
  return trials;
}

}  // namespace

void TrialWatch::acknowledged(const std::string& session_id, const core::TrialRow& row) {
  kept_[{session_id, row.trial_index}] = fingerprint(row, true);
  ++total_;
}

namespace {

using Prints = std::map<std::pair<std::string, int>, std::string>;

Prints prints_in(const std::string& database) {
  Prints found;
  if (!std::ifstream(database)) return found;
  for (const auto& session : store::list_sessions(database))
    for (const auto& block : store::read_session(database, session.session_id).blocks)
      for (const auto& trial : block.trials)
        found[{session.session_id, trial.trial_index}] = fingerprint(trial, true);
  return found;
}

}  // namespace

void TrialWatch::check(const std::string& database, const std::string& when) {
  Prints found;
  try {
    found = prints_in(database);  // reading also makes SQLite check the file's pages
  } catch (const store::StoreError& error) {
    violations_.push_back(fmt::format("after {}: {}", when, error.what()));
  }
  for (const auto& [key, print] : kept_) {
    const auto there = found.find(key);
    if (there != found.end() && there->second == print) continue;
    ++lost_;
    violations_.push_back(fmt::format("trial lost: after {}: number {} of session {} {}", when, key.second,
                                      key.first, there == found.end() ? "is gone" : "has changed"));
  }
  kept_ = std::move(found);  // keep what was found, so that a lost trial is reported only once
}

void TrialWatch::compare(const std::string& database, const std::string& session_id,
                         const std::string& unbroken) {
  const auto broken = that_count(store::read_session(database, session_id));
  const auto whole =
      that_count(store::read_session(unbroken, store::list_sessions(unbroken).front().session_id));
  const auto [a, b] = std::mismatch(broken.begin(), broken.end(), whole.begin(), whole.end());
  if (a == broken.end() && b == whole.end()) return;
  violations_.push_back(fmt::format("session {}: its trial {} is not the unbroken session's: {} | {}",
                                    session_id, a - broken.begin(), a == broken.end() ? "none" : *a,
                                    b == whole.end() ? "none" : *b));
}

void MemoryWatch::sample() {
  ::malloc_trim(0);  // return unused memory to the system, so that only memory in use is measured
  std::ifstream statm("/proc/self/statm");
  double all = 0, resident = 0;
  statm >> all >> resident;
  samples_.push_back(resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1 << 20));
}

double MemoryWatch::growth_MiB() const {
  if (samples_.size() < kEnough) return 0;
  const auto middle = samples_.begin() + static_cast<std::ptrdiff_t>(samples_.size() / 2);
  return *std::max_element(middle, samples_.end()) - *std::max_element(samples_.begin(), middle);
}

}  // namespace endurance
