#include "tests/ui/scripted_session.hpp"

#include <chrono>
#include <cmath>

#include "tests/ui/gallery.hpp"

namespace turnpoint::ui {

namespace {
std::int64_t steady_ns() { return std::chrono::steady_clock::now().time_since_epoch().count(); }
}  // namespace

ScriptedSession::ScriptedSession(QObject* parent)
    : QObject(parent), bridge_(steady_ns, [this](const session::Input& input) { take(input); }) {}

void ScriptedSession::show(const QString& name, const QString& language) {
  const char* mode = name.endsWith("-pilot") ? "pilot" : name.endsWith("-simulated") ? "simulated" : "live";
  for (const auto& exhibit : gallery_in_mode(language.toStdString(), mode)) {
    if (exhibit.name == name.toStdString()) return bridge_.show(exhibit.page);
  }
  qFatal("no page %s in the gallery", qPrintable(name));
}

void ScriptedSession::showWith(const QString& name, const QString& text) {
  const auto words = text.toStdString();
  for (auto exhibit : gallery("en")) {
    if (exhibit.name != name.toStdString()) continue;
    auto& page = exhibit.page;
    for (auto* place : {&page.title, &page.text, &page.safe, &page.to_do, &page.detail}) *place = words;
    for (auto& answer : page.answers) answer.label = words;
    for (auto& line : page.summary) line.value = words;
    return bridge_.show(page);
  }
  qFatal("no page %s in the gallery", qPrintable(name));
}

QStringList ScriptedSession::pages() {
  QStringList names;
  for (const auto& exhibit : gallery("en")) names += QString::fromStdString(exhibit.name);
  return names;
}

void ScriptedSession::forget() {
  inputs_.clear();
  touches_ = 0;
  Q_EMIT inputsChanged();
}

void ScriptedSession::setKernelLead(double ms) {
  const auto lead_ns = static_cast<std::int64_t>(ms * 1e6);
  bridge_.set_kernel_time([lead_ns](double x, double y, std::int64_t seen_ns) -> std::optional<std::int64_t> {
    if (x < 0 || x > 1 || y < 0 || y > 1) return std::nullopt;
    return seen_ns - lead_ns;
  });
}

void ScriptedSession::setKernelTouch(double x, double y) {
  bridge_.set_kernel_time([=](double at_x, double at_y, std::int64_t seen_ns) {
    return std::hypot(at_x - x, at_y - y) < 0.02 ? std::optional(seen_ns) : std::nullopt;
  });
}

void ScriptedSession::forgetKernel() { bridge_.set_kernel_time({}); }

double ScriptedSession::answerAgeMs() const { return static_cast<double>(steady_ns() - answer_ns_) / 1e6; }

void ScriptedSession::take(const session::Input& input) {
  using session::InputKind;
  switch (input.kind) {
    case InputKind::answer:
      answer_ns_ = input.time_ns;
      quality_ = input.quality == session::TimeQuality::kernel ? "kernel" : "toolkit";
      inputs_ += QStringLiteral("answer %1").arg(input.value);
      break;
    case InputKind::next:
      inputs_ += "next";
      break;
    case InputKind::back:
      inputs_ += "back";
      break;
    case InputKind::slider:
      inputs_ += QStringLiteral("slider %1").arg(input.number);
      break;
    case InputKind::value:
      inputs_ += QStringLiteral("value %1").arg(input.number);
      break;
    case InputKind::touch_down:
      ++touches_;
      break;
    case InputKind::stop:
      inputs_ += "stop";
      break;
    case InputKind::pause:
      inputs_ += "pause";
      break;
    case InputKind::arm:
      inputs_ += "arm";
      break;
    case InputKind::repeat:
      inputs_ += "repeat";
      break;
    case InputKind::note:
      inputs_ += "note " + QString::fromStdString(input.text);
      break;
    case InputKind::frames_lost:
      inputs_ += QStringLiteral("frames_lost %1").arg(input.value);
      break;
    case InputKind::signal_shown:
      inputs_ += "signal_shown";
      break;
    case InputKind::contact:
    case InputKind::xrun:
    case InputKind::heard:
    case InputKind::measured:
    case InputKind::fault:
    case InputKind::failure:
    case InputKind::glitch:
    case InputKind::notice:
    case InputKind::button:
    case InputKind::disarm:
    case InputKind::sync:
      qFatal("the screen cannot send this input");
  }
  Q_EMIT inputsChanged();
}

}  // namespace turnpoint::ui
