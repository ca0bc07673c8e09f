#include "station/ui/operator/design_lists.hpp"

#include <QRegularExpression>
#include <cstddef>
#include <string>

#include "station/ui/operator/facts.hpp"

namespace turnpoint::ui {

namespace {

using RuleKind = view::Rule::Kind;

QString kind_name(RuleKind kind) {
  switch (kind) {
    case RuleKind::number:
    case RuleKind::integer:
    case RuleKind::numbers:
      return "number";
    case RuleKind::boolean:
      return "boolean";
    case RuleKind::word:
      return "word";
    case RuleKind::expression:
      return "expression";
    case RuleKind::names:
      return "names";
    default:
      return "text";
  }
}

QVariantList chosen(const std::vector<std::size_t>& indices, const QVariantList& remarks) {
  QVariantList list;
  for (const auto index : indices) list += remarks.value(static_cast<qsizetype>(index));
  return list;
}

/// Returns the help text that the schema has for a field, followed by the field's limits in words.
QString help_of(const view::Field& field) {
  auto help = QString::fromStdString(field.help);
  const auto add = [&help](const QString& more) { help += (help.isEmpty() ? "" : "   ·   ") + more; };
  if (field.low && field.high)
    add(QString("%1 … %2").arg(*field.low).arg(*field.high));
  else if (field.low)
    add(QString("≥ %1").arg(*field.low));
  else if (field.high)
    add(QString("≤ %1").arg(*field.high));
  return help;
}

QVariantMap field_of(const view::Group& group, int index, const QVariantList& remarks) {
  const auto& field = group.fields[static_cast<std::size_t>(index)];
  QStringList path;
  for (auto i = group.path.size(); i < field.path.size(); ++i) path += QString::fromStdString(field.path[i]);
  const bool boolean = field.kind == RuleKind::boolean;
  return {{"index", index},
          {"path", path},
          {"kind", kind_name(field.kind)},
          {"value", QString::fromStdString(field.value)},
          {"allowed", boolean ? QStringList{"true", "false"} : to_list(field.allowed)},
          {"list", field.kind == RuleKind::names},
          {"present", field.present},
          {"required", field.required},
          {"help", help_of(field)},
          {"remarks", chosen(field.remarks, remarks)}};
}

}  // namespace

bool is_name(const QString& name) {
  static const QRegularExpression allowed("^[A-Za-z0-9_-]{1,64}$");
  return allowed.match(name).hasMatch();
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
          {"below", QString::fromStdString(group.below)},
          {"belowCount", static_cast<int>(group.below_count)},
          {"remarks", chosen(group.remarks, remarks)},
          {"fields", fields},
          {"boundary", boundary},
          {"zone", zone}};
}

}  // namespace turnpoint::ui
