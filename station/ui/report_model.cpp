#include "station/ui/report_model.hpp"

#include <utility>

#include "station/ui/facts.hpp"

namespace turnpoint::ui {

void ReportModel::take(app::ReportPages pages) {
  QMetaObject::invokeMethod(
      this,
      [this, pages = std::move(pages)]() mutable {
        pages_ = std::move(pages);
        ready_ = true;
        emit changed();
      },
      Qt::QueuedConnection);
}

void ReportModel::clear() {
  pages_ = {};
  ready_ = false;
  emit changed();
}

QVariantList ReportModel::outcomes() const { return to_list(pages_.outcomes); }
QVariantList ReportModel::fit() const { return to_list(pages_.fit); }
QVariantList ReportModel::trade() const { return to_list(pages_.trade); }
QVariantList ReportModel::health() const { return to_list(pages_.health); }
QStringList ReportModel::statements() const { return to_list(pages_.statements); }

std::vector<std::pair<QString, QString>> ReportModel::all_pictures() const {
  std::vector<std::pair<QString, QString>> list;
  const auto add = [&list](const char* name, const std::string& svg) {
    if (!svg.empty()) list.emplace_back(name, QString::fromStdString(svg));
  };
  add("Speed and accuracy", pages_.trade_svg);
  add("Fit", pages_.fit_svg);
  add("Levels", pages_.trace_svg);
  add("Response times", pages_.times_svg);
  return list;
}

QStringList ReportModel::picture_names() const {
  QStringList names;
  for (const auto& [name, svg] : all_pictures()) names += name;
  return names;
}

QStringList ReportModel::pictures() const {
  QStringList documents;
  for (const auto& [name, svg] : all_pictures()) documents += svg;
  return documents;
}

}  // namespace turnpoint::ui
