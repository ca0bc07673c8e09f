#include "station/session/interludes.hpp"

#include <algorithm>
#include <cmath>

#include "station/core/draws.hpp"
#include "station/core/number.hpp"
#include "station/session/planned_session.hpp"

namespace turnpoint::session {

namespace {

// Time for which a simulated participant reads a question or an explanation.
constexpr std::int64_t kReads_ns = 1'500'000'000;

/// Returns the answer to store for an item when this input was given.
std::string answer_of(const protocol::Item& item, const Input& input) {
  if (const auto* value = input.as<input::Value>()) return core::exact(value->number);
  return item.choices.at(static_cast<std::size_t>(input.as<input::Answer>()->index)).id;
}

/// True if the input chooses one of `count` answers or examples.
bool chooses(const Input& input, std::size_t count) {
  const auto* answer = input.as<input::Answer>();
  return answer && answer->index >= 0 && answer->index < static_cast<int>(count);
}

bool answers_item(const protocol::Item& item, const Input& input) {
  const auto* value = input.as<input::Value>();
  if (item.value) return value && value->number >= item.value->low && value->number <= item.value->high;
  return chooses(input, item.choices.size());
}

}  // namespace

Interludes::Interludes(const Setup& setup, const Pages& pages, const trial::Director& director,
                       const Scores& scores, OperatorGate& gate, Stage& stage,
                       SimulatedParticipant* participant, store::SessionLog& log, Player player)
    : setup_(setup),
      pages_(pages),
      director_(director),
      scores_(scores),
      gate_(gate),
      stage_(stage),
      participant_(participant),
      log_(log),
      player_(std::move(player)),
      visit_(visit_of(log.session())),
      blocks_(protocol::block_order(setup.protocol, visit_)) {}

void Interludes::restore(const Earlier& earlier) {
  for (const auto* event : core::standing_answers(earlier.events))
    standing_.insert(standing_.end(), event->answers.begin(), event->answers.end());
  for (const auto& event : earlier.events)
    if (event.kind == core::kDoneEvent) done_.insert(event.value);
}

protocol::Answers Interludes::answers() const {
  protocol::Answers all;
  for (const auto& row : standing_)
    for (const auto& interlude : setup_.protocol.interludes)
      for (const auto& item : interlude.items)
        if (interlude.name == row.questionnaire && item.id == row.item)
          all[interlude.name + "." + item.id] = protocol::answer_value(item, row.answer);
  for (const auto& [block, accuracy] : scores_.accuracies()) all[block + ".accuracy"] = accuracy;
  return all;
}

Flow Interludes::before(int block_index) {
  occasion_ = block_index;
  for (const auto* interlude :
       protocol::interludes_before(setup_.protocol, blocks_, static_cast<std::size_t>(block_index), visit_)) {
    const auto place = core::place_name(interlude->name, occasion_);
    if (done_.count(place) > 0) continue;
    if (run(*interlude) == Flow::stop) return Flow::stop;
    log_.event({stage_.now_ns(), core::kDoneEvent, place, std::nullopt});
    gate_.keep([&] { log_.keep_events(); });
    done_.insert(place);
  }
  return Flow::go_on;
}

Flow Interludes::run(const protocol::Interlude& interlude) {
  switch (interlude.kind) {
    case protocol::InterludeKind::questionnaire:
      return ask_items(interlude);
    case protocol::InterludeKind::consent:
      return consent(interlude);
    case protocol::InterludeKind::explanation:
      return explain(interlude);
    case protocol::InterludeKind::screening:
      return screen(interlude);
  }
  return Flow::go_on;
}

Interludes::Reply Interludes::reply(const Page& page, const std::function<bool(const Input&)>& accepts) {
  const auto shown_ns = stage_.now_ns();
  gate_.show(page);
  while (!gate_.stop_asked()) {
    auto waited = stage_.wait_until(kForever);
    if (!waited) continue;
    // ignore the rig's response buttons, because they answer trials, not questions
    const bool button = waited->is<input::Button>();
    const auto input = gate_.received(std::move(*waited));
    if (gate_.handle_on_page(page, input) == Flow::stop) return std::nullopt;
    // ignore a press that was made before this page appeared: it was meant for the previous page
    if (!button && input.time_ns >= shown_ns && accepts(input)) return input;
  }
  return std::nullopt;
}

void Interludes::simulate(input::Any content) {
  participant_->will({stage_.now_ns() + kReads_ns, std::move(content)}, stage_.now_ns());
}

/// Gives the answer that the protocol states for a simulated participant, or a random answer if it states
/// none.
void Interludes::simulate_answer(const protocol::Interlude& interlude, std::size_t index) {
  const auto& item = interlude.items[index];
  const auto* first = setup_.protocol.interludes.data();
  const auto number = static_cast<int>(&interlude - first) * 1000 + static_cast<int>(index);
  core::Draws draws({log_.session().start.seed, core::Stream::questionnaire, occasion_, 0, number});
  if (item.value) {
    const double steps = std::pow(10.0, item.value->decimals);
    const auto low = std::ceil(item.value->low * steps - 1e-9),
               high = std::floor(item.value->high * steps + 1e-9);
    const auto drawn = low + static_cast<double>(draws.below(static_cast<std::uint64_t>(high - low) + 1));
    return simulate(input::Value{item.simulated ? std::get<double>(*item.simulated) : drawn / steps});
  }
  auto chosen = static_cast<int>(draws.below(item.choices.size()));
  for (std::size_t i = 0; item.simulated && i < item.choices.size(); ++i)
    if (protocol::answer_value(item, item.choices[i].id) == *item.simulated) chosen = static_cast<int>(i);
  simulate(input::Answer{chosen});
}

void Interludes::keep_answer(const protocol::Interlude& interlude, const std::string& item,
                             const std::string& answer, double response_time_s) {
  const core::AnswerRow row{interlude.name, item, occasion_, answer, response_time_s};
  core::EventRow event{stage_.now_ns(), core::kAnswerEvent, interlude.name + "." + item + " = " + answer,
                       std::nullopt};
  event.answers = {row};
  log_.event(std::move(event));
  gate_.keep([&] { log_.keep_events(); });
  standing_.push_back(row);
}

std::vector<std::string> Interludes::given(const protocol::Interlude& interlude) const {
  std::vector<std::string> items;
  for (const auto& row : standing_)
    if (row.questionnaire == interlude.name && row.occasion == occasion_) items.push_back(row.item);
  return items;
}

/// Asks one item. Returns nothing if the session stops, and an empty reply if the participant pressed Back.
std::optional<Interludes::Reply> Interludes::ask(const protocol::Interlude& interlude, std::size_t index,
                                                 bool back) {
  const auto& item = interlude.items[index];
  auto page = pages_.question(item, director_);
  page.back = back;
  if (participant_) simulate_answer(interlude, index);
  const auto shown_ns = stage_.now_ns();
  const auto input = reply(
      page, [&](const Input& one) { return answers_item(item, one) || (back && one.is<input::Back>()); });
  if (!input) return std::nullopt;
  if (input->is<input::Back>()) return Reply{};
  keep_answer(interlude, item.id, answer_of(item, *input),
              1e-9 * static_cast<double>(input->time_ns - shown_ns));
  return input;
}

Flow Interludes::ask_items(const protocol::Interlude& interlude) {
  for (;;) {
    const auto before = given(interlude);
    const auto is_last = [&](const protocol::Item& item) {
      return !before.empty() && item.id == before.back();
    };
    const auto& items = interlude.items;
    auto next = std::find_if(items.begin(), items.end(), is_last);
    next = next == items.end() ? items.begin() : std::next(next);
    next = std::find_if(next, items.end(),
                        [&](const auto& item) { return protocol::holds(item.when, answers()); });
    if (next == items.end()) return Flow::go_on;
    const auto asked = ask(interlude, static_cast<std::size_t>(next - items.begin()), !before.empty());
    if (!asked) return Flow::stop;
    if (*asked) continue;
    log_.event(
        {stage_.now_ns(), core::kBackEvent, core::place_name(interlude.name, occasion_), std::nullopt});
    gate_.keep([&] { log_.keep_events(); });
    const auto mine = [&](const core::AnswerRow& row) {
      return row.questionnaire == interlude.name && row.occasion == occasion_;
    };
    standing_.erase(std::next(std::find_if(standing_.rbegin(), standing_.rend(), mine)).base());
  }
}

Flow Interludes::consent(const protocol::Interlude& interlude) {
  if (given(interlude).empty() && !ask(interlude, 0, false)) return Flow::stop;
  if (standing_.back().answer == "refuse")
    return end(interlude, "the participant refused \"" + interlude.name + "\"");
  return Flow::go_on;
}

Flow Interludes::explain(const protocol::Interlude& interlude) {
  for (std::size_t at = 0, played = 0; at < interlude.pages.size();) {
    const auto& explanation = interlude.pages[at];
    auto page = pages_.explanation(explanation, director_);
    page.back = at > 0;
    // a simulated participant feels each example once
    if (participant_ && played < explanation.examples.size())
      simulate(input::Answer{static_cast<int>(played++)});
    const auto input = reply(page, [&](const Input& one) {
      return one.is<input::Next>() || (page.back && one.is<input::Back>()) ||
             chooses(one, explanation.examples.size());
    });
    if (!input) return Flow::stop;
    if (const auto* chosen = input->as<input::Answer>()) {
      const auto& example = explanation.examples[static_cast<std::size_t>(chosen->index)];
      log_.event({stage_.now_ns(), "example",
                  interlude.name + " page " + std::to_string(at + 1) + ": " + example.scene, std::nullopt});
      gate_.keep([&] { log_.keep_events(); });
      page.playing = true;
      if (player_(example, page) == Flow::stop) return Flow::stop;
      continue;
    }
    at = input->is<input::Next>() ? at + 1 : at - 1;
    played = 0;
  }
  return Flow::go_on;
}

Flow Interludes::screen(const protocol::Interlude& interlude) {
  const bool passed = protocol::holds(interlude.pass, answers());
  if (given(interlude).empty()) keep_answer(interlude, "screening", passed ? "passed" : "ended", 0);
  if (!passed) return end(interlude, "the screening \"" + interlude.name + "\" was not passed");
  return Flow::go_on;
}

Flow Interludes::end(const protocol::Interlude& interlude, const std::string& reason) {
  if (gate_.show_and_wait(pages_.farewell(interlude.farewell, director_), 0) == Flow::stop) return Flow::stop;
  ended_because_ = reason;
  return Flow::stop;
}

}  // namespace turnpoint::session
