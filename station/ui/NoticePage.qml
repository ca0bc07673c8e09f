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
    readonly property bool explained: fault && !failed && page.safe !== ""
    signal closed()

    onVisibleChanged: asking = false

    Column {
        id: head
        anchors { left: parent.left; right: parent.right; top: parent.top; topMargin: root.explained ? 0 : root.theme.unit }
        spacing: (root.explained ? 0.6 : 1.6) * root.theme.unit
        Glyph {
            anchors.horizontalCenter: parent.horizontalCenter
            height: (root.explained ? 5.5 : 10) * root.theme.unit
            name: root.fault ? "alert" : "bars"
            color: root.fault ? root.theme.wrong : root.theme.ink
            weight: 0.08
        }
        Text {
            objectName: "headline"
            width: parent.width
            text: root.asking ? root.texts.reallyEnd : root.page.title !== "" ? root.page.title
                : root.failed ? root.texts.failedTitle : root.fault ? root.texts.faultTitle : root.texts.paused
            color: root.theme.ink
            font { pixelSize: 0.85 * root.theme.textTitle; weight: Font.Bold }
            horizontalAlignment: Text.AlignHCenter
            wrapMode: Text.Wrap
        }
        Text {
            visible: !root.explained
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

    component Line: Row {
        id: line
        property string glyph
        property string heading
        property string says
        property color tint: root.theme.ink
        width: parent.width
        spacing: 1.6 * root.theme.unit
        Glyph {
            id: sign
            height: 3.4 * root.theme.unit
            name: line.glyph
            color: line.tint
        }
        Column {
            width: line.width - sign.width - line.spacing
            Text {
                width: parent.width
                text: line.heading
                color: line.tint
                font { pixelSize: root.theme.textSmall; weight: Font.Bold }
            }
            Text {
                width: parent.width
                text: line.says
                color: root.theme.ink
                font { pixelSize: root.theme.textBody; weight: Font.Medium }
                fontSizeMode: Text.HorizontalFit
                wrapMode: Text.Wrap
            }
        }
    }
    Rectangle {
        visible: root.explained
        anchors {
            left: parent.left; right: parent.right; top: head.bottom; topMargin: root.theme.unit
            bottom: buttons.top; bottomMargin: 1.2 * root.theme.unit
        }
        radius: root.theme.radius
        color: root.theme.raised
        border { color: root.theme.line; width: Math.max(1, 0.5 * root.theme.stroke) }
        Column {
            id: lines
            anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter; margins: 2 * root.theme.unit }
            spacing: Math.min(1.6 * root.theme.unit, Math.max(0.2 * root.theme.unit, (parent.height - 22 * root.theme.unit) / 4))
            Line {
                glyph: "alert"
                heading: root.texts.whatHappened
                says: root.page.text
                tint: root.theme.wrong
            }
            Line {
                glyph: "shield"
                heading: root.texts.whatIsSafe
                says: root.page.safe
                tint: root.theme.right
            }
            Line {
                glyph: "tool"
                heading: root.texts.whatToDo
                says: root.page.toDo
                tint: root.theme.action
            }
            Text {
                visible: root.page.detail !== ""
                width: parent.width
                text: root.page.detail
                color: root.theme.quiet
                font.pixelSize: root.theme.textSmall
                elide: Text.ElideRight
            }
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
