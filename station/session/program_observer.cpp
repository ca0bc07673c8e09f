#include "station/session/program_observer.hpp"

#include <cmath>
#include <utility>

#include "station/core/limits.hpp"
#include "station/core/number.hpp"

namespace turnpoint::session {

namespace {

constexpr double kLongestTime_s = 3600;
constexpr std::size_t kMostMoves = 1000;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

const char* name(simulation::Decides decides) {
  switch (decides) {
    case simulation::Decides::right_answer:
      return "right-answer";
    case simulation::Decides::side:
      return "side";
    case simulation::Decides::presence:
      return "presence";
    case simulation::Decides::category:
      break;
  }
  return "category";
}

const char* name(simulation::Finding finding) {
  switch (finding) {
    case simulation::Finding::weibull:
      return "weibull";
    case simulation::Finding::largest:
      return "largest";
    case simulation::Finding::nearest:
      break;
  }
  return "nearest";
}

const char* name(simulation::Middle middle) {
  switch (middle) {
    case simulation::Middle::criterion:
      return "criterion";
    case simulation::Middle::threshold:
      return "threshold";
    case simulation::Middle::bias:
      break;
  }
  return "bias";
}

void add_key(Json& message, const core::DrawKey& key) {
  message["seed"] = key.seed, message["block"] = key.block;
  message["attempt"] = key.attempt, message["trial"] = key.trial;
}

Json message_of(const simulation::Question& question) {
  Json message{{"type", "question"},
               {"level", question.level},
               {"decibel", question.decibel},
               {"decides", name(question.decides)},
               {"positive", question.positive},
               {"cut", question.cut},
               {"absent", question.absent},
               {"correct", or_null(question.correct)},
               {"finding", name(question.finding)},
               {"categories", question.categories},
               {"compared", question.compared},
               {"range", question.range},
               {"answers", question.answers},
               {"unsure", question.unsure},
               {"rating", question.rating},
               {"middle", name(question.middle)},
               {"value", nullptr},
               {"confidence", question.confidence},
               {"default_threshold", question.default_threshold},
               {"deadline_s", question.deadline_s > 0 ? Json(question.deadline_s) : Json(nullptr)},
               {"signal_s", or_null(question.signal_s)}};
  if (const auto& value = question.value)
    message["value"] = {{"typed", value->typed},
                        {"low", value->low},
                        {"high", value->high},
                        {"decimals", value->decimals},
                        {"modulus", value->modulus}};
  add_key(message, question.key);
  return message;
}

bool given(const Json& reply, const char* key) { return reply.contains(key) && !reply[key].is_null(); }

/// Reads a number of a reply and refuses it if it is outside a range.
double within(const Json& reply, const char* key, double low, double high, const Conversation& from) {
  const double value = number_in(reply, key, from);
  if (value < low || value > high)
    from.fail("\"" + std::string(key) + "\" is " + core::exact(value) + "; allowed are " + core::exact(low) +
              " to " + core::exact(high));
  return value;
}

int integer_within(const Json& reply, const char* key, int low, int high, const Conversation& from) {
  const double value = within(reply, key, low, high, from);
  if (value != std::floor(value)) from.fail("\"" + std::string(key) + "\" must be a whole number");
  return static_cast<int>(value);
}

}  // namespace

ProgramObserver::ProgramObserver(ProgramChoice choice, std::function<void(const Identity&)> greeted)
    : choice_(std::move(choice)), greeted_(std::move(greeted)) {}

/// Asks the program and returns its reply, which must have this type. Ends the program if it fails.
Json ProgramObserver::ask(const Json& message, const char* reply_type) {
  const bool starts = !with_;
  if (starts)
    with_ = std::make_unique<Conversation>(choice_.path, choice_.limit_s,
                                           Json{{"role", "observer"}, {"settings", choice_.settings}});
  with_->ask(message);
  auto reply = with_->wait_for_reply();
  if (starts) greeted_(*with_->identity());
  if (reply["type"] != reply_type)
    with_->fail("replied \"" + reply["type"].get<std::string>() + "\" to \"" +
                message["type"].get<std::string>() + "\"; expected is \"" + reply_type + "\"");
  return reply;
}

simulation::Reply ProgramObserver::answer(const simulation::Question& question) {
  try {
    const auto reply = ask(message_of(question), "reply");
    simulation::Reply answer;
    if (!given(reply, "choice") && !given(reply, "value")) return answer;
    answer.response_time_s = within(reply, "response_time_s", -kLongestTime_s, kLongestTime_s, *with_);
    answer.choice = 0;
    if (const auto& value = question.value)
      answer.value = within(reply, "value", value->low, value->high, *with_);
    else
      answer.choice =
          integer_within(reply, "choice", 0, question.answers - (question.unsure ? 0 : 1), *with_);
    if (question.confidence > 0) {
      answer.confidence = integer_within(reply, "confidence", 1, question.confidence, *with_);
      answer.confidence_time_s =
          within(reply, "confidence_time_s", core::kConfidenceGuard_s, kLongestTime_s, *with_);
    }
    return answer;
  } catch (const core::ProgramFailed&) {
    with_.reset();
    throw;
  }
}

simulation::Setting ProgramObserver::adjust(const simulation::Adjustment& adjustment) {
  try {
    Json message{{"type", "adjustment"},
                 {"start", adjustment.start},
                 {"low", adjustment.low},
                 {"high", adjustment.high},
                 {"equal", adjustment.equal}};
    add_key(message, adjustment.key);
    const auto reply = ask(message, "setting");
    simulation::Setting setting;
    const auto moves = reply.find("moves");
    if (moves == reply.end() || !moves->is_array() || moves->size() > kMostMoves)
      with_->fail("\"moves\" must be a list of at most " + std::to_string(kMostMoves) + " moves");
    double last_s = 0;
    for (const auto& move : *moves) {
      if (!move.is_object()) with_->fail("each of \"moves\" must be an object");
      last_s = within(move, "time_s", last_s, kLongestTime_s, *with_);
      setting.moves.push_back({last_s, within(move, "value", adjustment.low, adjustment.high, *with_)});
    }
    setting.done_s = within(reply, "done_s", last_s, kLongestTime_s, *with_);
    return setting;
  } catch (const core::ProgramFailed&) {
    with_.reset();
    throw;
  }
}

}  // namespace turnpoint::session
