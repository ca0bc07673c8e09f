#include "station/ui/operator/report_model.hpp"

#include <QRegularExpression>
#include <exception>
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
  const auto pictures = all_pictures();
  if (folder_.isEmpty() || picture < 0 || picture >= static_cast<int>(pictures.size())) return;
  const auto& [name, drawing] = pictures[static_cast<std::size_t>(picture)];
  const auto file_name = [](QString text) {
    return text.replace(QRegularExpression("[^A-Za-z0-9]+"), "-").toLower();
  };
  const QString folder =
      folder_ + "/" + file_name(title() + " (" + run_mode() + ", " + status() + ")").left(80);
  // Files have the same names in every language.
  const QString file = file_name(QString::fromStdString(core::text(name.toStdString(), "en")));
  try {
    save_drawing(drawing, folder, file);
    saved_ = core::plain((folder + "/" + file + ".svg, .pdf").toStdString());
  } catch (const std::exception& error) {
    saved_ = core::phrase_of(error);
  }
  Q_EMIT changed();
}

QVariantList ReportModel::outcomes() const { return to_list(pages_.outcomes); }
QVariantList ReportModel::fit() const { return to_list(pages_.fit); }
QVariantList ReportModel::trade() const { return to_list(pages_.speed_accuracy); }
QVariantList ReportModel::forces() const { return to_list(pages_.forces); }
QVariantList ReportModel::health() const { return to_list(pages_.health); }
QVariantList ReportModel::statements() const { return to_list(pages_.statements); }

std::vector<std::pair<QString, view::Drawing>> ReportModel::all_pictures() const {
  std::vector<std::pair<QString, view::Drawing>> list;
  const auto add = [&list](const char* name, const view::Drawing& drawing) {
    if (drawing) list.emplace_back(name, drawing);
  };
  if (pages_.compares_instructions) add("report.speed_accuracy", pages_.trade);
  add("report.fit", pages_.fits);
  if (!pages_.compares_instructions) add("report.speed_accuracy", pages_.trade);
  add("live.levels", pages_.levels);
  add("live.times", pages_.times);
  add("report.finger", pages_.finger);
  add("live.friction", pages_.friction);
  return list;
}

QStringList ReportModel::picture_names() const {
  QStringList names;
  for (const auto& [name, drawing] : all_pictures()) names += name;
  return names;
}

QVariantList ReportModel::pictures() const {
  QVariantList list;
  for (const auto& [name, drawing] : all_pictures()) list += to_variant(drawing);
  return list;
}

}  // namespace turnpoint::ui

#include "moc_report_model.cpp"
