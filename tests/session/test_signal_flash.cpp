// A response signal that is a flash: which pages begin it, and when it was due.
#include <cmath>
#include <fstream>
#include <set>

#include "station/core/read_file.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/replaced.hpp"

using namespace turnpoint;
using namespace measured;

namespace {

/// Remembers when the flashes of a session were due.
struct Flashes : session::Display {
  std::set<std::int64_t> due_ns;
  int others = 0;
  void show(const session::Page& page) override {
    if (page.flash_ns) due_ns.insert(*page.flash_ns);
    if (page.flash_ns && !page.answer_now) ++others;
  }
};

}  // namespace

TEST_CASE("a flash is due at its lag, once in a trial, and never three times in a second",
          "[session][flash]") {
  const TemporaryFolder folder;
  // the shortest pauses and lags that a protocol can have
  auto text = core::read_file(kSource + "/protocols/response-signal.toml");
  text = replaced(text, "window_s = 0.4", "window_s = 0.4, by = \"flash\"");
  text = replaced(text, "[0.1, 0.2, 0.35, 0.6, 1.0, 1.6]", "[0.05, 0.07]");
  text = replaced(text, "{ uniform = [1.0, 2.5] }", "0.1");
  text = replaced(text, "{ uniform = [0.8, 1.4] }", "0.0");
  text = replaced(replaced(text, "repeats = 84", "repeats = 8"), "trials = 28", "trials = 4");
  std::ofstream(folder / "flash.toml") << text;
  const auto setup = session::prepare(request_in(folder, folder / "flash.toml", kPickUps));
  session::Inputs inputs;
  Flashes flashes;
  const auto summary = session::run(setup, &flashes, inputs, nullptr);
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(flashes.others == 0);
  std::set<std::int64_t> possible;
  int answered = 0;
  for (const auto& block : store::read_session(summary.database, summary.session_id).blocks)
    for (const auto& row : block.trials) {
      const auto due_ns = row.timing.onset_ns + std::llround(1e9 * std::get<double>(row.factors.at("lag_s")));
      possible.insert(due_ns);
      if (row.outcome != core::Outcome::answered) continue;
      ++answered;
      CHECK(flashes.due_ns.count(due_ns) == 1);
    }
  for (const auto due_ns : flashes.due_ns) CHECK(possible.count(due_ns) == 1);
  CHECK(answered >= 16);
  std::int64_t before_ns = 0;
  for (const auto due_ns : flashes.due_ns) {
    if (before_ns > 0) CHECK(due_ns - before_ns > 1'000'000'000 / 3);
    before_ns = due_ns;
  }
}
