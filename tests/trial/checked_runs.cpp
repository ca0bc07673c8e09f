// Prints what `turnpoint check --json` says about the runs of a protocol, without the other things that it
// computes:
//   checked_runs PROTOCOL SESSIONS
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "station/core/number.hpp"
#include "station/rehearsal/check.hpp"

int main(int count, char** words) {
  if (count != 3) return 2;
  std::vector<std::string> all;
  for (const auto& runs :
       turnpoint::rehearsal::check_runs(turnpoint::protocol::load(words[1]),
                                        static_cast<int>(turnpoint::core::read_number(words[2]).value())))
    all.push_back(fmt::format(
        R"({{"of": "{}", "limit": {}, "longest": {}, "sessions": {}, "sessions_with_longer": {}}})", runs.of,
        runs.limit, runs.longest, runs.sessions, runs.longer));
  fmt::print("[{}]\n", fmt::join(all, ", "));
}
