#pragma once
#include <concepts>
#include <exception>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "station/core/fault.hpp"
#include "station/core/proof.hpp"
#include "station/core/usage_error.hpp"

namespace turnpoint::core {

/// Returns the two-letter codes of the languages that the station speaks, sorted.
std::vector<std::string> languages();

/// Returns all texts of the station in one of these languages, by key. The key of a text in a table has dots:
/// "fault.disk_full.happened".
const std::map<std::string, std::string, std::less<>>& catalogue(std::string_view language);

/// Says whether the station speaks a language ("de", "de-CH"), and whether a native speaker has read its
/// texts: none of them, those on the participant's pages, or all of them.
enum class Translation { none, unread, participant_read, read };
Translation translation(const std::string& language);

/// Returns one text in the given language ("de", "de-CH"), or in English if the station does not speak that
/// language or its catalogue lacks the text. A key with a space or a place (%1) is itself the text, in
/// English. Throws std::logic_error for any other key that no catalogue has.
std::string text(std::string_view key, std::string_view language);

/// What somebody is to be told, in a language that is chosen later: the text with this key, with `values` in
/// its places %1, %2 and so on. A key with a space or a place is itself the text, in English: what is wrong
/// in a file is said so, where it is found. Without a key: `words`, which are the same in every language (a
/// number, a name from a protocol), and then all `values` one after another.
struct Phrase {
  std::string key, words;
  std::vector<Phrase> values;
  /// True if it says nothing in any language.
  bool empty() const { return key.empty() && words.empty() && values.empty(); }
  bool operator==(const Phrase&) const = default;
};
/// A phrase that is the same in every language.
inline Phrase plain(std::string words) { return {"", std::move(words), {}}; }
inline Phrase plain(std::integral auto number) { return plain(std::to_string(number)); }
/// The text with this key, or this English sentence, with `values` in its places.
inline Phrase phrase(std::string key, std::vector<Phrase> values = {}) {
  return {std::move(key), "", std::move(values)};
}
/// Returns the phrase in the given language. Throws std::logic_error for a key that no catalogue has.
std::string say(const Phrase& phrase, std::string_view language);

/// The explanation of a fault for the person in front of the screen: what happened, what is safe, what to do.
struct FaultText {
  std::string happened, safe, to_do;
};
FaultText fault_text(FaultKind kind, const std::string& language);

/// Says what a fault or a cause is. In English, these are the words of core::describe(); the detail of a
/// fault is the same in every language.
Phrase phrase_of(const Fault& fault);
Phrase phrase_of(ProofCause cause);

/// A usage error that can be said in the language of the screen. what() says it in English, for the command
/// line.
class Refusal : public UsageError {
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

}  // namespace turnpoint::core
