import QtQuick
import Turnpoint

// One value in the form of a study: its name, its value, and what the check says about it. If the value is one of at
// most four words, each word is a button; any other value is entered in a dialog. A table below the form's table, or a
// list of them, is a heading for the fields after it, with buttons that add, move and remove it.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property DesignController design
    required property var field
    readonly property string label: field.kind === "entry" ? texts.text("design.add_entry")
        : field.kind === "listName" ? texts.text("design.add_parts")
        : design.label(field.label, texts.language) + (field.kind === "list" ? ": " + field.value : "")
    readonly property bool heading: field.kind === "table" || field.kind === "list"
    readonly property bool words: field.kind === "boolean" || (field.kind === "word" && field.allowed.length <= 4)
    readonly property bool wrong: field.remarks.some(remark => remark.kind === "problem")
    /// True for a moment after the user has tapped a problem, to point out the field that it is about.
    property bool pointedAt: false
    signal editWanted()
    signal picked(word: string)
    signal extended()
    signal reduced()
    signal movedUp()

    /// How the value is said: a word of the page for a word of the file.
    function said(value: string) : string {
        return value.split(", ").map(one => field.allowed.includes(one) ? design.word(field.key, one, texts.language) : one).join(", ")
    }
    height: Math.max(heading ? head.height : words ? chips.height + (about.visible ? about.implicitHeight + Math.round(0.3 * theme.unit) : 0) : value.height, name.height) + notes.height + Math.round(0.5 * theme.unit)

    Rectangle {
        visible: root.pointedAt
        anchors { fill: parent; margins: -Math.round(0.3 * root.theme.unit) }
        radius: root.theme.radius
        color: "transparent"
        border { color: root.theme.warning; width: root.theme.stroke }
    }
    PlainText {
        id: name
        anchors { left: parent.left; top: parent.top }
        width: root.heading ? parent.width - head.width - root.theme.unit : 0.4 * parent.width - root.theme.unit
        // a label of two parts is a longer one
        height: Math.round((root.field.label.length > 1 ? 1.35 : 1) * root.theme.controlHeight)
        text: root.label
        color: root.wrong ? root.theme.wrong : !root.field.present ? root.theme.quiet : root.heading ? root.theme.action : root.theme.ink
        font { pixelSize: root.theme.textBody; weight: root.field.present ? Font.DemiBold : Font.Normal }
        verticalAlignment: Text.AlignVCenter
        wrapMode: Text.WordWrap
        maximumLineCount: 3
        fontSizeMode: Text.Fit
        minimumPixelSize: 0.75 * root.theme.textSmall
    }
    Row {
        id: head
        anchors { right: parent.right; top: parent.top }
        visible: root.heading
        spacing: Math.round(0.5 * root.theme.unit)
        component Tool: ActionButton {
            theme: root.theme
            primary: false
            quiet: true
        }
        Tool {
            objectName: root.objectName + "-earlier"
            visible: root.field.movable
            text: root.texts.text("design.earlier")
            label: root.texts.fill("design.earlier_named", root.label)
            onActivated: root.movedUp()
        }
        Tool {
            objectName: root.objectName + "-remove"
            visible: root.field.removable
            glyph: "minus"
            text: root.texts.text("design.remove")
            label: root.texts.fill("design.remove_named", root.label)
            onActivated: root.reduced()
        }
        Tool {
            objectName: root.objectName + "-add"
            visible: root.field.kind === "list" || (root.heading && !root.field.present)
            glyph: "plus"
            text: root.texts.text("design.add")
            label: root.texts.fill("design.add_named", root.label)
            onActivated: root.extended()
        }
    }
    Flow {
        id: chips
        visible: root.words
        anchors { right: parent.right }
        width: 0.6 * parent.width
        spacing: Math.round(0.5 * root.theme.unit)
        Repeater {
            model: root.words ? root.field.allowed : []
            ChoiceButton {
                required property string modelData
                objectName: root.objectName + "-" + modelData
                theme: root.theme
                chosen: root.field.value === modelData
                text: root.said(modelData)
                // smaller letters where a long choice has no room
                size: Math.floor(root.theme.textBody * Math.min(1, (chips.width - 4 * root.theme.unit) / (natural.width + 1.1 * root.theme.textBody)))
                TextMetrics {
                    id: natural
                    text: root.said(modelData)
                    font { family: Application.font.family; pixelSize: root.theme.textBody; weight: Font.DemiBold }
                }
                onActivated: if (!chosen) root.picked(modelData)
            }
        }
        // A choice is never taken back by the tap that makes it, which is easily repeated by mistake.
        ActionButton {
            objectName: root.objectName + "-unset"
            visible: root.words && root.field.present && !root.field.required
            theme: root.theme
            primary: false
            quiet: true
            size: root.theme.textBody
            text: root.texts.text("design.not_set")
            onActivated: root.picked("")
        }
    }
    // What is entered in a dialog has its help there.
    PlainText {
        id: about
        anchors { right: parent.right; top: chips.bottom }
        width: 0.6 * parent.width
        visible: root.words && text !== ""
        text: root.texts.say(root.field.help)
        color: root.theme.quiet
        font.pixelSize: root.theme.textSmall
        wrapMode: Text.Wrap
    }
    Rectangle {
        id: value
        visible: !root.words && !root.heading
        anchors { right: parent.right; top: parent.top }
        width: 0.6 * parent.width
        height: Math.max(root.theme.controlHeight, shown.implicitHeight + root.theme.unit)
        radius: root.theme.radius
        color: tap.pressed ? root.theme.action : root.theme.paper
        border { color: root.wrong ? root.theme.wrong : activeFocus ? root.theme.ink : root.theme.line; width: root.wrong || activeFocus ? root.theme.stroke : root.theme.stroke / 2 }
        activeFocusOnTab: visible
        Accessible.role: Accessible.Button
        Accessible.name: root.label + ": " + shown.text
        Accessible.onPressAction: root.editWanted()
        Keys.onReturnPressed: root.editWanted()
        Keys.onSpacePressed: root.editWanted()
        PlainText {
            readAloud: false
            id: shown
            anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter; margins: root.theme.unit }
            text: root.field.present ? root.said(root.field.value) : root.texts.text("design.not_set")
            color: tap.pressed ? root.theme.actionText : root.field.present ? root.theme.ink : root.theme.quiet
            font { pixelSize: root.theme.textBody; italic: !root.field.present }
            wrapMode: Text.Wrap
            maximumLineCount: 3
            elide: Text.ElideRight
        }
        TapHandler {
            id: tap
            gesturePolicy: TapHandler.ReleaseWithinBounds
            onTapped: root.editWanted()
        }
    }
    Column {
        id: notes
        anchors { right: parent.right; bottom: parent.bottom; bottomMargin: Math.round(0.5 * root.theme.unit) }
        width: 0.6 * parent.width
        Repeater {
            model: root.field.remarks
            PlainText {
                required property var modelData
                width: notes.width
                text: (modelData.kind === "problem" ? "✗ " : modelData.kind === "warning" ? "! " : "") + root.texts.say(modelData.what) + (modelData.hint === "" ? "" : " " + root.texts.arrow + root.texts.say(modelData.hint))
                color: modelData.kind === "problem" ? root.theme.wrong : root.theme.quiet
                font.pixelSize: root.theme.textSmall
                wrapMode: Text.Wrap
            }
        }
    }
}
