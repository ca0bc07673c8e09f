// The part of DesignController that converts its state for QML.
#include <algorithm>
#include <vector>

#include "station/core/texts.hpp"
#include "station/ui/operator/design_controller.hpp"
#include "station/ui/operator/design_lists.hpp"
#include "station/ui/operator/facts.hpp"
#include "station/ui/shared/operator_screen.hpp"
#include "station/view/goals.hpp"

namespace turnpoint::ui {

QVariantList DesignController::goals(const QString& language) {
  QVariantList list;
  for (const auto& goal : view::goals())
    list += QVariantMap{{"word", goal.word},
                        {"says", QString::fromStdString(view::describe(goal, language.toStdString()))}};
  list += QVariantMap{{"word", "empty"},
                      {"says", QString::fromStdString(core::text("design.empty", language.toStdString()))}};
  return list;
}

QString DesignController::label(const QStringList& path, const QString& language) {
  QString all;
  const auto& known = core::catalogue("en");
  for (const auto& name : path) {
    const auto key = "design.keys." + name.toStdString();
    bool number = false;
    const int index = name.toInt(&number);
    const auto said = known.count(key) > 0 ? QString::fromStdString(core::text(key, language.toStdString()))
                      : number             ? QString::number(index + 1)
                                           : name;
    all += (all.isEmpty() ? "" : number ? " " : " · ") + said;
  }
  return all;
}

QString DesignController::word(const QString& key, const QString& value, const QString& language) {
  if (key == "languages") return own_name(value.toStdString());
  const bool yes = value == "true", no = value == "false";
  const auto text = yes || no ? std::string(yes ? "design.yes" : "design.no") : word_key(key, value);
  return core::catalogue("en").count(text) > 0
             ? QString::fromStdString(core::text(text, language.toStdString()))
             : value;
}

QVariantList DesignController::sections() const {
  QVariantList list;
  for (const auto& section : form_) {
    std::vector<std::size_t> all;
    for (const auto& group : section.groups) {
      all.insert(all.end(), group.remarks.begin(), group.remarks.end());
      for (const auto& field : group.fields)
        all.insert(all.end(), field.remarks.begin(), field.remarks.end());
    }
    const auto problems = std::count_if(all.begin(), all.end(),
                                        [this](std::size_t i) { return remarks_[i].kind == Kind::problem; });
    list += QVariantMap{{"name", QString::fromStdString(section.name)},
                        {"problems", static_cast<int>(problems)},
                        {"added", to_list(section.added)}};
  }
  return list;
}

QVariantList DesignController::groups() const {
  QVariantList list;
  if (section_ >= static_cast<int>(form_.size())) return list;
  const auto all = remarks();
  for (const auto& group : form_[static_cast<std::size_t>(section_)].groups) list += group_of(group, all);
  return list;
}

QVariantList DesignController::remarks() const {
  QVariantList list;
  for (const auto& remark : remarks_) list += to_map(remark.kind, remark.problem);
  return list;
}

void DesignController::set_language(const QString& language) {
  if (language == language_) return;
  language_ = language;
  if (draft_) start_profiles();
  Q_EMIT changed();
}

QVariantList DesignController::facts() const { return to_list(words_.facts); }

QVariantList DesignController::lengths() const {
  QVariantList list;
  if (section_ >= static_cast<int>(form_.size())) return list;
  for (const auto& group : form_[static_cast<std::size_t>(section_)].groups) {
    const auto& kind = group.path.front();
    const auto found = words_.lengths.find({kind == "sequence" ? "block" : kind, group.name});
    list += found == words_.lengths.end() ? QVariant("") : to_variant(found->second);
  }
  return list;
}

QVariantList DesignController::cues() const {
  QVariantList list;
  for (const auto& cue : words_.cues)
    if (cue.leaks)
      list += QVariantMap{
          {"name", to_variant(cue.name)}, {"says", to_variant(cue.says)}, {"advice", to_variant(cue.advice)}};
  return list;
}

QString DesignController::verdict() const {
  if (checking_) return "checking";
  const auto has = [this](Kind kind) {
    return std::any_of(remarks_.begin(), remarks_.end(),
                       [kind](const auto& remark) { return remark.kind == kind; });
  };
  return has(Kind::problem) ? "bad" : has(Kind::warning) ? "warned" : "good";
}

QString DesignController::text() const { return draft_ ? QString::fromStdString(draft_->text()) : QString(); }

}  // namespace turnpoint::ui
