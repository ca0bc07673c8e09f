import QtQuick
import Turnpoint

// Asks for the language. Each language is listed under its own name, so nothing else needs reading.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property var names
    property bool armed: true
    signal chosen(index: int)
    signal back()

    readonly property int columns: names.length > 3 ? 2 : 1
    readonly property int rows: Math.ceil(names.length / columns)
    readonly property real gap: Math.round(theme.targetGap * 0.7)
    readonly property real cell: Math.floor(Math.min(Math.max(10 * theme.unit, 12 * theme.pixelsPerMm), (height - sign.height - (rows + 1) * gap) / rows))

    BackButton {
        theme: root.theme
        texts: root.texts
        armed: root.armed
        onActivated: root.back()
    }
    Row {
        id: sign
        anchors { horizontalCenter: parent.horizontalCenter; top: parent.top; topMargin: root.theme.unit }
        spacing: Math.round(1.5 * root.theme.unit)
        Repeater {
            model: ["A", "あ", "Ä"]
            PlainText {
                required property string modelData
                text: modelData
                color: root.theme.quiet
                font { pixelSize: root.theme.textTitle; weight: Font.DemiBold }
            }
        }
    }
    Grid {
        anchors { horizontalCenter: parent.horizontalCenter; verticalCenter: parent.verticalCenter; verticalCenterOffset: sign.height / 2 }
        columns: root.columns
        spacing: root.gap
        Repeater {
            model: root.names
            ActionButton {
                required property int index
                required property string modelData
                objectName: "language" + index
                width: root.columns === 1 ? 44 * root.theme.unit : 35 * root.theme.unit
                height: root.cell
                theme: root.theme
                armed: root.armed
                size: root.theme.textTitle
                text: modelData
                onActivated: root.chosen(index)
            }
        }
    }
}
