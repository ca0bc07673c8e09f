#pragma once
#include <QVariantMap>

#include "station/session/planned_session.hpp"

namespace turnpoint::ui {

/// Converts it for QML, where Texts.tooEarly() says it: to {participant, session, from (the first allowed
/// day), last (the last session), lastDay, minDays}. Days look like 2026-11-24.
inline QVariantMap to_map(const session::EarlySession& early) {
  return {{"participant", QString::fromStdString(early.participant)}, {"session", early.number},
          {"from", QString::fromStdString(early.allowed_from)},       {"last", early.last_number},
          {"lastDay", QString::fromStdString(early.last_day)},        {"minDays", early.min_days}};
}

}  // namespace turnpoint::ui
