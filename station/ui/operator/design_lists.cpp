#include "station/ui/operator/design_lists.hpp"

#include <QRegularExpression>
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "station/core/range.hpp"
#include "station/core/texts.hpp"
#include "station/ui/operator/facts.hpp"
#include "station/ui/shared/operator_screen.hpp"

namespace turnpoint::ui {

namespace {

using Input = view::Field::Input;
using core::Key;

QString kind_name(Input input) {
  switch (input) {
    case Input::number:
      return "number";
    case Input::boolean:
      return "boolean";
    case Input::word:
      return "word";
    case Input::expression:
      return "expression";
    case Input::names:
      return "names";
    case Input::table:
      return "table";
    case Input::list:
      return "list";
    case Input::entry:
      return "entry";
    case Input::list_name:
      return "listName";
    default:
      return "text";
  }
}

QVariantList chosen(const std::vector<std::size_t>& indices, const QVariantList& remarks) {
  QVariantList list;
  for (const auto index : indices) list += remarks.value(static_cast<qsizetype>(index));
  return list;
}

/// Keys and values in the line of help of the key `own`, which is also that of the file's reference, as the
/// words of the page for them.
QString without_raw_names(QString help, const std::string& own) {
  static const QRegularExpression names("`([A-Za-z_]+)`|\"([A-Za-z0-9_-]+)\"|\\b([a-z]+(?:_[A-Za-z]+)+)\\b");
  const auto& known = core::catalogue("en");
  for (qsizetype at = 0;;) {
    const auto match = names.match(help, at);
    if (!match.hasMatch()) return help;
    const auto name = match.captured(match.lastCapturedIndex()).toStdString();
    std::string said;
    if (const auto key = known.find("design.keys." + name); key != known.end()) said = key->second;
    if (const auto word = known.find("design.words." + own + "." + name); said.empty() && word != known.end())
      said = word->second;
    if (said.empty())
      for (const auto& [key, text] : known)
        if (key.starts_with("design.words.") && key.ends_with("." + name)) said = text;
    const auto word = said.empty() ? match.captured() : "“" + QString::fromStdString(said) + "”";
    help.replace(match.capturedStart(), match.capturedLength(), word);
    at = match.capturedStart() + word.size();
  }
}

QString capitalised(const std::string& text) {
  const auto all = QString::fromStdString(text);
  return all.left(1).toUpper() + all.mid(1);
}

/// A value as it is written in a file, as the words of the page for it.
core::Phrase said(const std::string& key, QString written) {
  written.remove('[').remove(']').remove('"');
  core::Phrase all;
  for (const auto& one : written.split(", ")) {
    const auto text = word_key(QString::fromStdString(key), one);
    if (!all.values.empty()) all.values.push_back(core::plain(", "));
    all.values.push_back(one == "true"                           ? core::phrase("design.yes")
                         : one == "false"                        ? core::phrase("design.no")
                         : core::catalogue("en").count(text) > 0 ? core::phrase(text)
                                                                 : core::plain(one.toStdString()));
  }
  return all;
}

/// One line of help: what the key means, its limits with their unit, and what holds without it.
core::Phrase help_of(const view::Field& field) {
  core::Phrase help;
  const auto add = [&help](core::Phrase more) {
    if (!help.values.empty()) help.values.push_back(core::plain("   ·   "));
    help.values.push_back(std::move(more));
  };
  if (field.key == nullptr) return help;
  if (!field.key->help.empty())
    add(core::plain(without_raw_names(capitalised(field.key->help), field.key->name).toStdString()));
  const auto limited = std::find_if(field.forms.begin(), field.forms.end(), [](const Key* form) {
    const bool number = form->kind == Key::Kind::number || form->kind == Key::Kind::integer ||
                        form->kind == Key::Kind::numbers || form->kind == Key::Kind::integers ||
                        form->kind == Key::Kind::interval || form->kind == Key::Kind::expression;
    return number && !(form->range.low <= -1e6 && form->range.high >= 1e6);
  });
  if (limited != field.forms.end()) add(core::describe((*limited)->range));
  if (field.inherited) return help;  // absent keys are those of another table
  if (!field.key->fallback.empty())
    add(core::phrase("design.by_default",
                     {said(field.key->name, QString::fromStdString(field.key->fallback))}));
  else if (!field.key->otherwise.empty())
    add(core::phrase(
        "design.without_it",
        {core::plain(without_raw_names(QString::fromStdString(field.key->otherwise), field.key->name)
                         .toStdString())}));
  return help;
}

/// The part of a path from the name at `from` on, as it is said: a language by its own name.
QStringList said_path(const view::Field& field, std::size_t from) {
  QStringList path;
  for (auto i = from; i < field.path.size(); ++i) {
    const bool language = i > from && i + 1 == field.path.size() && field.key != nullptr &&
                          field.key->kind == Key::Kind::localised;
    path += language ? own_name(field.path[i]) : QString::fromStdString(field.path[i]);
  }
  if (field.input == Input::name) path = {"name"};
  return path;
}

QVariantMap field_of(const view::Group& group, int index, const QVariantList& remarks) {
  const auto& field = group.fields[static_cast<std::size_t>(index)];
  QStringList path;
  for (auto i = group.path.size(); i < field.path.size(); ++i) path += QString::fromStdString(field.path[i]);
  if (field.input == Input::name) path = {"name"};
  const auto above = std::max(group.path.size(), field.heading);
  return {{"index", index},
          {"path", path},
          {"label", said_path(field, above)},
          {"title", said_path(field, group.path.size())},
          {"indent", static_cast<int>(above - group.path.size())},
          {"kind", kind_name(field.input)},
          {"key", field.key == nullptr ? QString() : QString::fromStdString(field.key->name)},
          {"value", QString::fromStdString(field.value)},
          {"allowed", to_list(field.allowed)},
          {"list", field.input == Input::names},
          {"closed", field.closed},
          {"present", field.present},
          {"required", field.required},
          {"removable", field.removable},
          {"movable", field.movable},
          {"help", to_variant(help_of(field))},
          {"remarks", chosen(field.remarks, remarks)}};
}

}  // namespace

bool is_name(const QString& name) {
  static const QRegularExpression allowed("^[A-Za-z0-9_-]{1,64}$");
  return allowed.match(name).hasMatch();
}

std::string word_key(const QString& key, const QString& value) {
  return "design.words." + key.toStdString() + "." + value.toStdString();
}

QVariantMap to_map(view::CheckWords::Remark::Kind kind, const core::Problem& problem) {
  using Kind = view::CheckWords::Remark::Kind;
  return {{"kind", kind == Kind::problem   ? "problem"
                   : kind == Kind::warning ? "warning"
                                           : "note"},
          {"line", problem.place.line},
          {"what", to_variant(problem.what)},
          {"hint", to_variant(problem.allowed)}};
}

QVariantList to_list(const std::vector<view::TrialPart>& parts) {
  static constexpr const char* kinds[] = {"pause", "interval", "gap", "answer"};
  QVariantList list;
  for (const auto& part : parts)
    list += QVariantMap{
        {"kind", kinds[static_cast<std::size_t>(part.kind)]}, {"from", part.from_s}, {"to", part.to_s}};
  return list;
}

QVariantMap group_of(const view::Group& group, const QVariantList& remarks) {
  QVariantList fields;
  int boundary = -1, zone = -1;
  for (int i = 0; i < static_cast<int>(group.fields.size()); ++i) {
    const auto& field = group.fields[static_cast<std::size_t>(i)];
    fields += field_of(group, i, remarks);
    bool number = false;
    QString::fromStdString(field.value).toDouble(&number);
    if (group.path.front() != "scene" || !field.present || !number) continue;
    if (field.path.size() == 3 && field.path.back() == "boundary_mm") boundary = i;
    if (field.path.size() == 4 && field.path.back() == "from_mm") zone = i;
  }
  return {{"kind", QString::fromStdString(group.path.front())},
          {"name", QString::fromStdString(group.name)},
          {"present", group.present},
          {"copied", group.copied},
          {"removable", group.removable},
          {"earlier", !group.earlier.empty()},
          {"later", !group.later.empty()},
          {"remarks", chosen(group.remarks, remarks)},
          {"fields", fields},
          {"boundary", boundary},
          {"zone", zone}};
}

}  // namespace turnpoint::ui
