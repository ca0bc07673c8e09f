import QtQuick
import Turnpoint

// One value in the form of a study: its name, its value, and what the check says about it. If the value is one of at
// most four words, each word is a button; any other value is entered in a dialog.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property string label
    required property var field
    readonly property bool words: field.kind === "boolean" || (field.kind === "word" && field.allowed.length <= 4)
    readonly property bool wrong: field.remarks.some(remark => remark.kind === "problem")
    /// True for a moment after the user has tapped a problem, to point out the field that it is about.
    property bool pointedAt: false
    signal editWanted()
    signal picked(word: string)

    height: Math.max(value.visible ? value.height : chips.height, name.implicitHeight) + notes.height + Math.round(0.5 * theme.unit)

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
        width: 0.4 * parent.width - root.theme.unit
        height: root.theme.controlHeight
        text: root.label
        color: root.wrong ? root.theme.wrong : root.field.present ? root.theme.ink : root.theme.quiet
        font { pixelSize: root.theme.textBody; weight: root.field.present ? Font.DemiBold : Font.Normal }
        verticalAlignment: Text.AlignVCenter
        wrapMode: Text.WordWrap
        maximumLineCount: 2
        fontSizeMode: Text.Fit
        minimumPixelSize: 0.75 * root.theme.textSmall
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
                text: modelData === "true" ? root.texts.text("design.yes") : modelData === "false" ? root.texts.text("design.no") : modelData
                onActivated: root.picked(modelData)
            }
        }
    }
    Rectangle {
        id: value
        visible: !root.words
        anchors { right: parent.right; top: parent.top }
        width: 0.6 * parent.width
        height: Math.max(root.theme.controlHeight, shown.implicitHeight + root.theme.unit)
        radius: root.theme.radius
        color: tap.pressed ? root.theme.action : root.theme.paper
        border { color: root.wrong ? root.theme.wrong : activeFocus ? root.theme.ink : root.theme.line; width: root.wrong || activeFocus ? root.theme.stroke : root.theme.stroke / 2 }
        activeFocusOnTab: visible
        Accessible.role: Accessible.Button
        Accessible.name: root.label + ": " + (root.field.present ? root.field.value : root.texts.text("design.not_set"))
        Accessible.onPressAction: root.editWanted()
        Keys.onReturnPressed: root.editWanted()
        Keys.onSpacePressed: root.editWanted()
        PlainText {
            readAloud: false
            id: shown
            anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter; margins: root.theme.unit }
            text: root.field.present ? root.field.value : root.texts.text("design.not_set")
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
