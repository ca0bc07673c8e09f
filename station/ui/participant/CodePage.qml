import QtQuick
import Turnpoint

// Asks for the participant's code on the station's own keypad. A code that is already in the database must be
// confirmed.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    property bool leftHanded: false
    property bool known: false
    /// True if the participant must confirm a code that is already known. False if an operator types, who has
    /// chosen the known code deliberately.
    property bool confirms: true
    /// True if the participant may choose which hand taps. This changes the layout, but not the scoring.
    property bool asksHand: false
    property bool armed: true
    property string title: texts.codeTitle
    property string help: texts.codeHelp
    signal back()
    signal handChosen(left: bool)
    signal edited(code: string)
    signal accepted(code: string)

    readonly property var rows: ["1234567890", "ABCDEFGHIJ", "KLMNOPQRST", "UVWXYZ-"]
    readonly property real keyGap: Math.max(root.theme.pixelsPerMm, 0.8 * root.theme.unit)
    readonly property real keyWidth: (keys.width - 9 * keyGap) / 10
    readonly property real keyHeight: (keys.height - 3 * keyGap) / 4

    function accept() {
        if (!code.valid) return
        if (root.confirms && root.known && !question.visible) {
            question.visible = true
            asking.restart()
            return
        }
        const typed = code.text
        clear()
        root.accepted(typed)
    }

    ParticipantCode {
        id: code
        onChanged: root.edited(text)
    }

    /// Forgets what was typed, because somebody else may type next.
    function clear() {
        code.clear()
        question.visible = false
    }

    BackButton {
        id: back
        theme: root.theme
        texts: root.texts
        armed: root.armed
        onActivated: {
            root.clear()
            root.back()
        }
    }
    PlainText {
        id: heading
        anchors { left: back.right; leftMargin: root.theme.unit; right: parent.right; rightMargin: back.width + root.theme.unit; top: parent.top }
        text: root.title
        color: root.theme.ink
        font { pixelSize: 0.85 * root.theme.textTitle; weight: Font.Bold }
        fontSizeMode: Text.HorizontalFit
        horizontalAlignment: Text.AlignHCenter
    }
    PlainText {
        id: help
        anchors { left: heading.left; right: heading.right; top: heading.bottom; topMargin: 0.4 * root.theme.unit }
        text: root.help
        color: root.theme.quiet
        font.pixelSize: root.theme.textSmall
        horizontalAlignment: Text.AlignHCenter
        wrapMode: Text.Wrap
    }
    Row {
        id: cells
        LayoutMirroring.enabled: false
        anchors { horizontalCenter: parent.horizontalCenter; top: help.bottom; topMargin: 1.2 * root.theme.unit }
        spacing: 0.6 * root.theme.unit
        Repeater {
            model: code.maximumLength
            Rectangle {
                id: cell
                required property int index
                width: 5 * root.theme.unit
                height: 6.6 * root.theme.unit
                radius: 0.6 * root.theme.unit
                color: root.theme.raised
                border {
                    color: index === code.text.length ? root.theme.action : root.theme.line
                    width: index === code.text.length ? root.theme.stroke : Math.max(1, 0.5 * root.theme.stroke)
                }
                PlainText {
                    anchors.centerIn: parent
                    text: code.text.charAt(cell.index)
                    color: root.theme.ink
                    font { pixelSize: root.theme.textTitle; weight: Font.DemiBold }
                }
            }
        }
    }

    ActionButton {
        objectName: "hand"
        visible: root.asksHand
        anchors { right: parent.right; verticalCenter: cells.verticalCenter }
        implicitHeight: 6.6 * root.theme.unit
        implicitWidth: Math.min(16 * root.theme.unit, (parent.width - cells.width) / 2 - root.theme.unit)
        theme: root.theme
        primary: false
        quiet: true
        size: root.theme.textSmall
        text: root.leftHanded ? root.texts.leftHand : root.texts.rightHand
        onActivated: root.handChosen(!root.leftHanded)
    }

    component Key: Rectangle {
        id: key
        property string label
        property string glyph
        /// What a screen reader says.
        property string spoken: label
        property bool strong: false
        readonly property bool armed: root.armed
        signal tapped()
        readonly property bool filled: strong !== touch.pressed
        width: root.keyWidth
        height: root.keyHeight
        radius: 0.8 * root.theme.unit
        color: filled ? root.theme.action : root.theme.raised
        border { color: strong ? root.theme.action : root.theme.line; width: Math.max(1, 0.5 * root.theme.stroke) }
        Accessible.role: Accessible.Button
        Accessible.name: spoken
        Accessible.onPressAction: if (enabled && armed) tapped()
        opacity: enabled ? 1 : 0.35
        PlainText {
            readAloud: false
            anchors.centerIn: parent
            text: key.label
            color: key.filled ? root.theme.actionText : root.theme.ink
            font { pixelSize: root.theme.textBody; weight: Font.DemiBold }
        }
        Glyph {
            anchors.centerIn: parent
            visible: key.glyph !== ""
            height: 1.2 * root.theme.textBody
            name: key.glyph
            color: key.filled ? root.theme.actionText : root.theme.ink
        }
        MouseArea {
            id: touch
            anchors.fill: parent
            enabled: key.armed
            onClicked: key.tapped()
        }
    }

    Column {
        id: keys
        LayoutMirroring.enabled: false
        LayoutMirroring.childrenInherit: true
        visible: !question.visible
        anchors { left: parent.left; right: parent.right; top: cells.bottom; topMargin: 1.6 * root.theme.unit; bottom: parent.bottom }
        spacing: root.keyGap
        Repeater {
            model: root.rows
            Row {
                id: line
                required property string modelData
                required property int index
                spacing: root.keyGap
                layoutDirection: Qt.LeftToRight
                Repeater {
                    model: line.modelData.split("")
                    Key {
                        required property string modelData
                        objectName: "key" + modelData
                        label: modelData
                        onTapped: code.type(modelData)
                    }
                }
                Key {
                    visible: line.index === root.rows.length - 1
                    objectName: visible ? "backspace" : ""
                    glyph: "backspace"
                    spoken: root.texts.text("erase")
                    enabled: code.valid
                    onTapped: code.erase()
                }
                Key {
                    visible: line.index === root.rows.length - 1
                    objectName: visible ? "accept" : ""
                    width: 2 * root.keyWidth + root.keyGap
                    label: root.texts.proceed
                    strong: true
                    enabled: code.valid
                    onTapped: root.accept()
                }
            }
        }
    }
    Item {
        id: question
        visible: false
        anchors { left: parent.left; right: parent.right; top: cells.bottom; bottom: parent.bottom }
        Timer {
            id: asking
            interval: 350
        }
        PlainText {
            anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter; verticalCenterOffset: -5 * root.theme.unit }
            text: root.texts.codeKnown
            color: root.theme.ink
            font { pixelSize: 1.1 * root.theme.textBody; weight: Font.Medium }
            horizontalAlignment: Text.AlignHCenter
            wrapMode: Text.Wrap
        }
        Row {
            anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
            spacing: root.theme.targetGap
            ActionButton {
                objectName: "notMine"
                theme: root.theme
                armed: !asking.running
                primary: false
                text: root.texts.codeNo
                onActivated: root.clear()
            }
            ActionButton {
                objectName: "mine"
                theme: root.theme
                armed: !asking.running
                text: root.texts.codeYes
                onActivated: root.accept()
            }
        }
    }
}
