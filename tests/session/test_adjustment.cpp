#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "station/core/number.hpp"
#include "station/procedure/adjustment.hpp"
#include "station/session/prepare.hpp"
#include "station/session/resume.hpp"
#include "station/session/session.hpp"
#include "station/store/read.hpp"
#include "station/trial/slider.hpp"
#include "station/view/live_view.hpp"
#include "tests/session/faulty_stream.hpp"
#include "tests/session/live_room.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;

namespace {

/// Records the pages, and those with a slider. It can simulate a crash after a number of pages.
struct Pages : session::Display {
  int left = std::numeric_limits<int>::max();
  std::vector<session::Page> all, sliders;
  void show(const session::Page& page) override {
    all.push_back(page);
    if (page.kind == session::PageKind::adjust) sliders.push_back(page);
    if (--left == 0) throw std::runtime_error("the plug was pulled");
  }
};

session::Setup setup_in(const TemporaryFolder& folder, const std::string& observer,
                        const std::string& protocol = "boundary-adjustment") {
  auto request =
      simulated_run(TURNPOINT_SOURCE_DIR "/protocols/" + protocol + ".toml", folder / "a.sqlite", 7);
  request.observer = observer;
  return session::prepare(request);
}

std::vector<core::TrialRow> trials_of(const session::Setup& setup, const std::string& session) {
  std::vector<core::TrialRow> all;
  for (const auto& block : store::read_session(setup.database, session).blocks)
    for (const auto& trial : block.trials) all.push_back(trial);
  return all;
}

}  // namespace

TEST_CASE("a slider stays on its steps and in its range, and the surface follows at a limited pace",
          "[session]") {
  trial::Slider slider({-25, 25, 0.5, -30, 30}, -20);
  CHECK_FALSE(slider.glide_due_ns());
  slider.move(3.3);
  CHECK(slider.setting() == 3.5);
  CHECK(slider.felt() == -20);
  REQUIRE(slider.glide_due_ns());
  CHECK(slider.glide(1'000) == 3.5);
  slider.followed();
  CHECK(slider.felt() == 3.5);
  slider.move(99);
  CHECK(slider.setting() == 25);
  CHECK(*slider.glide_due_ns() == 1'000 + 50'000'000);
  slider.move(std::nan(""));
  CHECK(slider.setting() == 25);
}

TEST_CASE("a protocol file with a slider gives rows with each setting and the movements of the surface",
          "[session]") {
  const TemporaryFolder folder;
  const auto setup = setup_in(folder, "sim:threshold=2,bias=4,lapse=0");
  session::Inputs inputs;
  Pages pages;
  const auto summary = session::run(setup, &pages, inputs);
  CHECK(summary.status == core::SessionStatus::completed);
  const auto trials = trials_of(setup, summary.session_id);
  REQUIRE(trials.size() == 18);
  double sum = 0;
  for (const auto& trial : trials) {
    CHECK(trial.outcome == core::Outcome::answered);
    REQUIRE(trial.given.response);
    const double setting = std::stod(*trial.given.response);
    sum += setting;
    CHECK(std::fabs(*trial.level) == 20);
    CHECK(setting != *trial.level);
    CHECK_FALSE(trial.given.correct);
    // The stored boundary is the mark plus the setting, within the protocol's tolerance.
    CHECK(*trial.presented.boundary_mm ==
          Approx(std::get<double>(trial.factors.at("mark_mm")) + setting).margin(0.5));
    REQUIRE(trial.tones.size() == 2);
    CHECK(trial.tones[0].scene_index == 0);
    CHECK(trial.tones[1].scene_index == 1);
    CHECK(trial.tones[1].onset_frame >= trial.tones[0].onset_frame + trial.tones[0].length_frames);
  }
  // The SD of a setting is 2 / 0.6745, so the mean of 18 settings lies within four standard errors of the
  // simulated observer's bias.
  CHECK(sum / 18 == Approx(4).margin(4 * 2 / 0.6745 / std::sqrt(18.0)));
  REQUIRE(summary.estimates.size() == 1);
  CHECK(summary.estimates[0].parameter == "pse");
  CHECK(summary.estimates[0].mean == Approx(sum / 18));
  CHECK(*trials.back().learned.threshold_est == Approx(sum / 18));
}

TEST_CASE("a question shows the value that a factor has in its trial", "[session]") {
  const TemporaryFolder folder;
  for (const auto& [protocol, language] : {std::pair{"magnitude-production", "en"},
                                           {"magnitude-production", "de"},
                                           {"cross-modal-matching", "en"}}) {
    auto setup = setup_in(folder, "sim", protocol);
    setup.language = language;
    const auto& shown = setup.protocol.task.question_shows;
    session::Inputs inputs;
    Pages pages;
    const auto summary = session::run(setup, &pages, inputs);
    std::vector<std::string> expected, found;
    for (const auto& trial : trials_of(setup, summary.session_id)) {
      const auto& value = trial.factors.at(shown);
      const auto* number = std::get_if<double>(&value);
      auto text = setup.protocol.task.question.at(language);
      auto written = number ? core::number(*number) : std::get<std::string>(value);
      if (written == "2.5" && setup.language == "de") written = "2,5";
      text.replace(text.find("%1"), 2, written);
      if (expected.empty() || expected.back() != text) expected.push_back(text);
    }
    for (const auto& page : pages.sliders)
      if (found.empty() || found.back() != page.text) found.push_back(page.text);
    CHECK(found.size() > 4);
    CHECK(found == expected);
    const auto about = std::find_if(pages.all.begin(), pages.all.end(), [](const auto& page) {
      return page.kind == session::PageKind::instructions;
    });
    REQUIRE(about != pages.all.end());
    CHECK(about->text.find("\u2026") != std::string::npos);
    CHECK(about->text.find("%1") == std::string::npos);
  }
}

TEST_CASE("the same setting has a different place on the screen from trial to trial", "[session]") {
  const TemporaryFolder folder;
  session::Inputs inputs;
  Pages pages;
  session::run(setup_in(folder, "sim"), &pages, inputs);
  std::set<double> lows;
  for (const auto& page : pages.sliders) {
    CHECK(page.slider.low <= -25);
    CHECK(page.slider.high >= 25);
    CHECK(page.slider.high - page.slider.low == Approx(60));
    CHECK(page.answers.empty());
    lows.insert(page.slider.low);
  }
  CHECK(lows.size() > 5);
}

TEST_CASE("an interrupted adjustment continues with the same settings", "[session]") {
  const TemporaryFolder folder;
  const auto setup = setup_in(folder, "sim:bias=3");
  session::Inputs inputs;
  Pages cut;
  cut.left = 40;
  CHECK_THROWS(session::run(setup, &cut, inputs));
  std::ostringstream messages;
  const auto resumed = session::prepare_resume({setup.database, "", "resume", true}, messages);
  REQUIRE(resumed);
  const auto summary = session::run(*resumed, nullptr, inputs);
  CHECK(summary.status == core::SessionStatus::completed);
  REQUIRE(summary.estimates.size() == 1);
}

namespace {

/// A real stream that records the tones of each glide.
struct KeptStream : FaultyStream {
  KeptStream(std::unique_ptr<Stream> real, Misfortunes& misfortunes, std::vector<audio::ToneSet>& kept)
      : FaultyStream(std::move(real), misfortunes), glides(kept) {}
  void change(std::uint32_t burst, const audio::Change& change) override {
    glides.push_back(change.to);
    FaultyStream::change(burst, change);
  }
  std::vector<audio::ToneSet>& glides;
};

/// A tone that was played, or that the operator's page shows.
struct Tone {
  double frequency_Hz = 0, full_scale = 0;
};

Tone read_tone(const view::LiveState& state) {
  for (const auto& [label, value] : state.scene)
    if (label == "Tone")
      return {1e3 * std::strtod(value.c_str(), nullptr),
              0.01 * std::strtod(value.c_str() + value.find('(') + 1, nullptr)};
  return {};
}

/// An operator who looks at the live view each time the session reports something, and only then lets the
/// slider move on. The session never waits for the view, which is drawn slowly under a sanitizer.
struct Operator : session::Monitor {
  explicit Operator(const session::Setup& setup)
      : view(setup.protocol, setup.rig, [this](const view::LiveState& state) { look(state); }) {}

  void trial_begins(const trial::TrialSpec& spec, const protocol::Block& block,
                    const session::PlanAhead::Plans& plans) override {
    expect(Awaited::begin);
    view.trial_begins(spec, block, plans);
  }
  void surface_follows(const trial::TrialSpec& spec, const scene::DrivePlan& plan) override {
    expect(Awaited::follow);
    view.surface_follows(spec, plan);
  }

  /// Makes the first move of a trial, as soon as the view has shown its beginning.
  void begin_moving() {
    const std::lock_guard lock(mutex);
    begin_asked = true;
    if (awaited == Awaited::nothing) go_on();
  }

  std::function<void()> next_move;
  std::vector<Tone> begun, followed;
  std::vector<std::string> headings;

 private:
  enum class Awaited { nothing, begin, follow };

  void expect(Awaited what) {
    const std::lock_guard lock(mutex);
    awaited = what;
  }
  void look(const view::LiveState& state) {
    const std::lock_guard lock(mutex);
    if (awaited == Awaited::nothing) return;
    if (awaited == Awaited::follow) headings.push_back(state.heading);
    (awaited == Awaited::follow ? followed : begun).push_back(read_tone(state));
    if (std::exchange(awaited, Awaited::nothing) == Awaited::follow || begin_asked) go_on();
  }
  void go_on() {
    begin_asked = false;
    next_move();
  }

  std::mutex mutex;
  Awaited awaited = Awaited::nothing;
  bool begin_asked = false;
  view::LiveView view;  // This must be the last member, because its thread writes to the others.
};

}  // namespace

TEST_CASE("while the slider moves, the operator's page shows the tone that is played", "[session][live]") {
  const TemporaryFolder folder;
  auto setup = live_room::live_setup(folder / "a.sqlite", "touch");
  setup.protocol = protocol::load(std::string(TURNPOINT_SOURCE_DIR) + "/tests/ui/adjust.toml");
  live_room::Room room;
  Operator sees(setup);
  const std::vector<double> moves{-15, -3.5, 8, 20, 2};
  std::size_t moved = 0;
  const auto move = [&] {
    const auto at = moved++ % (moves.size() + 1);
    if (at == moves.size())
      room.push(session::input::Next{});
    else
      room.push(session::input::Slider{moves[at]});
  };
  sees.next_move = move;
  room.reacts = [&](const session::Page& page) {
    if (page.kind == session::PageKind::adjust && !page.answers_open) return sees.begin_moving();
    room.cooperate(page);
  };
  std::vector<audio::ToneSet> played;
  Misfortunes none;
  auto devices = room.devices();
  devices.open_stream = [&](const audio::StreamConfig& config) {
    return std::make_unique<KeptStream>(audio::open_realtime(config), none, played);
  };
  const auto summary = session::run(setup, &room, room.inputs, std::move(devices), &sees);
  CHECK(summary.status == core::SessionStatus::completed);
  const auto trials = live_room::trials_of(setup.database, summary);
  REQUIRE(trials.size() == 2);
  REQUIRE(sees.begun.size() == 2);
  REQUIRE(played.size() == 2 * moves.size());
  REQUIRE(sees.followed.size() == played.size());
  std::set<double> frequencies;
  for (std::size_t k = 0; k < played.size(); ++k) {
    REQUIRE(played[k].count == 1);
    CHECK(sees.followed[k].frequency_Hz == Approx(played[k].tones[0].frequency_Hz).epsilon(1e-5));
    CHECK(sees.followed[k].full_scale == Approx(played[k].tones[0].amplitude).epsilon(5e-3));
    frequencies.insert(sees.followed[k].frequency_Hz);
    CHECK(sees.headings[k].find("now " + core::number(moves[k % moves.size()])) != std::string::npos);
  }
  CHECK(frequencies.size() == moves.size());
  for (std::size_t i = 0; i < 2; ++i) {
    REQUIRE(trials[i].tones.size() == 2);
    CHECK(sees.begun[i].frequency_Hz == Approx(trials[i].tones[0].frequency_Hz).epsilon(1e-5));
    CHECK(trials[i].given.response == "2");
  }
}

TEST_CASE(
    "the mean of settings estimates the point of subjective equality, and their scatter estimates its SD",
    "[procedure]") {
  procedure::Spec spec;
  spec.name = "settings", spec.level = "offset_mm", spec.kind = procedure::Kind::adjustment;
  spec.values = {-20, 20}, spec.repeats = 2;
  const auto adjustment = procedure::make_procedure(spec, {}, {});
  for (const double setting : {1.0, 2.0, 3.0, 6.0}) adjustment->record_setting(setting);
  CHECK_FALSE(adjustment->next());
  const auto pse = adjustment->estimates().at("pse");
  CHECK(pse.mean == 3);
  CHECK(pse.mode == 2.5);
  CHECK(pse.sd == Approx(std::sqrt(14.0 / 3)));
  CHECK_THROWS_AS(adjustment->record_setting(std::nan("")), std::invalid_argument);
  spec.kind = procedure::Kind::constant_stimuli;
  CHECK_THROWS_AS(procedure::make_procedure(spec, {}, {})->record_setting(1), std::logic_error);
}
