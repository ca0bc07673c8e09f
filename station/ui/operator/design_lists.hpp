#pragma once
#include <QString>
#include <QVariantList>
#include <QVariantMap>
#include <vector>

#include "station/design/form.hpp"
#include "station/desk/choices.hpp"
#include "station/desk/trial_timeline.hpp"

namespace turnpoint::ui {

/// True if a study or a table can have this name.
bool is_name(const QString& name);

/// One remark for QML, as {kind: problem | warning | note, line, what, hint}.
QVariantMap to_map(desk::CheckWords::Remark::Kind kind, const text::Problem& problem);

/// Parts of a trial as {kind, from, to}.
QVariantList to_list(const std::vector<desk::TrialPart>& parts);

/// One table of a form for QML, as {kind, name, present, copied, removable, remarks, fields, boundary, zone}.
/// A field is {index, path (within its table), kind, value, allowed, list, present, required, help, remarks}.
/// `boundary` and `zone` are the indices of fields that a mark on a strip can set; -1 if there is none.
/// `remarks` are those of the whole form.
QVariantMap group_of(const design::Group& group, const QVariantList& remarks);

}  // namespace turnpoint::ui
