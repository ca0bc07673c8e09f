#include "station/ui/operator/feeling.hpp"

#include <cmath>
#include <exception>
#include <sstream>
#include <vector>

#include "station/maintenance/play_armed.hpp"
#include "station/session/prepare.hpp"
#include "station/ui/operator/facts.hpp"
#include "station/view/preview.hpp"

namespace turnpoint::ui {

Feeling::Feeling(QObject* parent) : QObject(parent), job_(*this) {
  rest_.setSingleShot(true);
  connect(&rest_, &QTimer::timeout, this, &Feeling::changed);
}

void Feeling::follow(const protocol::Protocol& protocol, const std::string& rig, bool real) {
  protocol_ = protocol;
  rig_ = rig;
  real_ = real;
  Q_EMIT changed();
}

void Feeling::forget() {
  stop();
  protocol_.reset();
  last_.clear();
  problem_ = {};
  Q_EMIT changed();
}

void Feeling::play(const QString& scene) {
  if (!possible()) return;
  playing_ = last_ = scene;
  problem_ = {};
  tones_ = 0;
  Q_EMIT changed();
  job_.start([this, protocol = *protocol_, path = rig_,
              scene = scene.toStdString()](const std::stop_token& stop) -> std::function<void()> {
    maintenance::FeltScene felt;
    core::Phrase problem;
    try {
      std::ostringstream messages;  // the rig's page says which calibration is used
      const auto rig = session::calibrated_rig(path, "", messages);
      std::vector<std::string> assumed;
      felt = maintenance::feel_scene(rig, protocol, scene, view::factors_for(protocol, {}, assumed), stop);
    } catch (const std::exception& error) {
      problem = explanation_of(error);
    }
    return [this, felt, problem] {
      playing_.clear();
      problem_ = problem;
      seconds_ = felt.length_s;
      tones_ = felt.tones;
      peak_percent_ = static_cast<int>(std::lround(100 * felt.peak));
      if (real_ && felt.rest_s > 0) rest_.start(static_cast<int>(1e3 * felt.rest_s));
      Q_EMIT changed();
    };
  });
}

void Feeling::stop() {
  if (!playing_.isEmpty()) job_.stop();
}

}  // namespace turnpoint::ui

#include "moc_feeling.cpp"
