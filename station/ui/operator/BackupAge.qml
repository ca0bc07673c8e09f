import QtQuick
import Turnpoint

// The age of the last good backup, highlighted if there is none or it is old.
Row {
    id: root
    required property Theme theme
    required property Texts texts
    required property var age
    readonly property bool due: age.state !== "recent"
    spacing: Math.round(0.5 * theme.unit)

    Glyph {
        objectName: "backupDue"
        visible: root.due
        anchors.verticalCenter: parent.verticalCenter
        height: 1.3 * root.theme.textSmall
        name: "alert"
        color: root.theme.wrong
    }
    PlainText {
        objectName: "backup"
        anchors.verticalCenter: parent.verticalCenter
        text: root.texts.lastBackup(root.age)
        color: root.due ? root.theme.wrong : root.theme.quiet
        font { pixelSize: root.theme.textSmall; weight: root.due ? Font.DemiBold : Font.Normal }
    }
}
