import QtQuick
import Turnpoint

// Asks for confirmation of something that cannot be undone. It covers the page, says what will happen, and
// offers the safe choice first. Its buttons are not at the place of the button that opened it, and they
// ignore taps for a moment.
Rectangle {
    id: root
    required property Theme theme
    property string title
    property string text
    property string keepText
    property string confirmText
    signal confirmed()
    signal kept()

    function open() { visible = true }

    visible: false
    color: theme.paper
    onVisibleChanged: if (visible) arming.restart()

    Timer {
        id: arming
        interval: 350
    }
    Shield {}
    FittedColumn {
        theme: root.theme
        anchors { left: parent.left; right: parent.right; top: parent.top; bottom: buttons.top }
        PlainText {
            width: parent.width
            text: root.title
            color: root.theme.ink
            font { pixelSize: root.theme.textTitle; weight: Font.Bold }
            horizontalAlignment: Text.AlignHCenter
            wrapMode: Text.Wrap
        }
        PlainText {
            width: parent.width
            text: root.text
            color: root.theme.ink
            font.pixelSize: root.theme.textBody
            lineHeight: 1.2
            horizontalAlignment: Text.AlignHCenter
            wrapMode: Text.Wrap
        }
    }
    // The buttons are stacked, so that they are not at the places of a row of buttons on the page below.
    Column {
        id: buttons
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom; bottomMargin: root.theme.controlHeight + 2 * root.theme.targetGap }
        width: Math.min(parent.width, Math.max(keep.implicitWidth, confirm.implicitWidth, 26 * root.theme.unit))
        spacing: root.theme.targetGap
        ActionButton {
            id: keep
            objectName: "keep"
            width: parent.width
            theme: root.theme
            armed: !arming.running
            text: root.keepText
            onActivated: {
                root.visible = false
                root.kept()
            }
        }
        ActionButton {
            id: confirm
            objectName: "confirm"
            width: parent.width
            theme: root.theme
            primary: false
            danger: true
            armed: !arming.running
            text: root.confirmText
            onActivated: {
                root.visible = false
                root.confirmed()
            }
        }
    }
}
