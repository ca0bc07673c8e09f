import QtQuick
import Turnpoint

// Tells which page of a PagedText is shown, and turns back. A page puts the button that turns to the next one in the middle.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property var of
    property bool armed: true
    default property alias content: middle.data
    /// The width that something between the two needs.
    property real between: middle.width
    height: Math.round(Math.max(9 * theme.pixelsPerMm, 5 * theme.unit))
    visible: of.parts.length > 1

    ActionButton {
        id: back
        objectName: "textBack"
        x: root.texts.mirrored ? root.width - width - at : at
        readonly property real at: Math.round(Math.max(0, root.width / 2 - root.between / 2 - 2 * root.theme.unit - width))
        height: parent.height
        theme: root.theme
        primary: false
        quiet: true
        enabled: root.of.page > 0
        armed: root.armed
        glyph: "previous"
        rotation: root.texts.mirrored ? 180 : 0
        label: root.texts.back
        onActivated: --root.of.page
    }
    Row {
        id: middle
        anchors.centerIn: parent
        height: parent.height
    }
    PlainText {
        id: count
        x: root.texts.mirrored ? root.width - width - at : at
        readonly property real at: Math.round(Math.min(root.width - width, root.width / 2 + root.between / 2 + 2 * root.theme.unit))
        anchors.verticalCenter: parent.verticalCenter
        text: "\u2066" + (root.of.page + 1) + " / " + root.of.parts.length + "\u2069"
        color: root.theme.quiet
        font.pixelSize: root.theme.textSmall
    }
}
