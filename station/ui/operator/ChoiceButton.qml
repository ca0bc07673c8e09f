import QtQuick
import Turnpoint

// One of several choices. The chosen one has a tick, because colour alone must not tell which one it is. A
// button keeps its width when it is chosen, so that the others do not move under the finger.
ActionButton {
    id: root
    property bool chosen: false
    primary: chosen
    quiet: !chosen
    glyph: chosen ? "tick" : ""
    size: theme.textBody
}
