#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>

#include "station/app/prepare.hpp"
#include "station/app/resume.hpp"
#include "station/procedure/adjustment.hpp"
#include "station/session/session.hpp"
#include "station/session/slider.hpp"
#include "station/store/read.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
namespace fs = std::filesystem;

namespace {

struct Folder {
  fs::path path;
  Folder() : path(fs::temp_directory_path() / ("turnpoint-adjustment-" + std::to_string(::getpid()))) {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
};

/// Keeps the pages with a slider; pulls the plug after so many pages.
struct Pages : session::Display {
  int left = std::numeric_limits<int>::max();
  std::vector<session::Page> sliders;
  void show(const session::Page& page) override {
    if (page.kind == session::PageKind::adjust) sliders.push_back(page);
    if (--left == 0) throw std::runtime_error("the plug was pulled");
  }
};

session::Setup setup_in(const Folder& folder, const std::string& observer) {
  const std::string source = TURNPOINT_SOURCE_DIR;
  app::RunRequest request;
  request.protocol = source + "/protocols/boundary-adjustment.toml";
  request.rig = source + "/deploy/rigs/simulated.toml";
  request.participant = "P01";
  request.database = (folder.path / "a.sqlite").string();
  request.observer = observer;
  request.seed = 7;
  return app::prepare(request);
}

std::vector<store::TrialRow> trials_of(const session::Setup& setup, const std::string& session) {
  std::vector<store::TrialRow> all;
  for (const auto& block : store::read_session(setup.database, session).blocks)
    for (const auto& trial : block.trials) all.push_back(trial);
  return all;
}

}  // namespace

TEST_CASE("a slider keeps to its steps and its range, and the surface follows at its own pace", "[session]") {
  session::Slider slider({-25, 25, 0.5, -30, 30}, -20);
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

TEST_CASE("settings come from their file into rows, with what the surface did", "[session]") {
  const Folder folder;
  const auto setup = setup_in(folder, "sim:threshold=2,bias=4,lapse=0");
  session::Inputs inputs;
  Pages pages;
  const auto summary = session::run(setup, &pages, inputs);
  CHECK(summary.status == store::SessionStatus::completed);
  const auto trials = trials_of(setup, summary.session_id);
  REQUIRE(trials.size() == 18);
  double sum = 0;
  for (const auto& trial : trials) {
    CHECK(trial.outcome == terms::Outcome::answered);
    REQUIRE(trial.response);
    const double setting = std::stod(*trial.response);
    sum += setting;
    CHECK(std::fabs(*trial.level) == 20);
    CHECK(setting != *trial.level);
    CHECK_FALSE(trial.correct);
    // The boundary that was felt last is the mark and the setting, within what the protocol tolerates.
    CHECK(*trial.boundary_mm == Approx(std::get<double>(trial.factors.at("mark_mm")) + setting).margin(0.5));
    REQUIRE(trial.tones.size() == 2);
    CHECK(trial.tones[0].scene_index == 0);
    CHECK(trial.tones[1].scene_index == 1);
    CHECK(trial.tones[1].onset_frame >= trial.tones[0].onset_frame + trial.tones[0].length_frames);
  }
  // 18 settings with an SD of 2 / 0.674: the mean lies within four standard errors of the bias.
  CHECK(sum / 18 == Approx(4).margin(4 * 2 / 0.6745 / std::sqrt(18.0)));
  REQUIRE(summary.estimates.size() == 1);
  CHECK(summary.estimates[0].parameter == "pse");
  CHECK(summary.estimates[0].mean == Approx(sum / 18));
  CHECK(*trials.back().threshold_est == Approx(sum / 18));
}

TEST_CASE("the same setting stands elsewhere on the screen from trial to trial", "[session]") {
  const Folder folder;
  session::Inputs inputs;
  Pages pages;
  session::run(setup_in(folder, "sim"), &pages, inputs);
  std::set<double> lows;
  for (const auto& page : pages.sliders) {
    CHECK(page.slider_min <= -25);
    CHECK(page.slider_max >= 25);
    CHECK(page.slider_max - page.slider_min == Approx(60));
    CHECK(page.answers.empty());
    lows.insert(page.slider_min);
  }
  CHECK(lows.size() > 5);
}

TEST_CASE("an adjustment that was interrupted goes on with the same settings", "[session]") {
  const Folder folder;
  const auto setup = setup_in(folder, "sim:bias=3");
  session::Inputs inputs;
  Pages cut;
  cut.left = 40;
  CHECK_THROWS(session::run(setup, &cut, inputs));
  std::ostringstream messages;
  const auto resumed = app::prepare_resume({setup.database, "", "resume", true}, messages);
  REQUIRE(resumed);
  const auto summary = session::run(*resumed, nullptr, inputs);
  CHECK(summary.status == store::SessionStatus::completed);
  REQUIRE(summary.estimates.size() == 1);
}

TEST_CASE("the mean of settings estimates the point of equality, their scatter its SD", "[procedure]") {
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
