import QtQuick
import Turnpoint

// Asks what happened if the database was recorded on another machine: was the board or the disk replaced, or is
// this a copy, which needs a name of its own? Takes no room otherwise.
Rectangle {
    id: root
    required property Theme theme
    required property Texts texts
    required property OperatorController operating
    signal replaced(button: Item)
    signal copied()
    visible: operating.otherMachine
    height: visible ? question.height + Math.round(1.6 * root.theme.unit) : 0
    radius: root.theme.radius
    color: root.theme.raised
    border { color: root.theme.action; width: root.theme.stroke }
    Column {
        id: question
        anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter; margins: Math.round(1.2 * root.theme.unit) }
        spacing: Math.round(0.8 * root.theme.unit)
        PlainText {
            objectName: "otherMachine"
            width: parent.width
            text: root.texts.fill("operator.other_machine", root.operating.station)
            color: root.theme.ink
            font { pixelSize: root.theme.textBody; weight: Font.DemiBold }
            wrapMode: Text.Wrap
        }
        Flow {
            width: parent.width
            spacing: root.theme.unit
            ActionButton {
                id: replacing
                objectName: "machineReplaced"
                theme: root.theme
                primary: false
                text: root.texts.text("operator.machine_replaced")
                onActivated: root.replaced(replacing)
            }
            ActionButton {
                objectName: "machineCopied"
                theme: root.theme
                primary: false
                text: root.texts.text("operator.machine_copied")
                onActivated: root.copied()
            }
        }
    }
}
