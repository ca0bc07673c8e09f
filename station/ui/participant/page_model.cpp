#include "station/ui/participant/page_model.hpp"

#include <QUrl>
#include <algorithm>
#include <cmath>
#include <utility>

#include "station/ui/shared/early_session.hpp"
#include "station/ui/shared/phrases.hpp"

namespace turnpoint::ui {

namespace {

/// A pace is known after so many trials.
constexpr int kTrialsForPace = 5;

}  // namespace

int PageModel::minutes_left() const {
  const int done = page_.trials_done - began_with_, left = page_.trials_total - page_.trials_done;
  if (done < kTrialsForPace || left <= 0) return -1;
  return std::max(1, static_cast<int>(std::ceil((now_s() - began_s_) / done * left / 60)));
}

void PageModel::set(session::Page page) {
  // a session that begins or is resumed
  if (page_.trials_total == 0 || page.trials_done < page_.trials_done) {
    began_s_ = now_s();
    began_with_ = page.trials_done;
  }
  page_ = std::move(page);
  Q_EMIT changed();
  Q_EMIT barsMoved();
}

void PageModel::guide(const session::Guidance& guidance) {
  if (!page_.guidance) return;  // the page changed meanwhile
  page_.guidance = guidance;
  Q_EMIT barsMoved();
}

namespace {

QList<double> bar_of(const std::optional<session::Guidance::Bar>& bar) {
  return bar ? QList<double>{bar->value.value_or(-1), bar->low, bar->high} : QList<double>{};
}

}  // namespace

QList<double> PageModel::force_bar() const {
  return page_.guidance ? bar_of(page_.guidance->force) : QList<double>{};
}

QList<double> PageModel::speed_bar() const {
  return page_.guidance ? bar_of(page_.guidance->speed) : QList<double>{};
}

PageModel::Kind PageModel::kind() const {
  using session::PageKind;
  switch (page_.kind) {
    case PageKind::instructions:
      return Kind::Instructions;
    case PageKind::cue:
      return Kind::Cue;
    case PageKind::stimulus:
      return Kind::Stimulus;
    case PageKind::pause:
      return Kind::Pause;
    case PageKind::response:
      return Kind::Response;
    case PageKind::confidence:
      return Kind::Confidence;
    case PageKind::question:
      return Kind::Question;
    case PageKind::explanation:
      return Kind::Explanation;
    case PageKind::line:
      return Kind::Line;
    case PageKind::number:
      return Kind::Number;
    case PageKind::feedback:
      return Kind::Feedback;
    case PageKind::interval:
      return Kind::Interval;
    case PageKind::rest:
      return Kind::Rest;
    case PageKind::adjust:
      return Kind::Adjust;
    case PageKind::fault:
      return Kind::Fault;
    case PageKind::paused:
      return Kind::Paused;
    case PageKind::end:
      return Kind::End;
    case PageKind::failed:
      return Kind::Failed;
  }
  return Kind::Interval;
}

QString PageModel::picture() const {
  return page_.picture.empty() ? QString()
                               : QUrl::fromLocalFile(QString::fromStdString(page_.picture)).toString();
}

PageModel::Verdict PageModel::verdict() const {
  if (!page_.correct) return Verdict::Message;
  return *page_.correct ? Verdict::Right : Verdict::Wrong;
}

QStringList PageModel::answers() const {
  QStringList labels;
  for (const auto& answer : page_.answers) labels += QString::fromStdString(answer.label);
  return labels;
}

QStringList PageModel::captions() const {
  QStringList captions;
  for (const auto& answer : page_.answers) captions += QString::fromStdString(answer.caption);
  return captions;
}

QVariantMap PageModel::early() const { return page_.early ? to_map(*page_.early) : QVariantMap(); }

QStringList PageModel::anchor_texts() const {
  QStringList texts;
  for (const auto& text : page_.value.texts) texts += QString::fromStdString(text);
  return texts;
}

QStringList PageModel::interval_names() const {
  QStringList names;
  for (const auto& name : page_.interval.names) names += QString::fromStdString(name);
  return names;
}

QVariantList PageModel::summary_labels() const {
  QVariantList labels;
  for (const auto& line : page_.summary) labels += to_variant(line.label);
  return labels;
}

QStringList PageModel::summary_values() const {
  QStringList values;
  for (const auto& line : page_.summary) values += QString::fromStdString(line.value);
  return values;
}

}  // namespace turnpoint::ui

#include "moc_page_model.cpp"
