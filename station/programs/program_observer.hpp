#pragma once
#include <functional>
#include <memory>

#include "station/observer/observer.hpp"
#include "station/programs/conversation.hpp"

namespace turnpoint::programs {

/// A simulated observer that is a separate program. The program is started at the first question. It keeps no
/// state: the same question must get the same reply. All functions throw terms::ProgramFailed; the next
/// question then starts the program again.
class ProgramObserver {
 public:
  ProgramObserver(ProgramChoice choice, std::function<void(const Identity&)> greeted);
  observer::Reply answer(const observer::Question& question);
  observer::Setting adjust(const observer::Adjustment& adjustment);

 private:
  Json ask(const Json& message, const char* reply_type);

  ProgramChoice choice_;
  std::function<void(const Identity&)> greeted_;
  std::unique_ptr<Conversation> with_;
};

}  // namespace turnpoint::programs
