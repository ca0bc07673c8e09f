import QtQuick
import Turnpoint

// A button of the operator's navigation bar: a symbol above a word.
Rectangle {
    id: root
    required property Theme theme
    property string glyph
    property string text
    property bool chosen: false
    readonly property color foreground: chosen ? theme.actionText : theme.action
    signal activated()

    color: chosen ? theme.action : tap.pressed ? theme.line : theme.raised
    opacity: enabled || chosen ? 1 : 0.35
    activeFocusOnTab: true
    Accessible.role: Accessible.PageTab
    Accessible.name: text
    Accessible.selected: chosen
    Accessible.onPressAction: root.activated()
    Keys.onReturnPressed: activated()
    Keys.onSpacePressed: activated()
    Column {
        anchors.centerIn: parent
        width: parent.width - Math.round(0.6 * root.theme.unit)
        spacing: Math.round(0.4 * root.theme.unit)
        Glyph {
            anchors.horizontalCenter: parent.horizontalCenter
            height: Math.min(Math.round(2.6 * root.theme.unit), 0.4 * root.height)
            name: root.glyph
            color: root.foreground
        }
        PlainText {
            readAloud: false
            width: parent.width
            text: root.text
            color: root.foreground
            font { pixelSize: Math.min(root.theme.textBody, 0.24 * root.height); weight: Font.DemiBold }
            horizontalAlignment: Text.AlignHCenter
            fontSizeMode: Text.HorizontalFit
            minimumPixelSize: 8
        }
    }
    Rectangle {
        visible: root.activeFocus
        anchors { fill: parent; margins: 2 }
        color: "transparent"
        border { color: root.theme.warning; width: root.theme.stroke }
    }
    TapHandler {
        id: tap
        enabled: root.enabled
        gesturePolicy: TapHandler.ReleaseWithinBounds
        onTapped: root.activated()
    }
}
