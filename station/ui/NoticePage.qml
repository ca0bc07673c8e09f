import QtQuick
import Turnpoint

// A fault or a pause: what happened, what is safe, what to do next. Ending asks once more.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property SessionBridge bridge
    property bool armed: true
    property bool asking: false
    readonly property PageModel page: bridge.page
    readonly property bool failed: page.kind === PageModel.Failed
    readonly property bool fault: page.kind === PageModel.Fault || failed
    signal closed()

    onVisibleChanged: asking = false

    Column {
        anchors { left: parent.left; right: parent.right; bottom: buttons.top; bottomMargin: root.theme.unit; top: parent.top }
        spacing: 1.6 * root.theme.unit
        Glyph {
            anchors.horizontalCenter: parent.horizontalCenter
            height: 10 * root.theme.unit
            name: root.fault ? "alert" : "bars"
            color: root.fault ? root.theme.wrong : root.theme.ink
            weight: 0.08
        }
        Text {
            width: parent.width
            text: root.asking ? root.texts.reallyEnd : root.page.title !== "" ? root.page.title
                : root.failed ? root.texts.failedTitle : root.fault ? root.texts.faultTitle : root.texts.paused
            color: root.theme.ink
            font { pixelSize: 0.85 * root.theme.textTitle; weight: Font.Bold }
            horizontalAlignment: Text.AlignHCenter
            wrapMode: Text.Wrap
        }
        Text {
            width: parent.width
            text: root.page.text !== "" ? root.page.text : root.texts.pausedText
            color: root.theme.quiet
            font.pixelSize: root.theme.textBody
            lineHeight: 1.2
            horizontalAlignment: Text.AlignHCenter
            wrapMode: Text.Wrap
        }
        Text {
            width: parent.width
            visible: root.failed
            text: root.texts.failedText
            color: root.theme.ink
            font { pixelSize: root.theme.textBody; weight: Font.DemiBold }
            horizontalAlignment: Text.AlignHCenter
            wrapMode: Text.Wrap
        }
    }
    Row {
        id: buttons
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
        spacing: root.theme.targetGap
        ActionButton {
            objectName: "end"
            visible: !root.failed
            theme: root.theme
            primary: root.asking
            armed: root.armed
            text: root.texts.endSession
            onActivated: {
                if (root.asking) root.bridge.stop()
                root.asking = !root.asking
            }
        }
        ActionButton {
            objectName: "proceed"
            theme: root.theme
            width: Math.max(implicitWidth, 22 * root.theme.unit)
            primary: !root.asking
            armed: root.armed
            text: root.failed ? root.texts.close : root.asking ? root.texts.keepGoing : root.texts.proceed
            onActivated: {
                if (root.failed) return root.closed()
                if (!root.asking) root.bridge.next()
                root.asking = false
            }
        }
    }
}
