#pragma once
#include <QString>
#include <QVariantList>
#include <QVariantMap>
#include <vector>

#include "station/view/choices.hpp"
#include "station/view/form.hpp"
#include "station/view/trial_timeline.hpp"

namespace turnpoint::ui {

/// True if a study or a table can have this name.
bool is_name(const QString& name);

/// One remark for QML, as {kind: problem | warning | note, line, what, hint}.
QVariantMap to_map(view::CheckWords::Remark::Kind kind, const core::Problem& problem);

/// Converts the parts of a trial for QML, to a list of {kind, from, to}.
QVariantList to_list(const std::vector<view::TrialPart>& parts);

/// The key of the text that says a value of a key.
std::string word_key(const QString& key, const QString& value);

/// Converts one table of a form for QML, to {kind, name, present, copied, removable, earlier, later (whether
/// it can move there), remarks, fields, boundary, zone}. A field is {index, path (within its table), label
/// (what of this stands at the field; the rest is said by the table above it), title (all of it), indent,
/// kind (number, boolean, word, expression, names, text, table, list or entry), key, value, allowed, list,
/// closed, present, required, removable, movable, help, remarks}. `boundary` and `zone` are the indices of
/// the fields that a mark on the drawn surface can set; -1 if there is none. The argument `remarks` holds the
/// remarks on the whole form.
QVariantMap group_of(const view::Group& group, const QVariantList& remarks);

}  // namespace turnpoint::ui
