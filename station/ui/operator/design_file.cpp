// The designer's controller and the file: saving, and what is suggested while somebody types its text.
#include <QFile>
#include <QFileInfo>
#include <algorithm>
#include <exception>
#include <utility>

#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/system/write_file.hpp"
#include "station/ui/operator/design_controller.hpp"
#include "station/ui/operator/design_lists.hpp"
#include "station/ui/operator/facts.hpp"

namespace turnpoint::ui {

std::string DesignController::kept_path() const {
  return place_.folder + (place_.folder.empty() ? "" : "/") + ".unsaved-study";
}

/// Writes the text beside the studies as it is changed, so that it survives the end of the program: the path
/// of the study in the first line, then its text.
void DesignController::keep_draft() const {
  if (!unsaved()) return;
  try {
    if (!place_.folder.empty()) system::make_folder(place_.folder);
    system::write_file(kept_path(), path_ + "\n" + draft_->text(), 0666, system::Replaces::input);
  } catch (const std::exception&) {
    // The folder cannot be written, which saving the study says.
  }
}

QString DesignController::kept() const {
  if (draft_) return "";
  QFile file(QString::fromStdString(kept_path()));
  if (!file.open(QIODevice::ReadOnly)) return "";
  return QFileInfo(QString::fromUtf8(file.readLine()).trimmed()).completeBaseName();
}

bool DesignController::continueKept() try {
  const auto all = core::read_text_file(kept_path());
  const auto end = all.find('\n');
  const auto path = all.substr(0, end);
  saved_ = QFileInfo::exists(QString::fromStdString(path)) ? core::read_text_file(path) : "";
  old_version_.clear();
  begin(end == std::string::npos ? "" : all.substr(end + 1), path);
  return true;
} catch (const std::exception& error) {
  return refuse(phrases_of(error).front());
}

void DesignController::discardKept() {
  QFile::remove(QString::fromStdString(kept_path()));
  Q_EMIT changed();
}

bool DesignController::changed_on_disk() const {
  return !saved_.empty() && QFileInfo::exists(QString::fromStdString(path_)) &&
         core::read_file(path_) != saved_;
}

/// Sessions of the old text and of the new one must not be taken for the same study, so the version differs.
void DesignController::raise_version() {
  const auto version = std::exchange(old_version_, "");
  const auto* part =
      draft_->document() == nullptr ? nullptr : draft_->document()->find({"protocol", "version"});
  if (version.empty() || part == nullptr || part->scalar.string != version) return;
  take_change(
      draft_->document()->with({"protocol", "version"}, view::toml_string(view::next_version(version))));
}

bool DesignController::write_to(const std::string& path) {
  if (!place_.folder.empty()) system::make_folder(place_.folder);
  system::write_file(path, draft_->text(), 0666, system::Replaces::input);
  path_ = path;
  name_ = QFileInfo(QString::fromStdString(path)).completeBaseName().toStdString();
  saved_ = draft_->text();
  discardKept();
  saved_as_ = QString::fromStdString(path);
  trouble_ = {};
  Q_EMIT changed();
  Q_EMIT saved();
  return true;
}

bool DesignController::save(const QString& name) try {
  if (!draft_) return false;
  if (name.isEmpty() || name.toStdString() == name_) {
    if (changed_on_disk()) return refuse(core::plain("on_disk"));
    raise_version();
    return write_to(path_);
  }
  if (!is_name(name)) return refuse(core::plain("name"));
  const auto path = path_for(name.toStdString());
  if (QFileInfo::exists(QString::fromStdString(path))) return refuse(core::plain("taken"));
  if (draft_->document() == nullptr) return refuse(draft_->problems().front().what);
  take_change(draft_->document()->with({"protocol", "id"}, view::toml_string(name.toStdString())));
  old_version_.clear();
  return write_to(path);
} catch (const std::exception& error) {
  return refuse(phrases_of(error).front());
}

bool DesignController::overwrite() try {
  if (!draft_) return false;
  raise_version();
  return write_to(path_);
} catch (const std::exception& error) {
  return refuse(phrases_of(error).front());
}

/// The reloaded text is one more change, so undo() returns to the text that was edited.
bool DesignController::reload() try {
  if (!draft_) return false;
  const auto text = core::read_text_file(path_);
  saved_ = text;
  take_change(text);
  return true;
} catch (const std::exception& error) {
  return refuse(phrases_of(error).front());
}

}  // namespace turnpoint::ui
