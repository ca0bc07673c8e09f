#include "station/session/program_procedure.hpp"

#include <bit>
#include <stdexcept>
#include <utility>

#include "station/core/number.hpp"
#include "station/procedure/state_hash.hpp"
#include "station/session/program_estimator.hpp"

namespace turnpoint::session {

using procedure::Answer;

Json to_json(const core::Value& value) {
  using Kind = core::Value::Kind;
  switch (value.kind) {
    case Kind::boolean:
      return value.boolean;
    case Kind::integer:
      return value.integer;
    case Kind::number:
      return value.number;
    case Kind::date:
    case Kind::string:
      return value.string;
    case Kind::array: {
      auto list = Json::array();
      for (const auto& item : value.items) list.push_back(to_json(item));
      return list;
    }
    case Kind::table:
      break;
  }
  auto object = Json::object();
  for (const auto& entry : value.entries) object[entry.key] = to_json(entry.value);
  return object;
}

ProgramProcedure::ProgramProcedure(const procedure::Spec& spec, const core::DrawKey& key, std::string path,
                                   std::function<void(const Identity&)> greeted)
    : spec_(spec),
      key_(key),
      path_(std::move(path)),
      greeted_(std::move(greeted)),
      talk_(std::make_unique<Talk>()) {}

/// Starts the program, tells it everything that has happened so far, and asks for the level that is needed.
void ProgramProcedure::begin() const {
  *talk_ = Talk{};
  talk_->with = std::make_unique<Conversation>(path_, spec_.program.limit_s,
                                               Json{{"role", "procedure"},
                                                    {"name", spec_.name},
                                                    {"level", spec_.level},
                                                    {"min", *spec_.min},
                                                    {"max", *spec_.max},
                                                    {"trials", *spec_.stop.trials},
                                                    {"settings", to_json(spec_.program.settings)},
                                                    {"seed", key_.seed},
                                                    {"block", key_.block / 64},
                                                    {"place", key_.block % 64},
                                                    {"attempt", key_.attempt}});
  for (std::size_t i = 0; i <= trials_.size(); ++i) ask_for_level();
}

void ProgramProcedure::ask_for_level() const {
  // The first question comes without an answer; each further one comes with the answer before it.
  const auto i = static_cast<std::size_t>(talk_->with->awaited()) + talk_->compared;
  if (i > 0) {
    const auto& trial = trials_[i - 1];
    talk_->with->tell(
        {{"type", "answer"},
         {"trial", i},
         {"level", trial.level},
         {"answer", trial.answer == Answer::none     ? Json(nullptr)
                    : trial.answer == Answer::unsure ? Json("unsure")
                                                     : Json(trial.answer == Answer::one ? 1 : 0)}});
  }
  talk_->with->ask({{"type", "next"}, {"trial", i + 1}});
}

bool ProgramProcedure::ready() const {
  if (talk_->failure) return true;
  try {
    if (!talk_->with) begin();
    while (talk_->compared <= trials_.size()) {
      const auto reply = talk_->with->reply();
      if (talk_->with->identity() && !std::exchange(talk_->greeted, true)) greeted_(*talk_->with->identity());
      if (!reply) return false;
      take(*reply);
    }
  } catch (const core::ProgramFailed& failed) {
    talk_->with.reset();
    talk_->failure = failed.what();
  }
  return true;
}

/// Takes the reply to one question for a level.
void ProgramProcedure::take(const Json& reply) const {
  auto& talk = *talk_;
  const auto i = talk.compared;
  talk.done = reply["type"] == "done";
  if (!talk.done && reply["type"] != "level")
    talk.with->fail("replied \"" + reply["type"].get<std::string>() +
                    "\" to \"next\"; a reply is \"level\" or \"done\"");
  talk.level = talk.done ? std::nullopt : std::optional(level_in(reply));
  if (reply.contains("estimates") && !reply["estimates"].is_null())
    talk.estimates = estimates_in(reply, *talk.with);
  const bool repeated = i < trials_.size();
  if (repeated && (talk.done || *talk.level != trials_[i].level))
    talk.with->fail(
        "was started again and now " +
        (talk.done ? std::string("is done before") : "gives level " + core::exact(*talk.level) + " in") +
        " trial " + std::to_string(i + 1) + ", in which it gave level " + core::exact(trials_[i].level) +
        "; a program must give the same levels for the same seed and answers");
  ++talk.compared;
}

double ProgramProcedure::level_in(const Json& reply) const {
  const double level = number_in(reply, "level", *talk_->with);
  if (level < *spec_.min || level > *spec_.max)
    talk_->with->fail("gives level " + core::exact(level) + "; the protocol allows " +
                      core::exact(*spec_.min) + " to " + core::exact(*spec_.max));
  return level;
}

bool ProgramProcedure::at_limit() const { return static_cast<int>(trials_.size()) >= *spec_.stop.trials; }

std::optional<procedure::Proposal> ProgramProcedure::next() const {
  while (!ready()) talk_->with->wait();
  if (const auto failure = std::exchange(talk_->failure, std::nullopt)) throw core::ProgramFailed(*failure);
  // At the limit the program is asked nevertheless, for its last estimates.
  if (talk_->done || at_limit()) return std::nullopt;
  return procedure::Proposal{*talk_->level, {}};
}

void ProgramProcedure::record(Answer answer) {
  if (!talk_->level)
    throw std::logic_error("procedure " + spec_.name + ": an answer was recorded without a level");
  trials_.push_back({*talk_->level, answer});
  talk_->level.reset();
  if (answer != Answer::none) ++answered_;
  if (!talk_->with) return;
  try {
    ask_for_level();
  } catch (const core::ProgramFailed& failed) {
    talk_->with.reset();
    talk_->failure = failed.what();
  }
}

std::map<std::string, procedure::Estimate> ProgramProcedure::estimates() const {
  if (talk_->compared <= trials_.size()) return {};
  return talk_->estimates;
}

int ProgramProcedure::expected() const {
  return talk_->done ? static_cast<int>(trials_.size()) : *spec_.stop.trials;
}

std::uint64_t ProgramProcedure::state_hash() const {
  procedure::StateHash hash;
  for (const auto& trial : trials_) {
    hash.add(std::bit_cast<std::uint64_t>(trial.level));
    hash.add(static_cast<std::uint64_t>(trial.answer));
  }
  return hash.value();
}

}  // namespace turnpoint::session
