#pragma once
#include <functional>
#include <memory>

#include "station/session/conversation.hpp"
#include "station/simulation/observer.hpp"

namespace turnpoint::session {

/// A simulated observer that is a separate program. The program is started at the first question. It keeps no
/// state: the same question must get the same reply. All functions throw core::ProgramFailed; the next
/// question then starts the program again.
class ProgramObserver {
 public:
  ProgramObserver(ProgramChoice choice, std::function<void(const Identity&)> greeted);
  simulation::Reply answer(const simulation::Question& question);
  simulation::Setting adjust(const simulation::Adjustment& adjustment);

 private:
  Json ask(const Json& message, const char* reply_type);

  ProgramChoice choice_;
  std::function<void(const Identity&)> greeted_;
  std::unique_ptr<Conversation> with_;
};

}  // namespace turnpoint::session
