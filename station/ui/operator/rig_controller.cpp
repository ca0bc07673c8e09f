#include "station/ui/operator/rig_controller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "station/core/number.hpp"
#include "station/maintenance/doctor.hpp"
#include "station/rig/apply.hpp"
#include "station/rig/calibration.hpp"
#include "station/rig/rig.hpp"
#include "station/session/prepare.hpp"
#include "station/session/self_test_rig.hpp"
#include "station/ui/operator/facts.hpp"

namespace turnpoint::ui {

namespace {

/// The page warns that a calibration will expire, from this number of days before it does.
constexpr int kSoon_days = 14;

QVariantMap fact(const char* label, const QVariant& value, const char* text = "") {
  return {{"label", label}, {"text", text}, {"value", value}, {"parts", QStringList()}};
}

/// The keys of the texts for what was measured for a calibration.
QStringList measured(const rig::Calibration& made) {
  QStringList parts;
  const auto add = [&parts](bool there, const char* what) {
    if (there) parts += what;
  };
  add(!made.transducers.empty(), "operator.measured_response");
  add(made.boundary.has_value(), "operator.measured_boundary");
  add(made.friction.has_value(), "operator.measured_friction");
  add(!made.sound.empty(), "operator.measured_sound");
  add(made.panel.has_value(), "operator.measured_panel");
  add(!made.pick_ups.empty(), "operator.measured_pick_ups");
  add(made.forces.has_value(), "operator.measured_forces");
  return parts;
}

QVariantList facts_of(const rig::Calibration& made, const std::string& path, int left_days) {
  auto parts = fact("operator.fact_measured", "");
  parts["parts"] = measured(made);
  QVariantList facts{
      fact("operator.fact_file", QString::fromStdString(std::filesystem::path(path).filename().string())),
      fact("operator.fact_made", QString::fromStdString(made.made_on)),
      fact("operator.fact_valid", QString::number(std::abs(left_days)),
           left_days >= 0 ? "operator.fact_days_left" : "operator.fact_expired"),
      parts};
  if (!made.note.empty()) facts += fact("operator.fact_note", QString::fromStdString(made.note));
  return facts;
}

const char* word(io::Finding::Status status) {
  using Status = io::Finding::Status;
  return status == Status::ok ? "ok" : status == Status::warning ? "warning" : "failed";
}

const char* word(session::Request::Kind kind) {
  using Kind = session::Request::Kind;
  return kind == Kind::press_stop     ? "press_stop"
         : kind == Kind::release_stop ? "release_stop"
                                      : "press_button";
}

/// Rounds to this number of decimals. What rounds to zero has no sign.
core::Phrase fixed(double value, int decimals) {
  const double unit = std::pow(10.0, -decimals);
  return core::plain(fmt::format("{:.{}f}", std::abs(value) < unit / 2 ? 0.0 : value, decimals));
}

/// Returns rows for the page: uncertainty and resonance of the force calibration, and each weight with its
/// residual.
QVariantList weights_of(const maintenance::ForceResult& result, const std::string& file) {
  using core::phrase;
  QVariantList list;
  const auto add = [&list](const core::Phrase& name, bool good, const core::Phrase& what) {
    list += QVariantMap{{"name", to_variant(name)},
                        {"verdict", good ? "ok" : "warning"},
                        {"what", to_variant(what)},
                        {"share", -1.0}};
  };
  add(phrase("operator.weights_uncertainty"), true,
      phrase(
          "operator.weights_uncertainty_text",
          {fixed(result.sd.position_mm, 2), fixed(result.sd.friction, 4), fixed(1e3 * result.sd.lateral_N, 1),
           fixed(result.zero_moved_mN, 2), core::plain(std::filesystem::path(file).filename().string())}));
  add(phrase("operator.weights_resonance"), result.resonance_Hz.has_value(),
      result.resonance_Hz ? phrase("operator.weights_resonance_text",
                                   {core::plain(core::number(*result.resonance_Hz, 3)),
                                    core::plain(core::number(result.cells.usable_Hz.value(), 3))})
                          : phrase("operator.weights_resonance_unknown"));
  for (std::size_t k = 0; k < result.steps.size(); ++k) {
    const auto& rest = result.residuals[k];
    const std::vector<core::Phrase> values{fixed(1e3 * rest.normal_N, 2), fixed(1e3 * rest.lateral_N, 2),
                                           fixed(rest.position_mm, 2)};
    const bool once = result.steps[k].remark.empty();
    add(result.steps[k].name(), once,
        once ? phrase("operator.weights_residual", values)
             : phrase("operator.weights_residual_again", values));
  }
  return list;
}

/// Returns a reading as a share of its limit, from 0 to 1; -1 if the check has no number.
double share_of_limit(const session::Check& check) {
  if (!check.value || !check.limit || *check.limit == 0) return -1;
  return std::min(1.0, std::abs(*check.value / *check.limit));
}

}  // namespace

RigController::RigController(const session::StationRequest& request, QObject* parent)
    : QObject(parent),
      rig_(request.rig),
      data_folder_(std::filesystem::absolute(request.database).parent_path().string()),
      guide_(request.rig),
      worker_(*this) {
  connect(&guide_, &CalibrationGuide::finished, this, &RigController::open);
}

void RigController::open() {
  calibration_.clear();
  calibration_state_ = "none";
  if (busy_.isEmpty()) errors_.clear();
  try {
    const auto rig = rig::load(rig_);
    has_cells_ = rig::has_force_cells(rig);
    const auto file = rig::newest_for(rig.path);
    if (!file.empty()) {
      const auto made = rig::load_calibration(file);
      const auto today = rig::today();
      const int left_days = rig::days_left(made, today);
      calibration_ = facts_of(made, file, left_days);
      const auto problems = rig::problems(made, rig.sha256, today);
      for (const auto& problem : problems)
        calibration_ += fact("operator.fact_not_used", to_variant(problem));
      calibration_state_ = !problems.empty() ? "bad" : left_days <= kSoon_days ? "ageing" : "good";
    }
  } catch (const std::exception& error) {
    calibration_state_ = "bad";
    errors_ = to_list(phrases_of(error));
  }
  Q_EMIT changed();
}

/// Runs a job on the worker thread, unless another one is running. The function that it returns runs on the
/// GUI thread.
void RigController::run(const QString& what, NewestJob::Job job) {
  if (!busy_.isEmpty()) return;
  busy_ = what;
  errors_.clear();
  Q_EMIT changed();
  worker_.start([this, job = std::move(job)](const std::stop_token& stop) -> std::function<void()> {
    std::function<void()> result;
    std::vector<core::Phrase> errors;
    try {
      result = job(stop);
    } catch (const std::exception& error) {
      errors = phrases_of(error);
    }
    return [this, result, errors] {
      busy_.clear();
      asked_.clear();
      errors_ = to_list(errors);
      if (result) result();
      Q_EMIT changed();
    };
  });
}

void RigController::examine() {
  findings_.clear();
  run("doctor", [this](const std::stop_token&) -> std::function<void()> {
    std::ostringstream messages;  // not shown, because the page shows the calibration elsewhere
    auto findings = maintenance::examine(session::calibrated_rig(rig_, "", messages), data_folder_);
    return [this, findings = std::move(findings)] { findings_ = findings; };
  });
}

void RigController::selfTest() {
  checks_.clear();
  run("self_test", [this](const std::stop_token&) -> std::function<void()> {
    std::ostringstream messages;
    const auto rig = session::calibrated_rig(rig_, "", messages);
    auto checks = session::self_test(
        rig,
        [this](const session::Request& request) {
          QMetaObject::invokeMethod(
              this,
              [this, what = QString(word(request.kind)), button = QString::fromStdString(request.name)] {
                ask(what, button);
              },
              Qt::QueuedConnection);
        },
        data_folder_);
    return [this, checks = std::move(checks)] { checks_ = checks; };
  });
}

void RigController::weigh() {
  weights_.clear();
  run("weights", [this](const std::stop_token& stop) -> std::function<void()> {
    const auto rig = rig::load(rig_);
    const auto show = [this](const Weighing::Shown& shown) {
      QMetaObject::invokeMethod(
          this, [this, shown] { this->show(shown); }, Qt::QueuedConnection);
    };
    const auto result = weighing_.run(rig, show, stop);
    if (!result) return {};
    const auto file = maintenance::write_forces(rig, result->cells, "");
    return [this, list = weights_of(*result, file)] {
      weights_ = list;
      open();
    };
  });
}

void RigController::answer(const QString& answer) {
  using Answer = Weighing::Answer;
  if (busy_ != "weights" || asked_.isEmpty()) return;
  asked_.clear();  // a second tap must not answer the next question
  weighing_.answer(answer == "read"        ? Answer::read
                   : answer == "leave_out" ? Answer::leave_out
                                           : Answer::stop);
  Q_EMIT changed();
}

void RigController::show(const Weighing::Shown& shown) {
  if (busy_ != "weights") return;
  reading_.clear();
  step_.clear();
  if (shown.step) {
    const auto& step = *shown.step;
    step_ = {{"asked", to_variant(step.text())},
             {"remark", to_variant(step.remark)},
             {"converter", shown.converter},
             {"trouble", to_variant(shown.trouble)},
             {"unread", to_variant(shown.unread)}};
    if (shown.unread.empty())
      for (const double cell : shown.cells)
        reading_ += shown.converter ? QString::number(cell, 'g', 5) : QString::number(cell, 'f', 2);
  }
  asked_ = !shown.step ? "" : !shown.trouble.empty() ? "repair" : "weight";
  Q_EMIT changed();
}

void RigController::ask(const QString& what, const QString& button) {
  if (busy_.isEmpty()) return;
  asked_ = what;
  asked_button_ = button;
  Q_EMIT changed();
}

QVariantList RigController::findings() const {
  QVariantList list;
  for (const auto& finding : findings_)
    list += QVariantMap{{"name", to_variant(finding.name)},
                        {"status", word(finding.status)},
                        {"what", to_variant(finding.what)},
                        {"mend", to_variant(finding.mend)}};
  return list;
}

QVariantList RigController::checks() const {
  QVariantList list;
  for (const auto& check : checks_)
    list += QVariantMap{{"name", to_variant(check.name)},
                        {"verdict", check.verdict == session::Verdict::passed   ? "ok"
                                    : check.verdict == session::Verdict::failed ? "failed"
                                                                                : "absent"},
                        {"what", to_variant(check.what)},
                        {"share", share_of_limit(check)}};
  return list;
}

}  // namespace turnpoint::ui

#include "moc_rig_controller.cpp"
