#pragma once
#include <exception>
#include <stdexcept>
#include <utility>

#include "station/terms/usage_error.hpp"
#include "station/texts/texts.hpp"

namespace turnpoint::texts {

/// A usage error that can be said in the language of the screen. what() says it in English, for the command
/// line.
class Refusal : public terms::UsageError {
 public:
  explicit Refusal(Phrase why) : UsageError(say(why, "en")), why_(std::move(why)) {}
  const Phrase& why() const { return why_; }

 private:
  Phrase why_;
};

/// The same for a failure at run time, which is not the user's mistake.
class Failure : public std::runtime_error {
 public:
  explicit Failure(Phrase why) : runtime_error(say(why, "en")), why_(std::move(why)) {}
  const Phrase& why() const { return why_; }

 private:
  Phrase why_;
};

/// Returns what an error says, as a phrase: that of a Refusal or a Failure, or else its message.
inline Phrase phrase_of(const std::exception& error) {
  if (const auto* refusal = dynamic_cast<const Refusal*>(&error)) return refusal->why();
  if (const auto* failure = dynamic_cast<const Failure*>(&error)) return failure->why();
  return plain(error.what());
}

}  // namespace turnpoint::texts
