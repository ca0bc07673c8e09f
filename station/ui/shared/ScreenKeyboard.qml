import QtQuick
import Turnpoint

// Letters and digits on the screen, for a station without a keyboard. `full` adds capitals and more signs, for
// sentences. The keys have the same order in languages that are read from right to left, like those of a keyboard.
Column {
    id: root
    required property Theme theme
    signal typed(character: string)
    signal erased()
    property bool full: false
    property bool capitals: false
    readonly property var rows: full ? ["1234567890", "qwertyuiop", "asdfghjkl-", "zxcvbnm,. ", "?!'():/+*=_"]
        : ["1234567890", "qwertyuiop", "asdfghjkl-", "zxcvbnm,. "]
    spacing: 0.4 * theme.unit
    LayoutMirroring.enabled: false
    LayoutMirroring.childrenInherit: true

    Texts { id: texts; language: OperatorScreen.language }

    Repeater {
        model: root.rows
        Row {
            id: line
            required property string modelData
            required property int index
            spacing: 0.4 * root.theme.unit
            Repeater {
                model: line.modelData.split("")
                ActionButton {
                    required property string modelData
                    objectName: "letter" + modelData
                    theme: root.theme
                    primary: false
                    quiet: true
                    width: (root.width - 11 * line.spacing) / 11.5
                    height: Math.min(root.theme.controlHeight, width)
                    label: modelData === " " ? texts.text("space") : text
                    text: modelData === " " ? "␣" : root.capitals ? modelData.toUpperCase() : modelData
                    onActivated: {
                        root.typed(root.capitals ? modelData.toUpperCase() : modelData)
                        root.capitals = false
                    }
                }
            }
            ActionButton {
                visible: line.index === 0
                objectName: visible ? "erase" : ""
                theme: root.theme
                primary: false
                quiet: true
                width: 1.5 * (root.width - 11 * line.spacing) / 11.5
                height: Math.min(root.theme.controlHeight, width)
                glyph: "backspace"
                label: texts.text("erase")
                onActivated: root.erased()
            }
            ActionButton {
                visible: root.full && line.index === 3
                objectName: visible ? "capitals" : ""
                theme: root.theme
                primary: root.capitals
                quiet: !root.capitals
                width: 1.5 * (root.width - 11 * line.spacing) / 11.5
                height: Math.min(root.theme.controlHeight, width)
                text: "Aa"
                label: texts.text("capitals")
                onActivated: root.capitals = !root.capitals
            }
        }
    }
}
