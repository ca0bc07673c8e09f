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
    /// The button that opens this. The one that confirms is never at its place.
    property Item opener: null
    property real raisedBy: 0
    signal confirmed()
    signal kept()

    function open() {
        raisedBy = 0
        visible = true
    }
    function clearOpener() {
        if (!visible || opener === null) return
        const taken = opener.mapToItem(root, 0, 0, opener.width, opener.height)
        const place = confirm.mapToItem(root, 0, 0, confirm.width, confirm.height)
        const apart = place.right <= taken.left || taken.right <= place.left || place.bottom <= taken.top || taken.bottom <= place.top
        if (!apart) raisedBy += Math.round(place.bottom - taken.top + theme.targetGap / 2)
    }
    function keep() {
        visible = false
        kept()
    }

    visible: false
    color: theme.paper
    onVisibleChanged: {
        if (!visible) return
        arming.restart()
        placing.restart()
        if (theme.dense) keepButton.forceActiveFocus()
    }
    Keys.onEscapePressed: keep()

    Timer {
        id: arming
        interval: 350
    }
    Timer {
        id: placing
        interval: 0
        onTriggered: root.clearOpener()
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
    // The buttons are higher than a row of buttons on the page below, so that a second tap there confirms nothing. Where
    // that is not enough, they are raised further.
    ButtonGroup {
        id: buttons
        theme: root.theme
        room: parent.width
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom; bottomMargin: root.theme.controlHeight + root.theme.targetGap / 2 + root.raisedBy }
        onHeightChanged: placing.restart()
        onWidthChanged: placing.restart()
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
