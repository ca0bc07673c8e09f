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
    for (auto* place : {&page.title, &page.text, &page.safe, &page.to_do, &page.fault.detail}) *place = words;
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

namespace {

using namespace session::input;

/// What the list of inputs says of an input that the screen can send.
QString in_words(const session::Input& input) {
  if (const auto* answer = input.as<Answer>()) return QStringLiteral("answer %1").arg(answer->index);
  if (const auto* slider = input.as<Slider>()) return QStringLiteral("slider %1").arg(slider->value);
  if (const auto* value = input.as<Value>()) return QStringLiteral("value %1").arg(value->number);
  if (const auto* note = input.as<Note>()) return "note " + QString::fromStdString(note->text);
  if (const auto* lost = input.as<FramesLost>()) return QStringLiteral("frames_lost %1").arg(lost->frames);
  if (input.is<Next>()) return "next";
  if (input.is<Back>()) return "back";
  if (input.is<Stop>()) return "stop";
  if (input.is<Pause>()) return "pause";
  if (input.is<Arm>()) return "arm";
  if (input.is<Repeat>()) return "repeat";
  if (input.is<SignalShown>()) return "signal_shown";
  qFatal("the screen cannot send this input");
}

}  // namespace

void ScriptedSession::take(const session::Input& input) {
  if (input.is<Answer>()) {
    answer_ns_ = input.time_ns;
    quality_ = input.quality == session::TimeQuality::kernel ? "kernel" : "toolkit";
  }
  if (input.is<Touch>())
    ++touches_;
  else
    inputs_ += in_words(input);
  Q_EMIT inputsChanged();
}

}  // namespace turnpoint::ui
