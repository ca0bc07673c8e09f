import QtQuick
import Turnpoint

// The line on every operator's page: the station's name, and whether database, disk, clock, backup and amplifier are fit for a
// session. What is not has a sign.
Rectangle {
    id: root
    required property Theme theme
    required property Texts texts
    required property OperatorController operating
    readonly property bool armed: operating.armed
    implicitHeight: signs.implicitHeight + Math.round(0.8 * theme.unit)
    color: theme.raised

    component Sign: Row {
        id: sign
        property bool good: true
        property string says
        spacing: Math.round(0.4 * root.theme.unit)
        Glyph {
            visible: !sign.good
            anchors.verticalCenter: parent.verticalCenter
            height: Math.round(1.2 * root.theme.textSmall)
            name: "alert"
            color: root.theme.wrong
        }
        PlainText {
            text: sign.says
            color: sign.good ? root.theme.quiet : root.theme.wrong
            font { pixelSize: root.theme.textSmall; weight: sign.good ? Font.Normal : Font.DemiBold }
        }
    }
    Rectangle {
        anchors { left: parent.left; right: parent.right; top: parent.top }
        height: 1
        color: root.theme.line
    }
    Flow {
        id: signs
        objectName: "stationSigns"
        anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter; leftMargin: root.theme.margin; rightMargin: root.theme.margin }
        spacing: Math.round(1.6 * root.theme.unit)
        Sign { says: root.operating.station }
        Repeater {
            model: root.operating.signs
            Sign {
                required property var modelData
                objectName: "sign-" + modelData.name
                good: modelData.good
                says: root.texts.say(modelData.says)
            }
        }
        BackupAge {
            theme: root.theme
            texts: root.texts
            age: root.operating.backup
        }
        Sign {
            objectName: "sign-amplifier"
            says: root.texts.text(root.armed ? "state.amplifier_armed" : "state.amplifier_off")
        }
    }
}
