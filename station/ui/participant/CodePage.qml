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

    readonly property bool tall: height > width
    readonly property real keyGap: Math.round(Math.max(root.theme.pixelsPerMm, Math.round(0.8 * root.theme.unit)))
    /// How many keys of full size fit beside each other on a tall screen.
    readonly property int fitting: Math.max(3, Math.floor((keys.width + keyGap) / (theme.targetMin + keyGap)))
    /// True if all letters and digits do not fit on a tall screen with keys of full size. It then shows digits, or groups of
    /// letters and the letters of a group, as on a telephone.
    readonly property bool layered: tall && Math.ceil(39 / fitting) * (theme.targetMin + keyGap) - keyGap > keys.height
    /// "digits", "letters" (the groups), or the letters of a group
    property string keyLayer: "digits"
    readonly property int columns: !tall ? 10 : layered ? 3 : fitting
    readonly property int lines: !tall || layered ? 4 : Math.ceil(39 / fitting)
    readonly property real keyWidth: Math.floor((keys.width - (columns - 1) * keyGap) / columns)
    readonly property real keyHeight: Math.floor((keys.height - (lines - 1) * keyGap) / lines)
    readonly property var letters: ["ABC", "DEF", "GHI", "JKL", "MNO", "PQR", "STU", "VWX", "YZ-"]
    /// The keys from left to right, line by line, as {key, wide}. Besides the characters of a code there are "erase", "accept",
    /// "digits", "letters", "" (no key) and groups of letters.
    readonly property var pad: {
        const each = keys => keys.map(key => ({ key: key, wide: key === "accept" && !layered && !tall ? 2 : 1 }))
        if (!layered) return each([..."1234567890ABCDEFGHIJKLMNOPQRSTUVWXYZ-", "erase", "accept"])
        if (keyLayer === "digits") return each([..."123456789", "letters", "0", "accept"])
        if (keyLayer === "letters") return each([...letters, "digits", "", "accept"])
        return each([...keyLayer, "", "", "", "", "", "", "letters", "", "accept"])
    }
    function press(key: string) {
        if (key === "erase") code.erase()
        else if (key === "accept") accept()
        else if (key === "digits" || key === "letters" || letters.includes(key)) keyLayer = key
        else {
            code.type(key)
            if (layered && keyLayer !== "digits") keyLayer = "letters"
        }
    }
    // A keyboard types here as well.
    focus: visible
    onVisibleChanged: if (visible) forceActiveFocus()
    Keys.onPressed: event => {
        if (!armed || question.visible) return
        event.accepted = true
        if (event.key === Qt.Key_Return || event.key === Qt.Key_Enter) accept()
        else if (event.key === Qt.Key_Backspace) code.erase()
        else if (event.key === Qt.Key_Escape) back.activated()
        else if (/^[0-9A-Za-z-]$/.test(event.text)) code.type(event.text.toUpperCase())
        else event.accepted = false
    }

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
        keyLayer = "digits"
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
        anchors { left: root.tall ? parent.left : back.right; right: parent.right; margins: root.tall ? 0 : root.theme.unit; rightMargin: root.tall ? 0 : back.width + root.theme.unit; top: parent.top; topMargin: !root.tall ? 0 : root.asksHand ? hand.height : back.height }
        text: root.title
        color: root.theme.ink
        height: root.tall ? contentHeight : Math.max(back.height, contentHeight)
        font { pixelSize: Math.max(0.85 * root.theme.textTitle, root.theme.textLeast); weight: Font.Bold }
        fontSizeMode: Text.HorizontalFit
        minimumPixelSize: root.theme.textLeast
        wrapMode: Text.Wrap
        horizontalAlignment: Text.AlignHCenter
        verticalAlignment: Text.AlignVCenter
    }
    PlainText {
        id: help
        anchors { left: root.tall ? parent.left : heading.left; right: root.tall ? parent.right : heading.right; top: heading.bottom; topMargin: Math.round(0.4 * root.theme.unit) }
        text: root.help
        color: root.theme.quiet
        font.pixelSize: root.theme.textSmall
        horizontalAlignment: Text.AlignHCenter
        wrapMode: Text.Wrap
    }
    Row {
        id: cells
        LayoutMirroring.enabled: false
        // the key that erases stands beside the characters if the keys have no room for it
        x: Math.round((parent.width - width - (erase.visible ? erase.width + spacing : 0)) / 2)
        anchors { top: help.bottom; topMargin: root.theme.unit }
        readonly property real cell: Math.min(5 * root.theme.unit, Math.floor((parent.width - (root.layered ? root.theme.targetMin : 0)) / 8 - spacing))
        spacing: Math.round(0.6 * root.theme.unit)
        Repeater {
            model: code.maximumLength
            Rectangle {
                id: cell
                required property int index
                width: cells.cell
                height: Math.round(Math.max(Math.round(6.6 * root.theme.unit), 1.5 * root.theme.textLeast))
                radius: Math.round(0.6 * root.theme.unit)
                color: root.theme.raised
                border {
                    color: index === code.text.length ? root.theme.action : root.theme.line
                    width: index === code.text.length ? root.theme.stroke : Math.max(1, 0.5 * root.theme.stroke)
                }
                PlainText {
                    anchors.centerIn: parent
                    text: code.text.charAt(cell.index)
                    color: root.theme.ink
                    font { pixelSize: Math.min(root.theme.textTitle, 1.3 * cell.width); weight: Font.DemiBold }
                }
            }
        }
    }
    Key {
        id: erase
        objectName: visible ? "backspace" : ""
        visible: root.layered && !question.visible
        anchors { left: cells.right; leftMargin: cells.spacing; verticalCenter: cells.verticalCenter }
        width: Math.min(root.theme.targetMin, root.width - cells.width - cells.spacing)
        height: Math.max(cells.height, Math.round(9 * root.theme.pixelsPerMm))
        glyph: "backspace"
        spoken: root.texts.text("erase")
        enabled: code.valid
        onTapped: code.erase()
    }

    ActionButton {
        id: hand
        objectName: "hand"
        visible: root.asksHand
        // beside the characters or, on a tall screen, opposite the Back button
        anchors.right: parent.right
        y: root.tall ? 0 : Math.round(cells.y + (cells.height - height) / 2)
        implicitHeight: root.tall ? Math.round(Math.max(back.height, 3.2 * root.theme.textSmall)) : Math.round(6.6 * root.theme.unit)
        implicitWidth: root.tall ? Math.round(0.34 * root.width) : Math.round(Math.min(16 * root.theme.unit, (parent.width - cells.width) / 2 - root.theme.unit))
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
        radius: Math.round(0.8 * root.theme.unit)
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
            width: parent.width - root.theme.unit
            fontSizeMode: Text.HorizontalFit
            minimumPixelSize: root.theme.textLeast
            horizontalAlignment: Text.AlignHCenter
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

    Item {
        id: keys
        LayoutMirroring.enabled: false
        LayoutMirroring.childrenInherit: true
        visible: !question.visible
        anchors { left: parent.left; right: parent.right; top: cells.bottom; topMargin: Math.round(1.2 * root.theme.unit); bottom: parent.bottom }
        Repeater {
            model: root.pad
            Key {
                required property var modelData
                required property int index
                readonly property string key: modelData.key
                readonly property bool typed: key.length === 1
                objectName: (typed ? "key" : key.length === 3 ? "group" : "") + (key === "erase" ? "backspace" : key)
                visible: key !== ""
                x: index % root.columns * (root.keyWidth + root.keyGap)
                y: Math.floor(index / root.columns) * (height + root.keyGap)
                width: modelData.wide * (root.keyWidth + root.keyGap) - root.keyGap
                label: key === "accept" ? root.texts.proceed : key === "digits" ? "123" : key === "letters" ? "ABC" : key === "erase" ? "" : key
                glyph: key === "erase" ? "backspace" : ""
                spoken: key === "erase" ? root.texts.text("erase") : label
                strong: key === "accept"
                enabled: code.valid || (key !== "accept" && key !== "erase")
                onTapped: root.press(key)
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
        ButtonGroup {
            theme: root.theme
            room: parent.width
            anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
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
