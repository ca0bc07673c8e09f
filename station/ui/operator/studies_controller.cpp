#include "station/ui/operator/studies_controller.hpp"

#include <QFileInfo>
#include <algorithm>
#include <utility>

#include "station/ui/operator/facts.hpp"

namespace turnpoint::ui {

using Kind = view::CheckWords::Remark::Kind;

StudiesController::StudiesController(session::StationRequest request, Checker checker, QObject* parent)
    : QObject(parent), request_(std::move(request)), checker_(std::move(checker)), worker_(*this) {}

void StudiesController::open() {
  const auto before = selected_ < 0 ? std::string() : protocols_[static_cast<std::size_t>(selected_)].path;
  protocols_ = view::list_studies(request_.protocols, request_.database);
  const auto found = std::find_if(protocols_.begin(), protocols_.end(),
                                  [&](const auto& entry) { return entry.path == before; });
  selected_ = -1;
  words_ = {};
  Q_EMIT changed();
  if (!protocols_.empty())
    select(found == protocols_.end() ? 0 : static_cast<int>(found - protocols_.begin()));
}

void StudiesController::select(int index) {
  if (index < 0 || index >= static_cast<int>(protocols_.size())) return;
  selected_ = index;
  words_ = {};
  checking_ = true;
  Q_EMIT changed();
  worker_.start([this, path = protocols_[static_cast<std::size_t>(index)].path,
                 rig = request_.rig](const std::stop_token& stop) -> std::function<void()> {
    try {
      return [this, words = view::words_of(checker_(path, rig, stop))] { take(words); };
    } catch (const protocol::Abandoned&) {
      return {};
    } catch (const std::exception& error) {
      view::CheckWords words;
      for (auto& problem : phrases_of(error))
        words.remarks.push_back({Kind::problem, "", 0, std::move(problem), {}});
      return [this, words] { take(words); };
    }
  });
}

void StudiesController::selectFile(const QString& path) {
  open();
  for (std::size_t i = 0; i < protocols_.size(); ++i)
    if (QString::fromStdString(protocols_[i].path) == path) select(static_cast<int>(i));
}

QString StudiesController::path(int index) const {
  if (index < 0 || index >= static_cast<int>(protocols_.size())) return {};
  return QString::fromStdString(protocols_[static_cast<std::size_t>(index)].path);
}

void StudiesController::take(view::CheckWords words) {
  words_ = std::move(words);
  checking_ = false;
  Q_EMIT changed();
}

QVariantList StudiesController::protocols() const {
  QVariantList list;
  for (const auto& entry : protocols_) {
    const auto file = QFileInfo(QString::fromStdString(entry.path)).fileName();
    list += QVariantMap{{"id", entry.id.empty() ? file : QString::fromStdString(entry.id)},
                        {"title", QString::fromStdString(entry.title)},
                        {"file", file},
                        {"usable", entry.problems.empty()}};
  }
  return list;
}

QString StudiesController::verdict() const {
  if (selected_ < 0) return "";
  if (checking_) return "checking";
  const auto has = [this](Kind kind) {
    return std::any_of(words_.remarks.begin(), words_.remarks.end(),
                       [kind](const auto& remark) { return remark.kind == kind; });
  };
  return has(Kind::problem) ? "bad" : has(Kind::warning) ? "warned" : "good";
}

QVariantList StudiesController::remarks() const {
  QVariantList list;
  for (const auto& remark : words_.remarks) {
    const auto* kind = remark.kind == Kind::problem   ? "problem"
                       : remark.kind == Kind::warning ? "warning"
                                                      : "note";
    list += QVariantMap{{"kind", kind},
                        {"file", QString::fromStdString(remark.file)},
                        {"line", remark.line},
                        {"what", to_variant(remark.what)},
                        {"hint", to_variant(remark.hint)}};
  }
  return list;
}

QVariantList StudiesController::facts() const { return to_list(words_.facts); }

QVariantList StudiesController::cues() const {
  QVariantList list;
  for (const auto& cue : words_.cues)
    list += QVariantMap{{"name", to_variant(cue.name)},
                        {"says", to_variant(cue.says)},
                        {"leaks", cue.leaks},
                        {"advice", to_variant(cue.advice)}};
  return list;
}

}  // namespace turnpoint::ui

#include "moc_studies_controller.cpp"
