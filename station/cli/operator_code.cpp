#include "station/view/operator_code.hpp"

#include <fmt/ostream.h>
#include <termios.h>
#include <unistd.h>

#include <iostream>
#include <string>

#include "station/cli/command.hpp"

namespace turnpoint::cli {

namespace operator_code_command {

/// While this object exists, what is typed on the terminal (if there is one) is invisible. Ctrl-C is read as
/// an ordinary character: ending the program now would leave the terminal without echo.
class NoEcho {
 public:
  NoEcho() {
    if (::tcgetattr(STDIN_FILENO, &before_) != 0) return;
    auto silent = before_;
    silent.c_lflag &= ~static_cast<tcflag_t>(ECHO | ISIG);
    terminal_ = ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &silent) == 0;
  }
  NoEcho(const NoEcho&) = delete;
  NoEcho& operator=(const NoEcho&) = delete;
  ~NoEcho() {
    if (terminal_) ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
  }
  bool terminal() const { return terminal_; }

 private:
  termios before_{};
  bool terminal_ = false;
};

std::string line_from(std::istream& in) {
  std::string line;
  if (!std::getline(in, line)) throw UsageError("operator-code: no code was typed; no code was stored");
  return line;
}

/// On a terminal asks twice; otherwise reads one line of standard input.
std::string entered(Context& context) {
  const NoEcho silent;
  if (!silent.terminal()) return line_from(std::cin);
  const auto ask = [&](const char* what) {
    fmt::print(context.err, "{}: ", what);
    context.err.flush();
    auto line = line_from(std::cin);
    fmt::print(context.err, "\n");
    return line;
  };
  auto code = ask("New operator's code (4 to 12 digits)");
  if (ask("Again") != code) throw UsageError("operator-code: the two codes differ; no code was stored");
  return code;
}

void set_operator_code(Context& context) {
  const auto file = view::operator_code_files().front();
  view::store_operator_code(view::OperatorCode::of_digits(entered(context)), file);
  fmt::print(context.out,
             "The hash of the operator's code was stored in {}. A running station uses the new code after a "
             "restart: sudo systemctl restart turnpoint\n",
             file);
}

}  // namespace operator_code_command

void add_operator_code(CommandLine& app, Context& context) {
  using namespace operator_code_command;
  auto* command =
      app.add_subcommand("operator-code",
                         "Asks for the code that opens the operator's pages on the participant's "
                         "screen, and stores its hash. Run it as root if the station runs as a service");
  command->footer("Example: sudo turnpoint operator-code");
  command->callback([&context] { set_operator_code(context); });
}

}  // namespace turnpoint::cli
