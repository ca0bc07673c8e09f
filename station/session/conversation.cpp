#include "station/session/conversation.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "station/core/number.hpp"
#include "station/core/read_file.hpp"
#include "station/core/usage_error.hpp"
#include "station/session/programs.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::session {
namespace {

const std::string kPrefix = "program:";
constexpr double kLongestLimit_s = 60;

}  // namespace

bool is_program(const std::string& text) { return text.starts_with(kPrefix); }

std::string located(const std::string& observer) {
  if (!is_program(observer)) return observer;
  const auto path = existing_program("--observer", observer).path;
  return kPrefix + std::filesystem::absolute(path).lexically_normal().string() +
         observer.substr(kPrefix.size() + path.size());
}

ProgramChoice parse_program(const std::string& option, const std::string& text) {
  const auto bad = [&](const std::string& what) {
    throw core::UsageError(option + " " + text + ": " + what +
                           "; a program is written program:FILE[,limit_s=S][,KEY=VALUE]...");
  };
  if (!is_program(text)) bad("no program");
  ProgramChoice choice;
  auto comma = text.find(',');
  choice.path = text.substr(kPrefix.size(), comma == std::string::npos ? comma : comma - kPrefix.size());
  if (choice.path.empty()) bad("the file is missing");
  while (comma != std::string::npos) {
    const auto next = text.find(',', comma + 1);
    const auto entry = text.substr(comma + 1, next == std::string::npos ? next : next - comma - 1);
    comma = next;
    const auto equals = entry.find('=');
    if (equals == std::string::npos || equals == 0) bad("\"" + entry + "\" is not KEY=VALUE");
    const auto key = entry.substr(0, equals), value = entry.substr(equals + 1);
    const auto number = core::read_number(value);
    if (key != "limit_s")
      choice.settings[key] = number ? Json(*number) : Json(value);
    else if (!number || !(*number > 0 && *number <= kLongestLimit_s))
      bad("limit_s must be above 0 and at most " + core::number(kLongestLimit_s) + " s");
    else
      choice.limit_s = *number;
  }
  return choice;
}

ProgramChoice existing_program(const std::string& option, const std::string& text) {
  auto choice = parse_program(option, text);
  if (const auto problem = problem_of(choice.path); !problem.empty())
    throw core::UsageError(option + " " + text + ": " + problem);
  return choice;
}

namespace {

constexpr std::size_t kLongestLine = 1 << 16, kShown = 160;
// Interpreters may take seconds to start on a busy machine.
constexpr double kStart_s = 10;

/// The beginning of what a program wrote, in quotes, as valid UTF-8 and without control characters.
std::string shown(const std::string& line) {
  const Json text = line.substr(0, kShown) + (line.size() > kShown ? "..." : "");
  return text.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string problem_of(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return "there is no such file";
  if (::access(path.c_str(), X_OK) != 0) return "the file is not executable; chmod +x makes it so";
  return "";
}

Conversation::Conversation(const std::string& path, double limit_s, Json greeting)
    : file_{std::filesystem::absolute(path).lexically_normal().string(), "", "", ""},
      limit_ns_(static_cast<std::int64_t>(limit_s * 1e9)) {
  if (const auto problem = problem_of(file_.path); !problem.empty()) fail(problem);
  try {
    file_.sha256 = core::sha256(core::read_file(file_.path));
    child_ = std::make_unique<system::ChildProcess>(file_.path);
  } catch (const std::system_error& error) {
    throw core::ProgramFailed(error.what());
  }
  greeting["type"] = "hello";
  greeting["format"] = kFormat;
  since_ns_ = system::monotonic_ns();
  tell(greeting);
}

std::int64_t Conversation::due_ns() const {
  constexpr auto start_ns = static_cast<std::int64_t>(kStart_s * 1e9);
  return since_ns_ + (greeting_ ? std::max(limit_ns_, start_ns) : limit_ns_);
}

void Conversation::wait() { child_->wait(due_ns()); }

void Conversation::fail(const std::string& what) const {
  throw core::ProgramFailed("program " + file_.path + ": " + what);
}

void Conversation::tell(const Json& message) { child_->send(message.dump()); }

void Conversation::ask(Json message) {
  if (awaited() == 0 && !greeting_) since_ns_ = system::monotonic_ns();
  message["id"] = ++asked_;
  tell(message);
}

/// Returns the next message of the program, or nothing if it may still come.
std::optional<Json> Conversation::next_message() {
  const auto line = child_->line();
  if (line && line->size() <= kLongestLine) {
    const auto message = Json::parse(*line, nullptr, false);
    if (!message.is_object() || !message.contains("type") || !message["type"].is_string())
      fail("wrote " + shown(*line) + ", which is not a JSON object with a \"type\"");
    since_ns_ = system::monotonic_ns();
    if (message["type"] == "error") fail("reports " + shown(text_in(message, "message", *this)));
    return message;
  }
  if (line || child_->unfinished() > kLongestLine)
    fail("wrote a line of more than " + std::to_string(kLongestLine) + " bytes");
  if (child_->silent()) {
    const auto how = child_->how_it_ended(), complaint = child_->complaint();
    fail(how + (complaint.empty() ? "" : ": " + shown(complaint)));
  }
  if (system::monotonic_ns() > due_ns())
    fail("did not reply within " + core::number(1e-9 * static_cast<double>(due_ns() - since_ns_)) + " s");
  return std::nullopt;
}

void Conversation::greet(const Json& message) {
  if (message["type"] != "hello") fail("did not begin with the message \"hello\"");
  if (const auto format = text_in(message, "format", *this); format != kFormat)
    fail("speaks " + shown(format) + "; this version of turnpoint speaks \"" + kFormat + "\"");
  file_.name = text_in(message, "program", *this);
  file_.version = text_in(message, "version", *this);
  if (file_.name.empty() || file_.version.empty()) fail("\"program\" and \"version\" must not be empty");
  identity_ = file_;
  greeting_ = false;
}

std::optional<Json> Conversation::reply() {
  while (greeting_) {
    const auto message = next_message();
    if (!message) return std::nullopt;
    greet(*message);
  }
  if (awaited() == 0) return std::nullopt;
  auto message = next_message();
  if (!message) return std::nullopt;
  // A reply to another question would be taken for the level of the wrong trial.
  if (number_in(*message, "id", *this) != ++replied_)
    fail("replied " + shown(message->dump()) + " to question " + std::to_string(replied_) +
         "; \"id\" must be that of the question");
  return message;
}

Json Conversation::wait_for_reply() {
  for (;;) {
    if (auto message = reply()) return *message;
    if (!greeting_ && awaited() == 0)
      throw std::logic_error("programs: a reply is awaited without a question");
    wait();
  }
}

double number_in(const Json& reply, const char* key, const Conversation& from) {
  const auto found = reply.find(key);
  if (found == reply.end() || !found->is_number() || !std::isfinite(found->get<double>()))
    from.fail("\"" + std::string(key) + "\" must be a finite number in " + shown(reply.dump()));
  return found->get<double>();
}

std::string text_in(const Json& reply, const char* key, const Conversation& from) {
  const auto found = reply.find(key);
  if (found == reply.end() || !found->is_string())
    from.fail("\"" + std::string(key) + "\" must be a text in " + shown(reply.dump()));
  return found->get<std::string>();
}

}  // namespace turnpoint::session
