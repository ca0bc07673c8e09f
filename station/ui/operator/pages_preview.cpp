#include "station/ui/operator/pages_preview.hpp"

#include <algorithm>
#include <exception>

#include "station/ui/operator/facts.hpp"

namespace turnpoint::ui {

PagesPreview::PagesPreview(QObject* parent)
    : QObject(parent), bridge_([] { return 0; }, [](const session::Input&) {}) {}

void PagesPreview::follow(const protocol::Protocol& protocol, const rig::Rig& rig) {
  protocol_ = protocol;
  rig_ = rig;
  languages_ = to_list(protocol.languages);
  if (!languages_.contains(language_)) language_ = languages_.value(0);
  make();
}

void PagesPreview::forget() {
  pages_.clear();
  languages_.clear();
  shown_ = 0;
  Q_EMIT changed();
}

void PagesPreview::make() {
  problem_ = {};
  try {
    pages_ = view::sample_pages(protocol_, rig_, language_.toStdString());
  } catch (const std::exception& error) {
    problem_ = explanation_of(error);
  }
  show(shown_);
}

void PagesPreview::show(int page) {
  shown_ = std::clamp(page, 0, std::max(0, static_cast<int>(pages_.size()) - 1));
  if (!pages_.empty()) bridge_.show(pages_[static_cast<std::size_t>(shown_)].page);
  Q_EMIT changed();
}

void PagesPreview::choose(const QString& language) {
  if (language == language_ || !languages_.contains(language)) return;
  language_ = language;
  make();
}

QStringList PagesPreview::names() const {
  QStringList names;
  for (const auto& page : pages_) names += QString::fromStdString(page.name);
  return names;
}

}  // namespace turnpoint::ui

#include "moc_pages_preview.cpp"
