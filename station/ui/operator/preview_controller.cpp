#include "station/ui/operator/preview_controller.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

#include "station/core/texts.hpp"
#include "station/session/prepare.hpp"
#include "station/ui/operator/facts.hpp"
#include "station/ui/platform/vector_state.hpp"
#include "station/view/scene_figures.hpp"

namespace turnpoint::ui {
namespace {

rig::Rig rig_of(const std::string& path) {
  std::ostringstream messages;
  return session::calibrated_rig(path, "", messages);
}

}  // namespace

PreviewController::PreviewController(const view::PreviewRequest& request, QObject* parent)
    : QObject(parent),
      preview_(protocol::load(request.protocol), rig_of(request.rig)),
      scenes_(preview_.scenes()) {
  std::vector<std::string> assumed;
  factors_ = view::factors_for(preview_.protocol(), request.set, assumed);
  if (!request.scene.empty()) {
    const auto found = std::find(scenes_.begin(), scenes_.end(), request.scene);
    if (found == scenes_.end())
      throw core::Refusal(core::phrase("refusal.no_scene", {core::plain(request.scene)}));
    scene_ = static_cast<int>(found - scenes_.begin());
  }
  worker_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
  plan();
}

PreviewController::~PreviewController() = default;

QString PreviewController::title() const { return QString::fromStdString(preview_.protocol().title); }
QString PreviewController::rig() const { return QString::fromStdString(preview_.rig().name); }
QStringList PreviewController::scenes() const { return to_list(scenes_); }
QVariantList PreviewController::facts() const { return to_list(look_.facts); }
QVariantList PreviewController::cues() const { return to_list(look_.cues); }

QVariantList PreviewController::knobs() const {
  QVariantList list;
  for (const auto& knob : preview_.knobs(scenes_[static_cast<std::size_t>(scene_)])) {
    QVariantList levels;
    for (const double level : knob.levels) levels += level;
    const auto* value = std::get_if<double>(&factors_.at(knob.name));
    list += QVariantMap{{"name", QString::fromStdString(knob.name)},
                        {"low", knob.low},
                        {"high", knob.high},
                        {"levels", levels},
                        {"value", value != nullptr ? *value : knob.value}};
  }
  return list;
}

void PreviewController::choose(int scene) {
  if (scene < 0 || scene >= static_cast<int>(scenes_.size()) || scene == scene_) return;
  scene_ = scene;
  Q_EMIT sceneChanged();
  plan();
}

void PreviewController::set_language(const QString& language) {
  if (language == language_) return;
  language_ = language;
  plan();
}

void PreviewController::set(const QString& factor, double value) {
  const auto found = factors_.find(factor.toStdString());
  if (found == factors_.end() || !std::holds_alternative<double>(found->second)) return;
  if (std::get<double>(found->second) == value) return;
  found->second = value;
  plan();
}

void PreviewController::plan() {
  busy_ = true;
  Q_EMIT changed();
  {
    const std::lock_guard lock(mutex_);
    wanted_ = Wanted{scenes_[static_cast<std::size_t>(scene_)], factors_, language_.toStdString()};
  }
  arrived_.notify_one();
}

void PreviewController::work(const std::stop_token& stop) {
  clear_upper_halves();
  for (;;) {
    Wanted wanted;
    {
      std::unique_lock lock(mutex_);
      if (!arrived_.wait(lock, stop, [this] { return wanted_.has_value(); })) return;
      wanted = *std::exchange(wanted_, std::nullopt);
    }
    QMetaObject::invokeMethod(
        this, [this, drawn = draw(wanted)]() mutable { take(std::move(drawn)); }, Qt::QueuedConnection);
  }
}

/// Runs on the worker thread. Once that thread has started, no other function may use the planner.
PreviewController::Drawn PreviewController::draw(const Wanted& wanted) {
  Drawn drawn;
  try {
    drawn.look = preview_.look(wanted.scene, wanted.factors);
  } catch (const std::exception& error) {
    drawn.look.problem = error.what();
  }
  if (!drawn.look.problem.empty()) return drawn;
  drawn.surface = to_variant(view::drawing_of_surface(drawn.look, preview_.rig(), wanted.language));
  drawn.profile = to_variant(view::drawing_of(view::profile_figure({drawn.look}, wanted.language)));
  drawn.spectrum = to_variant(view::drawing_of(view::spectrum_figure(drawn.look, wanted.language)));
  return drawn;
}

void PreviewController::take(Drawn drawn) {
  look_ = std::move(drawn.look);
  surface_ = drawn.surface, profile_ = drawn.profile, spectrum_ = drawn.spectrum;
  {
    const std::lock_guard lock(mutex_);
    busy_ = wanted_.has_value();
  }
  Q_EMIT changed();
}

}  // namespace turnpoint::ui

#include "moc_preview_controller.cpp"
