import QtQuick
import Turnpoint

// Letters and digits on the screen, for a station without a keyboard: with capitals, letters with accents and keys that move
// the cursor. `full` adds more signs, for sentences. The keys have the same order in languages that are read from right to
// left, like those of a keyboard.
Column {
    id: root
    required property Theme theme
    signal typed(character: string)
    signal erased()
    /// The cursor is to move by so many characters.
    signal moved(by: int)
    property bool full: false
    property bool capitals: false
    property bool accents: false
    readonly property var rows: accents ? ["1234567890", "äöüßåæøœçñ", "áéíóúàèìòù", "âêîôûëïãõý", "„“”«»‘’¿¡°"]
        : full ? ["1234567890", "qwertyuiop", "asdfghjkl-", "zxcvbnm,._", "?!'():/+*="] : ["1234567890", "qwertyuiop", "asdfghjkl-", "zxcvbnm,._"]
    readonly property real gap: Math.round(0.4 * theme.unit)
    readonly property real keyWidth: Math.floor((width - 11 * gap) / 11.5)
    readonly property real keyHeight: Math.min(theme.controlHeight, keyWidth)
    spacing: gap
    LayoutMirroring.enabled: false
    LayoutMirroring.childrenInherit: true

    Texts { id: texts; language: OperatorScreen.language }

    component Key: ActionButton {
        theme: root.theme
        primary: false
        quiet: true
        width: root.keyWidth
        height: root.keyHeight
    }
    component WideKey: Key {
        width: Math.round(1.5 * root.keyWidth)
    }
    function type(character: string) {
        typed(capitals ? character.toUpperCase() : character)
        capitals = false
    }

    Repeater {
        model: root.rows
        Row {
            id: line
            required property string modelData
            required property int index
            spacing: root.gap
            Repeater {
                model: line.modelData.split("")
                Key {
                    required property string modelData
                    objectName: "letter" + modelData
                    text: root.capitals ? modelData.toUpperCase() : modelData
                    onActivated: root.type(modelData)
                }
            }
            WideKey {
                visible: line.index === 0
                objectName: visible ? "erase" : ""
                glyph: "backspace"
                label: texts.text("erase")
                onActivated: root.erased()
            }
        }
    }
    Row {
        spacing: root.gap
        WideKey {
            objectName: "capitals"
            primary: root.capitals
            quiet: !root.capitals
            text: "Aa"
            label: texts.text("capitals")
            onActivated: root.capitals = !root.capitals
        }
        WideKey {
            objectName: "accents"
            primary: root.accents
            quiet: !root.accents
            text: "äé"
            label: texts.text("accents")
            onActivated: root.accents = !root.accents
        }
        Key {
            objectName: "letter "
            width: 4 * root.keyWidth + 3 * root.gap
            text: "␣"
            label: texts.text("space")
            onActivated: root.typed(" ")
        }
        WideKey {
            objectName: "cursorLeft"
            glyph: "previous"
            label: texts.text("cursor_left")
            onActivated: root.moved(-1)
        }
        WideKey {
            objectName: "cursorRight"
            glyph: "next"
            label: texts.text("cursor_right")
            onActivated: root.moved(1)
        }
    }
}
