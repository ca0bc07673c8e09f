import QtQuick
import Turnpoint

// A card with a heading, whose content scrolls if it does not fit.
Rectangle {
    id: root
    required property Theme theme
    property string heading
    default property alias content: sheet.data
    readonly property real inner: scroll.width

    radius: theme.radius
    color: theme.raised
    border { color: theme.line; width: 1 }

    PlainText {
        id: title
        visible: root.heading !== ""
        anchors { left: parent.left; right: parent.right; top: parent.top; margins: Math.round(1.2 * root.theme.unit); bottomMargin: 0 }
        text: root.heading
        color: root.theme.action
        font { pixelSize: root.theme.textBody; weight: Font.Bold }
        elide: Text.ElideRight
    }
    Flickable {
        id: scroll
        anchors { left: parent.left; right: parent.right; top: title.visible ? title.bottom : parent.top; bottom: parent.bottom; margins: Math.round(1.2 * root.theme.unit); topMargin: title.visible ? Math.round(0.8 * root.theme.unit) : Math.round(1.2 * root.theme.unit) }
        contentHeight: sheet.height
        boundsBehavior: Flickable.StopAtBounds
        clip: true
        Column {
            id: sheet
            width: scroll.width
            spacing: Math.round(0.9 * root.theme.unit)
        }
    }
    ScrollCue { theme: root.theme; place: scroll }
}
