import QtQuick
import Turnpoint

// One of several choices. The chosen one has a tick, so that it is not known by its colour alone. Its width does not
// depend on whether it is chosen, so that the others stay under the finger.
ActionButton {
    id: root
    property bool chosen: false
    primary: chosen
    quiet: !chosen
    glyph: chosen ? "tick" : ""
    size: theme.textBody
}
