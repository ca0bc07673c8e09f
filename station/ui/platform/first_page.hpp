#pragma once
#include <QQuickWindow>

namespace turnpoint::ui {

/// Logs when the window shows its first frame, and how much processor time the process has used until then,
/// if QT_LOGGING_RULES is `turnpoint.startup=true`. tests/ui/speed reads this line.
void tell_first_page(QQuickWindow& window);

}  // namespace turnpoint::ui
