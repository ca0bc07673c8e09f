#include "station/trial/machine.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "station/core/limits.hpp"

namespace turnpoint::trial {

namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

void check(const Timing& plan) {
  if (plan.intervals.empty())
    throw std::invalid_argument("trial: there is no interval; at least one is needed");
  if (plan.again < 0)
    throw std::invalid_argument("trial: the number of presentations is negative; it must be 0 or more");
  if (plan.answers < 1) throw std::invalid_argument("trial: there are no answers; at least one is needed");
  for (const auto time : {plan.signal_ns.value_or(0), plan.cue_ns, plan.deadline_ns, plan.anticipation_ns,
                          plan.feedback_ns, plan.late_ns, plan.iti_ns, plan.wrong_delay_ns,
                          plan.late_delay_ns, plan.early_delay_ns, plan.watermark_ns})
    if (time < 0) throw std::invalid_argument("trial: a time is negative; all times must be 0 or more");
  for (const auto& interval : plan.intervals) {
    std::int64_t last = 0;
    for (const auto start : interval.scene_starts_ns) {
      if (start < last || start > interval.duration_ns)
        throw std::invalid_argument("trial: scene starts must be in ascending order and within the interval");
      last = start;
    }
    if (interval.silence_ns < 0)
      throw std::invalid_argument("trial: a time is negative; all times must be 0 or more");
    if (interval.duration_ns <= 0)
      throw std::invalid_argument("trial: the duration of an interval must be above 0");
  }
  if (plan.correct && (*plan.correct < 0 || *plan.correct >= plan.answers))
    throw std::invalid_argument("trial: the index of the right answer is not one of the answers");
  if (plan.response_zero == ResponseZero::change && plan.intervals.back().scene_starts_ns.empty())
    throw std::invalid_argument(
        "trial: response_zero is the change of scene, but the last interval has only one scene");
}

}  // namespace

Machine::Machine(Timing plan)
    : plan_(std::move(plan)),
      onsets_ns_(plan_.intervals.size(), kNever),
      heard_(plan_.intervals.size(), false) {
  check(plan_);
}

std::vector<Action> Machine::start(std::int64_t now_ns) {
  if (phase_ != Phase::idle) throw std::logic_error("trial: start() was called twice");
  result_.started_ns = now_ns_ = now_ns;
  enter(Phase::cue, kNever);
  actions_.push_back({ActionKind::present, 0, now_ns + plan_.cue_ns});
  return std::exchange(actions_, {});
}

std::vector<Action> Machine::handle(const Event& event) {
  if (phase_ == Phase::idle || phase_ == Phase::done) return {};
  // First process everything that is due before this event. The time of an onset may lie in the future, so it
  // does not advance the machine's time.
  if (event.kind != EventKind::onset) now_ns_ = std::max(now_ns_, event.time_ns);
  advance(now_ns_);
  if (phase_ == Phase::done) return std::exchange(actions_, {});
  switch (event.kind) {
    case EventKind::tick:
      break;
    case EventKind::onset:
      onset(event);
      break;
    case EventKind::heard:
      heard_.at(static_cast<std::size_t>(event.value)) = true;
      present_again();
      break;
    case EventKind::answer:
      answer(event);
      break;
    case EventKind::touch:
      ++result_.extra_touches;
      break;
    case EventKind::again:
      again(event);
      break;
    case EventKind::contact:
      contact(event);
      break;
    case EventKind::xrun:
      ++result_.xruns;
      if (event.value != 0 && !decided()) end(Outcome::fault, event.time_ns);
      break;
    case EventKind::refuted:
      if (!decided()) end(Outcome::fault, event.time_ns);
      break;
    case EventKind::outside:
      repeat(event.time_ns);
      break;
    case EventKind::fault:
      conclude(Outcome::fault, event.time_ns);
      break;
    case EventKind::abort:
      conclude(Outcome::aborted, event.time_ns);
      break;
  }
  if (phase_ != Phase::done) advance(now_ns_);
  return std::exchange(actions_, {});
}

std::optional<std::int64_t> Machine::wake_ns() const {
  if (phase_ == Phase::idle || phase_ == Phase::done) return std::nullopt;
  // Until the outcome is final, the pause between trials has no fixed end: it ends with the last `heard`
  // event.
  if (phase_ == Phase::interval && !decided()) return std::nullopt;
  const bool answering = phase_ == Phase::stimulus || phase_ == Phase::response;
  const auto deadline = answering ? deadline_at() : kNever;
  auto wake = deadline == kNever ? until_ns_ : std::min(until_ns_, deadline + plan_.watermark_ns);
  if (answering) wake = std::min(wake, signal_at());
  return wake == kNever ? std::nullopt : std::optional(wake);
}

bool Machine::answers_open() const {
  if (phase_ == Phase::response) return true;
  const bool last = interval_ + 1 == static_cast<int>(plan_.intervals.size());
  return phase_ == Phase::stimulus && last && plan_.answer_ends_stimulus;
}

bool Machine::decided() const {
  if (phase_ == Phase::done) return true;
  return concluded_ && std::find(heard_.begin(), heard_.end(), false) == heard_.end();
}

void Machine::enter(Phase phase, std::int64_t until_ns) {
  phase_ = phase;
  until_ns_ = until_ns;
  actions_.push_back({ActionKind::enter, static_cast<int>(phase), until_ns});
}

// The first onset ends the cue; each later onset ends a gap.
void Machine::onset(const Event& event) {
  onsets_ns_.at(static_cast<std::size_t>(event.value)) = event.time_ns;
  if (phase_ == Phase::cue && event.value == 0) until_ns_ = event.time_ns;
}

void Machine::advance(std::int64_t now_ns) {
  while (step(now_ns)) {
  }
}

bool Machine::step(std::int64_t now_ns) {
  const bool answering = phase_ == Phase::stimulus || phase_ == Phase::response;
  if (answering && now_ns >= signal_at() && signal_at() <= until_ns_) {
    actions_.push_back({ActionKind::signal, interval_, signal_at()});
    signalled_ = true;
    return true;
  }
  if (answering && deadline_at() != kNever && now_ns >= deadline_at() + plan_.watermark_ns &&
      deadline_at() + plan_.watermark_ns <= until_ns_) {
    conclude(Outcome::timeout, deadline_at() + plan_.watermark_ns);
    return true;
  }
  if (until_ns_ == kNever || now_ns < until_ns_) return false;
  const auto at = until_ns_;
  switch (phase_) {
    case Phase::cue:
      begin_interval(at);
      return true;
    case Phase::stimulus:
      end_stimulus(at);
      return true;
    case Phase::gap:
      ++interval_;
      begin_interval(at);
      return true;
    case Phase::feedback:
    case Phase::late:
      enter(Phase::interval, at + pause_ns());
      return true;
    case Phase::interval:
      if (!decided()) return false;
      result_.ended_ns = at;
      enter(Phase::done, kNever);
      return false;
    default:
      return false;
  }
}

void Machine::begin_interval(std::int64_t onset_ns) {
  const auto& interval = plan_.intervals[static_cast<std::size_t>(interval_)];
  const bool last = interval_ + 1 == static_cast<int>(plan_.intervals.size());
  enter(Phase::stimulus, onset_ns + interval.duration_ns);
  if (!last) return;
  switch (plan_.response_zero) {
    case ResponseZero::go_cue:
      set_zero(onset_ns);
      break;
    case ResponseZero::change:
      set_zero(onset_ns + interval.scene_starts_ns.front());
      break;
    case ResponseZero::first_contact:
      if (touching_) set_zero(onset_ns);
      break;
    case ResponseZero::interval_off:
    case ResponseZero::lift_off:
      break;
  }
  no_contact_deadline_ns_ = onset_ns + interval.duration_ns + plan_.deadline_ns;
}

void Machine::end_stimulus(std::int64_t at_ns) {
  if (interval_ + 1 < static_cast<int>(plan_.intervals.size())) {
    enter(Phase::gap, onsets_ns_[static_cast<std::size_t>(interval_) + 1]);
    return;
  }
  if (plan_.response_zero == ResponseZero::interval_off) set_zero(at_ns);
  enter(Phase::response, kNever);
}

void Machine::set_zero(std::int64_t at_ns) {
  if (!result_.zero_ns) result_.zero_ns = at_ns;
}

std::int64_t Machine::deadline_at() const {
  if (result_.zero_ns) return *result_.zero_ns + plan_.deadline_ns;
  return no_contact_deadline_ns_.value_or(kNever);
}

// Returns when the response signal is due; kNever if there is none, if it was given, or if its time is not
// known yet.
std::int64_t Machine::signal_at() const {
  return plan_.signal_ns && !signalled_ && result_.zero_ns ? *result_.zero_ns + *plan_.signal_ns : kNever;
}

void Machine::contact(const Event& event) {
  touching_ = event.value != 0;
  if (phase_ != Phase::stimulus && phase_ != Phase::response) return;
  if (!touching_) lift_off_ns_ = event.time_ns;
  const bool last = interval_ + 1 == static_cast<int>(plan_.intervals.size());
  if (touching_ && last && plan_.response_zero == ResponseZero::first_contact) set_zero(event.time_ns);
  if (!touching_ && last && plan_.response_zero == ResponseZero::lift_off) set_zero(event.time_ns);
}

void Machine::answer(const Event& event) {
  if (phase_ == Phase::confidence) return confide(event);
  const bool valid = event.value >= 0 && event.value < plan_.answers;
  const bool late = deadline_at() != kNever && event.time_ns > deadline_at();
  if (!valid || !answers_open() || late) {
    ++result_.extra_touches;
    return;
  }
  if (!result_.zero_ns || event.time_ns < *result_.zero_ns + plan_.anticipation_ns) {
    conclude(Outcome::anticipation, event.time_ns);
    return;
  }
  result_.response = event.value;
  if (plan_.correct && event.value != plan_.unsure) result_.correct = event.value == *plan_.correct;
  result_.response_time_ns = event.time_ns - *result_.zero_ns;
  if (lift_off_ns_ && *lift_off_ns_ >= *result_.zero_ns) {
    result_.decision_time_ns = *lift_off_ns_ - *result_.zero_ns;
    result_.movement_time_ns = event.time_ns - *lift_off_ns_;
  }
  if (plan_.confidence == 0) return conclude(Outcome::answered, event.time_ns);
  if (phase_ == Phase::stimulus) actions_.push_back({ActionKind::silence, interval_, event.time_ns});
  enter(Phase::confidence, kNever);
}

void Machine::again(const Event& event) {
  const bool late = deadline_at() != kNever && event.time_ns > deadline_at();
  if (!may_ask_again() || late) {
    ++result_.extra_touches;
    return;
  }
  if (phase_ == Phase::stimulus) actions_.push_back({ActionKind::silence, interval_, event.time_ns});
  ++result_.again;
  result_.zero_ns.reset();
  no_contact_deadline_ns_.reset();
  interval_ = 0;
  asked_again_ = true;
  enter(Phase::cue, kNever);
  present_again();
}

// Presents the intervals that the participant has asked for, unless the trial has ended meanwhile.
void Machine::present_again() {
  if (!asked_again_ || phase_ != Phase::cue || std::find(heard_.begin(), heard_.end(), false) != heard_.end())
    return;
  asked_again_ = false;
  std::fill(onsets_ns_.begin(), onsets_ns_.end(), kNever);
  std::fill(heard_.begin(), heard_.end(), false);
  actions_.push_back({ActionKind::present, 0, now_ns_ + plan_.cue_ns});
}

void Machine::confide(const Event& event) {
  const auto answered_ns = *result_.zero_ns + *result_.response_time_ns;
  if (event.value < 0 || event.value >= plan_.confidence ||
      event.time_ns < answered_ns + core::kConfidenceGuard_ns) {
    ++result_.extra_touches;
    return;
  }
  result_.confidence = event.value + 1;
  result_.confidence_time_ns = event.time_ns - answered_ns;
  conclude(Outcome::answered, event.time_ns);
}

void Machine::conclude(Outcome outcome, std::int64_t at_ns) {
  const bool cut = outcome == Outcome::aborted || outcome == Outcome::fault;
  if (cut && !concluded_) return end(outcome, at_ns);
  if (cut) {
    // The trial has a result, but that is final only once all intervals were played without loss. If a fault
    // comes before that, end at once, without feedback.
    if (outcome == Outcome::fault && !decided()) return end(outcome, at_ns);
    return enter(Phase::interval, at_ns);
  }
  if (phase_ == Phase::stimulus) actions_.push_back({ActionKind::silence, interval_, at_ns});
  concluded_ = true;
  result_.outcome = outcome;
  settle(at_ns);
}

// Makes the trial void, so that it is presented again, and lets the page say why. An outcome of timeout or
// anticipation is kept.
void Machine::repeat(std::int64_t at_ns) {
  if (decided() || (concluded_ && result_.outcome != Outcome::answered)) return;
  if (phase_ == Phase::stimulus) actions_.push_back({ActionKind::silence, interval_, at_ns});
  forget_response();
  concluded_ = true;
  result_.outcome = Outcome::fault;
  settle(at_ns);
}

// Ends the trial at once, without a response.
void Machine::end(Outcome outcome, std::int64_t at_ns) {
  if (phase_ == Phase::cue || phase_ == Phase::stimulus || phase_ == Phase::gap)
    actions_.push_back({ActionKind::silence, interval_, at_ns});
  result_.outcome = outcome;
  forget_response();
  result_.ended_ns = at_ns;
  enter(Phase::done, kNever);
}

void Machine::forget_response() {
  result_.response.reset();
  result_.correct.reset();
  result_.response_time_ns.reset();
  result_.decision_time_ns.reset();
  result_.movement_time_ns.reset();
  result_.confidence.reset();
  result_.confidence_time_ns.reset();
}

void Machine::settle(std::int64_t at_ns) {
  if (result_.outcome != Outcome::answered && plan_.late_ns > 0)
    enter(Phase::late, at_ns + plan_.late_ns);
  else if (result_.outcome == Outcome::answered && plan_.feedback_ns > 0)
    enter(Phase::feedback, at_ns + plan_.feedback_ns);
  else
    enter(Phase::interval, at_ns + pause_ns());
}

// The pause after the trial, which is longer if the answer was not right.
std::int64_t Machine::pause_ns() const {
  switch (result_.outcome) {
    case Outcome::answered:
      return plan_.iti_ns + (result_.correct == false ? plan_.wrong_delay_ns : 0);
    case Outcome::timeout:
      return plan_.iti_ns + plan_.late_delay_ns;
    case Outcome::anticipation:
      return plan_.iti_ns + plan_.early_delay_ns;
    case Outcome::aborted:
    case Outcome::fault:
      break;
  }
  return plan_.iti_ns;
}

}  // namespace turnpoint::trial
