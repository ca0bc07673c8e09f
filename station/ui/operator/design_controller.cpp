#include "station/ui/operator/design_controller.hpp"

#include <QFileInfo>
#include <algorithm>
#include <exception>
#include <sstream>
#include <utility>

#include "station/core/read_file.hpp"
#include "station/core/texts.hpp"
#include "station/core/toml.hpp"
#include "station/maintenance/play_armed.hpp"
#include "station/session/prepare.hpp"
#include "station/ui/operator/design_lists.hpp"
#include "station/ui/operator/facts.hpp"
#include "station/ui/operator/figure_view.hpp"
#include "station/view/goals.hpp"
#include "station/view/scene_figures.hpp"
#include "station/view/trial_timeline.hpp"

namespace turnpoint::ui {

namespace {

rig::Rig rig_without_messages(const std::string& path) {
  std::ostringstream messages;
  return session::calibrated_rig(path, "", messages);
}

/// The first problem of a value that was refused, without the name of a file.
core::Phrase reason(const core::BadInput& bad) {
  auto problem = bad.problems().front();
  problem.place = {};
  return phrase_of(problem);
}

}  // namespace

DesignController::DesignController(DesignPlace place, SourceChecker checker, QObject* parent)
    : QObject(parent),
      place_(std::move(place)),
      checker_(std::move(checker)),
      check_job_(*this),
      profile_job_(*this) {}

std::string DesignController::path_for(const std::string& name) const {
  return place_.folder + (place_.folder.empty() ? "" : "/") + name + ".toml";
}

bool DesignController::refuse(core::Phrase trouble) {
  trouble_ = std::move(trouble);
  Q_EMIT changed();
  return false;
}

void DesignController::startNew() {
  draft_.reset();
  stage_ = "goals";
  trouble_ = {};
  Q_EMIT changed();
}

void DesignController::close() {
  if (draft_) discardKept();
  draft_.reset();
  check_job_.abandon();
  profile_job_.abandon();
  pages_.forget();
  precision_.forget();
  feeling_.forget();
  stage_.clear();
  trouble_ = {};
  Q_EMIT changed();
}

bool DesignController::make(const QString& goal, const QString& name) try {
  const bool empty = goal == "empty";
  const auto* chosen = view::find_goal(goal.toStdString());
  if (chosen == nullptr && !empty) return false;
  if (!is_name(name)) return refuse(core::plain("name"));
  const auto path = path_for(name.toStdString());
  if (QFileInfo::exists(QString::fromStdString(path))) return refuse(core::plain("taken"));
  auto source =
      empty ? view::empty_study(name.toStdString())
            : view::study_from(*chosen, core::read_file(place_.templates + "/" + chosen->file + ".toml"),
                               name.toStdString());
  saved_.clear(), old_version_.clear();
  begin(std::move(source), path);
  return true;
} catch (const std::exception& error) {
  return refuse(phrases_of(error).front());
}

bool DesignController::open(const QString& path) try {
  const auto text = core::read_text_file(path.toStdString());
  saved_ = text;
  begin(text, path.toStdString());
  old_version_.clear();
  if (draft_->document() != nullptr)
    if (const auto* version = draft_->document()->find({"protocol", "version"}); version != nullptr)
      old_version_ = version->scalar.string;
  return true;
} catch (const std::exception& error) {
  return refuse(phrases_of(error).front());
}

void DesignController::begin(std::string text, const std::string& path) {
  if (!rig_) {
    rig_ = rig_without_messages(place_.rig);
    surface_ = {rig::outline_of(*rig_)};
  }
  path_ = path;
  name_ = QFileInfo(QString::fromStdString(path)).completeBaseName().toStdString();
  draft_.emplace(std::move(text), path);
  stage_ = "form";
  section_ = 0;
  trouble_ = {}, saved_as_.clear(), profiles_.clear();
  form_.clear();
  read_again();
}

void DesignController::take_change(std::string text) {
  draft_->change(std::move(text));
  trouble_ = {}, saved_as_.clear();
  read_again();
}

/// Reads the text, shows the reader's remarks at once, and starts the check, which takes longer.
void DesignController::read_again() {
  remarks_.clear();
  words_ = {};
  checking_ = false;
  timeline_.clear();
  try {
    const auto protocol = protocol::parse(draft_->text(), path_);
    timeline_ = to_list(view::trial_timeline(protocol));
    pages_.follow(protocol, *rig_);
    precision_.follow(protocol);
    feeling_.follow(protocol, place_.rig, maintenance::can_be_felt(*rig_));
    checking_ = true;
  } catch (const core::BadInput& bad) {
    for (const auto& problem : bad.problems()) remarks_.push_back({Kind::problem, problem});
  }
  make_form();
  keep_draft();
  Q_EMIT changed();
  if (!checking_) return check_job_.abandon();
  start_check();
  start_profiles();
}

void DesignController::make_form() {
  // While the text is not valid TOML, the forms keep their last state, but nothing can be changed in them.
  if (draft_->document() == nullptr) {
    for (auto& section : form_)
      for (auto& group : section.groups) {
        group.remarks.clear();
        for (auto& field : group.fields) field.remarks.clear();
      }
    return;
  }
  std::vector<core::Problem> problems;
  for (const auto& remark : remarks_) problems.push_back(remark.problem);
  form_ = view::form_of(*draft_->document(), problems);
}

void DesignController::start_check() {
  check_job_.start([this, source = draft_->text(), path = path_,
                    rig = place_.rig](const std::stop_token& stop) -> std::function<void()> {
    try {
      return [this, check = checker_(source, path, rig, stop)] { take(check); };
    } catch (const protocol::Abandoned&) {
      return {};
    } catch (const std::exception& error) {
      rehearsal::Check failed;
      failed.problems.push_back({{path, 0, 0}, core::phrase_of(error), {}});
      return [this, failed] { take(failed); };
    }
  });
}

void DesignController::start_profiles() {
  profile_job_.start([this, source = draft_->text(), path = path_, language = language_.toStdString(),
                      rig = place_.rig](const std::stop_token& stop) -> std::function<void()> {
    QVariantMap profiles;
    try {
      view::Preview preview(protocol::parse(source, path), rig_without_messages(rig));
      std::vector<std::string> assumed;
      const auto factors = view::factors_for(preview.protocol(), {}, assumed);
      for (const auto& scene : preview.scenes()) {
        if (stop.stop_requested()) return {};
        const auto look = preview.look(scene, factors);
        if (look.problem.empty())
          profiles[QString::fromStdString(scene)] =
              to_variant(view::drawing_of(view::profile_figure({look}, language)));
      }
    } catch (const std::exception&) {
      // A scene that cannot be planned has no profile. The check reports what is wrong.
    }
    return [this, profiles] {
      profiles_ = profiles;
      Q_EMIT profilesChanged();
    };
  });
}

void DesignController::take(const rehearsal::Check& check) {
  checking_ = false;
  words_ = view::words_of(check);
  remarks_.clear();
  for (const auto& problem : check.problems) remarks_.push_back({Kind::problem, problem});
  for (const auto& problem : check.warnings) remarks_.push_back({Kind::warning, problem});
  for (const auto& problem : check.notes) remarks_.push_back({Kind::note, problem});
  make_form();
  Q_EMIT changed();
}

const view::Group* DesignController::group(int index) const {
  if (!draft_ || draft_->document() == nullptr || section_ >= static_cast<int>(form_.size())) return nullptr;
  const auto& groups = form_[static_cast<std::size_t>(section_)].groups;
  return index >= 0 && index < static_cast<int>(groups.size()) ? &groups[static_cast<std::size_t>(index)]
                                                               : nullptr;
}

const view::Field* DesignController::field(int index, int of) const {
  const auto* in = group(index);
  const bool has = in != nullptr && of >= 0 && of < static_cast<int>(in->fields.size());
  return has ? &in->fields[static_cast<std::size_t>(of)] : nullptr;
}

void DesignController::touch(bool touched) {
  touched_ = touched;
  check_job_.hold(touched);
  profile_job_.hold(touched);
  Q_EMIT touchedChanged();
}

void DesignController::show(int section) {
  if (section < 0 || section >= static_cast<int>(form_.size()) || section == section_) return;
  section_ = section;
  Q_EMIT changed();
}

bool DesignController::goTo(int remark) {
  const auto has = [remark](const std::vector<std::size_t>& remarks) {
    return std::find(remarks.begin(), remarks.end(), static_cast<std::size_t>(remark)) != remarks.end();
  };
  for (int s = 0; s < static_cast<int>(form_.size()); ++s) {
    const auto& groups = form_[static_cast<std::size_t>(s)].groups;
    for (int g = 0; g < static_cast<int>(groups.size()); ++g) {
      const auto& group = groups[static_cast<std::size_t>(g)];
      const auto field = std::find_if(group.fields.begin(), group.fields.end(),
                                      [&](const view::Field& f) { return has(f.remarks); });
      if (field == group.fields.end() && !has(group.remarks)) continue;
      show(s);
      Q_EMIT reached(g, field == group.fields.end() ? -1 : static_cast<int>(field - group.fields.begin()));
      return true;
    }
  }
  return false;
}

bool DesignController::guarded(const std::function<void()>& action) try {
  action();
  return true;
} catch (const core::BadInput& bad) {
  return refuse(reason(bad));
} catch (const std::exception& error) {
  return refuse(core::phrase_of(error));
}

bool DesignController::edit(const std::function<std::string()>& make) {
  return draft_ && guarded([&] { take_change(make()); });
}

bool DesignController::change(int index, int of, const QString& typed) {
  const auto* changed = field(index, of);
  if (changed == nullptr) return false;
  if (changed->input == view::Field::Input::name && !is_name(typed)) return refuse(core::plain("name"));
  return edit([&] { return view::changed(*draft_->document(), *changed, typed.toStdString()); });
}

bool DesignController::copy(int index, const QString& name) {
  const auto* from = group(index);
  if (from == nullptr) return false;
  if (!is_name(name)) return refuse(core::plain("name"));
  return edit([&] { return draft_->document()->with_copy(from->path, name.toStdString()); });
}

void DesignController::remove(int index) {
  if (const auto* gone = group(index); gone != nullptr)
    edit([&] { return draft_->document()->without(gone->path); });
}

void DesignController::add(const QString& kind) {
  if (!draft_ || draft_->document() == nullptr) return;
  edit([&] {
    return draft_->document()->with_tables(view::new_table(*draft_->document(), kind.toStdString()));
  });
}

void DesignController::move(int index, bool earlier) {
  const auto* moved = group(index);
  if (moved == nullptr) return;
  const auto& other = earlier ? moved->earlier : moved->later;
  if (!other.empty()) edit([&] { return draft_->document()->exchanged(moved->path, other); });
}

void DesignController::place(int index, int to) {
  if (group(index) == nullptr || group(to) == nullptr || index == to) return;
  edit([&] {
    return view::with_part_at(*draft_->document(), static_cast<std::size_t>(index),
                              static_cast<std::size_t>(to));
  });
}

void DesignController::extend(int index, int of) {
  if (const auto* longer = field(index, of))
    edit([&] { return view::extended(*draft_->document(), *longer); });
}

void DesignController::reduce(int index, int of) {
  if (const auto* gone = field(index, of)) edit([&] { return view::reduced(*draft_->document(), *gone); });
}

void DesignController::moveUp(int index, int of) {
  if (const auto* moved = field(index, of)) edit([&] { return view::moved_up(*draft_->document(), *moved); });
}

void DesignController::undo() {
  if (!can_undo()) return;
  guarded([this] {
    draft_->undo();
    read_again();
  });
}

void DesignController::redo() {
  if (!can_redo()) return;
  guarded([this] {
    draft_->redo();
    read_again();
  });
}

void DesignController::setText(const QString& text) {
  edit([&] { return text.toStdString(); });
}

}  // namespace turnpoint::ui

#include "moc_design_controller.cpp"
