import QtQuick
import Turnpoint

// Page for a fault or a pause: what happened, what is safe, what to do next. If the amplifier has to be armed
// first, only an operator can continue. Ending the session opens a dialog.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property SessionBridge bridge
    property bool armed: true
    property bool armable: false
    readonly property PageModel page: bridge.page
    readonly property bool failed: page.kind === PageModel.Failed
    /// Why the session did not begin because it would be too early; "" if that is not the reason.
    readonly property string tooEarly: texts.tooEarly(page.early)
    readonly property bool fault: page.kind === PageModel.Fault || failed
    readonly property bool explained: fault && !failed && page.safe !== ""
    /// On a tall screen, each text has a line of its own below its heading, and is larger.
    readonly property bool tall: theme.height > theme.width
    signal closed()
    signal armingWanted()

    onVisibleChanged: ending.visible = false
    Connections {
        target: root.page
        function onChanged() { ending.visible = false }
    }

    Row {
        id: banner
        visible: root.explained
        anchors { horizontalCenter: parent.horizontalCenter; top: parent.top }
        height: visible ? implicitHeight : 0
        spacing: Math.round(1.4 * root.theme.unit)
        Glyph {
            height: Math.round(4.6 * root.theme.unit)
            anchors.verticalCenter: parent.verticalCenter
            name: "alert"
            color: root.theme.wrong
        }
        PlainText {
            objectName: "headline"
            anchors.verticalCenter: parent.verticalCenter
            width: Math.min(implicitWidth, root.width - Math.round(6.6 * root.theme.unit))
            wrapMode: Text.Wrap
            text: root.page.title !== "" ? root.texts.phrased(root.page.title) : root.texts.faultTitle
            color: root.theme.ink
            font { pixelSize: Math.max(0.8 * root.theme.textTitle, root.theme.textLeast); weight: Font.Bold }
        }
    }
    Statement {
        theme: root.theme
        texts: root.texts
        visible: !root.explained
        anchors { left: parent.left; right: parent.right; top: parent.top; bottom: buttons.top; bottomMargin: root.theme.unit }
        glyph: root.fault ? "alert" : "bars"
        tint: root.fault ? root.theme.wrong : root.theme.ink
        title: root.page.title !== "" ? root.texts.phrased(root.page.title) : root.tooEarly !== "" ? root.texts.declinedTitle
            : root.failed ? root.texts.failedTitle : root.fault ? root.texts.faultTitle : root.texts.paused
        titleSize: Math.round(Math.max(0.85 * root.theme.textTitle, root.theme.textLeast))
        textName: "notice"
        text: root.tooEarly !== "" ? root.tooEarly : root.failed ? root.texts.failedText
            : root.page.text !== "" ? root.texts.phrased(root.page.text) : root.texts.pausedText
        color: root.theme.quiet
        armed: root.armed
    }

    // Symbol, heading and text side by side, so that each can be found at a glance. On a tall screen the text is
    // below the heading. A heading is never broken into two lines.
    component Line: Item {
        id: line
        property string glyph
        property string heading
        property string says
        property color tint: root.theme.ink
        readonly property real needed: label.implicitWidth
        readonly property real textSize: lines.textSize
        readonly property real gap: Math.round(1.2 * root.theme.unit)
        width: parent.width
        implicitHeight: Math.max(sign.height, told.y + told.height)
        Glyph {
            id: sign
            anchors { left: parent.left; top: parent.top }
            height: 1.3 * line.textSize
            name: line.glyph
            // the symbol "tool" is an arrow; turn it round for languages that are read from right to left
            rotation: root.texts.mirrored && line.glyph === "tool" ? 180 : 0
            color: line.tint
        }
        PlainText {
            id: label
            objectName: "heading"
            visible: !lines.signsOnly
            anchors { left: sign.right; leftMargin: line.gap; top: parent.top }
            width: root.tall ? implicitWidth : lines.headingWidth
            text: line.heading
            color: line.tint
            font { pixelSize: Math.max(root.theme.textLeast, 0.9 * line.textSize); weight: Font.Bold }
        }
        PlainText {
            id: told
            objectName: "told"
            anchors {
                left: root.tall ? label.left : label.right; leftMargin: root.tall ? 0 : line.gap; right: parent.right
                top: root.tall ? label.bottom : parent.top; topMargin: root.tall ? Math.round(0.4 * root.theme.unit) : 0
            }
            text: line.says
            color: root.theme.ink
            font { pixelSize: line.textSize; weight: Font.Medium }
            wrapMode: Text.Wrap
        }
    }
    Rectangle {
        visible: root.explained
        anchors {
            left: parent.left; right: parent.right; top: banner.bottom; topMargin: root.theme.unit
            bottom: buttons.top; bottomMargin: Math.round(1.2 * root.theme.unit)
        }
        radius: root.theme.radius
        color: root.theme.raised
        border { color: root.theme.line; width: Math.max(1, 0.5 * root.theme.stroke) }
        Column {
            id: lines
            objectName: "explanation"
            anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter; margins: Math.round(1.8 * root.theme.unit) }
            spacing: Math.round((signsOnly ? 0.2 : root.tall && !small ? 2.4 : 0.8) * root.theme.unit)
            /// The size of the texts: as large as the place allows.
            readonly property real textSize: small ? root.theme.textLeast : Math.round(root.tall ? 1.2 * root.theme.textBody : Math.max(root.theme.textSmall, 0.84 * root.theme.textBody))
            property bool small: false
            /// True if there is only room for the symbols before the texts.
            property bool signsOnly: false
            function settle() {
                small = false
                signsOnly = false
                small = wanted() > parent.height - root.theme.unit
                signsOnly = small && wanted() > parent.height - root.theme.unit
            }
            // The column's own height is known only in the next frame.
            function wanted() : real {
                return happened.implicitHeight + safe.implicitHeight + toDo.implicitHeight + 2 * spacing + (detail.visible ? detail.height + spacing : 0)
            }
            readonly property string told: `${root.armable} ${root.page.text} ${root.page.safe} ${root.page.toDo} ${root.texts.language} ${root.width} ${parent.height}`
            onToldChanged: settle()
            Component.onCompleted: settle()
            readonly property real headingWidth: signsOnly ? 0 : Math.max(happened.needed, safe.needed, toDo.needed) + Math.round(0.8 * root.theme.unit)
            Line {
                id: happened
                glyph: "alert"
                heading: root.texts.whatHappened
                says: root.texts.phrased(root.page.text)
                tint: root.theme.wrong
            }
            Line {
                id: safe
                glyph: "shield"
                heading: root.texts.whatIsSafe
                says: root.texts.phrased(root.page.safe)
                tint: root.theme.right
            }
            Line {
                id: toDo
                glyph: "tool"
                heading: root.texts.whatToDo
                says: root.texts.phrased(root.page.toDo)
                tint: root.theme.action
            }
            // What a device or the system reports is for the operator, who has typed the code (or reads it in the live view).
            PlainText {
                id: detail
                objectName: "detail"
                visible: root.armable && root.page.detail !== ""
                width: parent.width
                text: root.page.detail
                color: root.theme.quiet
                font.pixelSize: root.theme.textLeast
                wrapMode: Text.Wrap
            }
        }
    }
    ButtonGroup {
        id: buttons
        theme: root.theme
        room: root.width
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
        ActionButton {
            id: endButton
            objectName: "end"
            visible: !root.failed
            theme: root.theme
            primary: false
            armed: root.armed
            text: root.texts.endSession
            onActivated: ending.open()
        }
        ActionButton {
            objectName: "operatorArms"
            visible: root.page.awaitsArming && !root.armable
            theme: root.theme
            armed: root.armed
            text: root.texts.forOperator
            onActivated: root.armingWanted()
        }
        ActionButton {
            objectName: "holdToArm"
            visible: root.page.awaitsArming && root.armable
            theme: root.theme
            holdMs: 900
            text: root.texts.holdToArm
            onActivated: root.bridge.arm()
        }
        ActionButton {
            objectName: "proceed"
            visible: !root.page.awaitsArming && !root.page.awaitsNote
            theme: root.theme
            width: Math.max(implicitWidth, 22 * root.theme.unit)
            armed: root.armed
            text: root.failed ? root.texts.close : root.texts.proceed
            onActivated: root.failed ? root.closed() : root.bridge.next()
        }
    }
    ConfirmDialog {
        id: ending
        anchors.fill: parent
        opener: endButton
        theme: root.theme
        texts: root.texts
        title: root.texts.reallyEnd
        text: root.page.unsaved ? root.texts.endUnsaved : root.texts.endText
        keepText: root.texts.keepGoing
        confirmText: root.texts.endSession
        onConfirmed: root.bridge.stop()
    }
}
