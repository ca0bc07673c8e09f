#include "station/ui/operator/report_model.hpp"

#include <QRegularExpression>
#include <exception>
#include <map>
#include <utility>

#include "station/core/texts.hpp"
#include "station/ui/operator/facts.hpp"
#include "station/ui/operator/figure_view.hpp"

namespace turnpoint::ui {

void ReportModel::take(view::ReportPages pages) {
  QMetaObject::invokeMethod(
      this,
      [this, pages = std::move(pages)]() mutable {
        pages_ = std::move(pages);
        ready_ = true;
        Q_EMIT changed();
      },
      Qt::QueuedConnection);
}

void ReportModel::clear() {
  pages_ = {};
  saved_ = {};
  ready_ = false;
  Q_EMIT changed();
}

void ReportModel::save(int picture) {
  const auto& figures = pages_.figures;
  if (folder_.isEmpty() || picture < 0 || picture >= static_cast<int>(figures.size())) return;
  const auto& figure = figures[static_cast<std::size_t>(picture)];
  auto name = title() + " (" + run_mode() + ", " + status() + ")";
  const QString folder =
      folder_ + "/" + name.replace(QRegularExpression("[^A-Za-z0-9]+"), "-").toLower().left(80);
  try {
    save_figure(figure, folder);
    saved_ = core::plain((folder + "/").toStdString() + figure.name + "-*");
  } catch (const std::exception& error) {
    saved_ = core::phrase_of(error);
  }
  Q_EMIT changed();
}

QVariantList ReportModel::sections() const {
  QVariantList list;
  for (const auto& [heading, facts, statements] : pages_.sections)
    list += QVariantMap{
        {"heading", to_variant(heading)}, {"facts", to_list(facts)}, {"statements", to_list(statements)}};
  return list;
}

QStringList ReportModel::picture_names() const {
  static const std::map<std::string, const char*> keys{{"judgements", "report.fit"},
                                                       {"settings", "report.fit"},
                                                       {"scale", "report.scale"},
                                                       {"psychometric-function", "report.fit"},
                                                       {"threshold-curve", "report.curve"},
                                                       {"answers-to-each-stimulus", "report.answers"},
                                                       {"roc", "report.roc"},
                                                       {"response-signal", "report.signal"},
                                                       {"speed-accuracy", "report.speed_accuracy"},
                                                       {"sensitivity-over-conditions", "figure.sensitivity"},
                                                       {"response-times", "live.times"},
                                                       {"quantiles", "report.quantiles"},
                                                       {"trial-before", "report.trial_before"},
                                                       {"levels", "live.levels"},
                                                       {"finger", "report.finger"},
                                                       {"friction", "live.friction"},
                                                       {"friction-over-place", "report.following"},
                                                       {"felt-minus-asked", "report.felt_minus_asked"},
                                                       {"vibration", "report.vibration"}};
  QStringList names;
  for (const auto& figure : pages_.figures) names += QString(keys.at(figure.name));
  return names;
}

QVariantList ReportModel::pictures() const {
  QVariantList list;
  for (const auto& figure : pages_.figures) list += to_variant(figure.figure);
  return list;
}

}  // namespace turnpoint::ui

#include "moc_report_model.cpp"
