import QtQuick
import Turnpoint

// A break: shows the remaining time, then a Continue button, which the participant presses when ready.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property SessionBridge bridge
    property bool armed: true
    readonly property PageModel page: bridge.page
    /// Remaining seconds of the break. The session sends the length when the break begins and 0 when it is
    /// over; in between, this page counts down.
    property int secondsLeft: 0

    function read() { secondsLeft = Math.ceil(page.remainingSeconds) }
    Component.onCompleted: read()
    Connections {
        target: root.page
        function onChanged() { root.read() }
    }
    Timer {
        interval: 1000
        repeat: true
        running: root.visible && root.secondsLeft > 1
        onTriggered: --root.secondsLeft
    }

    Statement {
        theme: root.theme
        texts: root.texts
        anchors { left: parent.left; right: parent.right; bottom: go.top; top: parent.top; bottomMargin: root.theme.unit }
        title: root.page.title !== "" ? root.texts.phrased(root.page.title) : root.texts.breakTitle
        text: root.secondsLeft > 0 ? root.texts.breakRunning : root.texts.breakOver
        size: Math.round(1.1 * root.theme.textBody)
        color: root.theme.quiet
        armed: root.armed
        PlainText {
            objectName: "remaining"
            width: parent.width
            visible: root.secondsLeft > 0
            text: root.secondsLeft + " " + root.texts.seconds
            color: root.theme.ink
            font { pixelSize: Math.min(1.6 * root.theme.textHuge, Math.round(0.16 * root.height)); weight: Font.DemiBold }
            horizontalAlignment: Text.AlignHCenter
        }
    }
    ActionButton {
        id: go
        objectName: "proceed"
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
        width: Math.max(implicitWidth, 26 * root.theme.unit)
        theme: root.theme
        enabled: root.secondsLeft <= 0
        armed: root.armed
        text: root.texts.proceed
        onActivated: root.bridge.next()
    }
}
