import QtQuick
import Turnpoint

// A button for one of several choices. A tick marks the chosen one, because colour alone is not enough. A
// button keeps its width when it is chosen, so that the others do not move under the finger.
ActionButton {
    id: root
    property bool chosen: false
    primary: chosen
    quiet: !chosen
    glyph: chosen ? "tick" : ""
    size: theme.textBody
}
