import QtQuick
import Turnpoint

// Asks for confirmation of something that cannot be undone. It covers the page, says what will happen, and
// offers the safe choice first. Its buttons are not at the place of the button that opened it, and they
// ignore taps for a moment.
Rectangle {
    id: root
    required property Theme theme
    required property Texts texts
    property string title
    property string text
    property string keepText
    property string confirmText
    /// If above 0, the button that confirms must be held for this number of milliseconds.
    property int holdMs: 0
    signal confirmed()
    signal kept()

    function open() { visible = true }
    function keep() {
        visible = false
        kept()
    }

    visible: false
    color: theme.paper
    onVisibleChanged: {
        if (!visible) return
        arming.restart()
        if (theme.dense) keepButton.forceActiveFocus()
    }
    Keys.onEscapePressed: keep()

    Timer {
        id: arming
        interval: 350
    }
    Shield {}
    Statement {
        theme: root.theme
        texts: root.texts
        anchors { left: parent.left; right: parent.right; top: parent.top; bottom: buttons.top; bottomMargin: root.theme.unit }
        title: root.title
        text: root.text
        armed: !arming.running
    }
    // The buttons are higher than a row of buttons on the page below, so that a second tap there confirms nothing.
    ButtonGroup {
        id: buttons
        theme: root.theme
        room: parent.width
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom; bottomMargin: root.theme.controlHeight + root.theme.targetGap / 2 }
        ActionButton {
            id: keepButton
            objectName: "keep"
            width: Math.min(root.width, Math.max(implicitWidth, 22 * root.theme.unit))
            theme: root.theme
            armed: !arming.running
            text: root.keepText
            onActivated: root.keep()
        }
        ActionButton {
            id: confirm
            objectName: "confirm"
            width: Math.min(root.width, Math.max(implicitWidth, 22 * root.theme.unit))
            theme: root.theme
            primary: false
            danger: true
            armed: !arming.running
            holdMs: root.holdMs
            text: root.confirmText
            onActivated: {
                root.visible = false
                root.confirmed()
            }
        }
    }
}
