import QtQuick
import Turnpoint

// Leads back to the previous question. It is at the same place on all pages before the session.
ActionButton {
    id: root
    required property Texts texts
    objectName: "back"
    anchors.left: parent.left
    primary: false
    quiet: true
    size: theme.textSmall
    implicitHeight: Math.ceil(Math.max(9 * theme.pixelsPerMm, 5 * theme.unit))
    text: texts.back
}
