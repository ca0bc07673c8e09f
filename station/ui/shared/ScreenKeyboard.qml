import QtQuick
import Turnpoint

// A keyboard on the screen, for a station without one. It has the letters of the operator's language, or of another one
// that the key with a language's code chooses, with capitals (katakana in Japanese), letters with accents or other marks,
// and keys that move the cursor. Kanji and Chinese characters need a real keyboard with an input method. The keys have the
// same order in languages that are read from right to left, like those of a keyboard.
Column {
    id: root
    required property Theme theme
    signal typed(character: string)
    signal erased()
    /// The cursor is to move by so many characters.
    signal moved(by: int)
    /// More signs, for sentences and expressions. Japanese letters take their place; other layouts have them.
    property bool full: false
    /// Only what a number consists of, or several numbers.
    property bool numbers: false
    /// A key that begins a new line.
    property bool lines: false
    property bool capitals: false
    property bool accents: false
    property string layout: OperatorScreen.language
    readonly property var layouts: ({
        en: { letters: ["qwertyuiop", "asdfghjkl-", "zxcvbnm,._"], marks: ["äöüßåæøœçñ", "áéíóúàèìòù", "âêîôûëïãõý", "„“”«»‘’¿¡°"] },
        de: { letters: ["qwertzuiopü", "asdfghjklöä", "yxcvbnmß,.-"], marks: ["áéíóúàèìòù_", "âêîôûëïçñå", "„“”«»‘’–…°"] },
        es: { letters: ["qwertyuiop-", "asdfghjklñ_", "zxcvbnmç,."], marks: ["áéíóúüàèìò", "âêîôûëïäöß", "¿¡„“”«»‘’°"] },
        ja: { letters: ["あいうえおかきくけこさし", "すせそたちつてとなにぬね", "のはひふへほまみむめもや", "ゆよらりるれろわをんー、"],
              marks: ["がぎぐげござじずぜぞ", "だぢづでどばびぶべぼ", "ぱぴぷぺぽぁぃぅぇぉ", "ゃゅょっ「」？！〜…。・"] },
        zh: { letters: ["qwertyuiop", "asdfghjkl-", "zxcvbnm,._"], marks: ["，。、？！：；…—·", "“”‘’《》（）【】", "āáǎàēéěèīí", "ǐìōóǒòūúǔù"] },
        ar: { letters: ["ضصثقفغعهخحج", "شسيبلاتنمكط", "ئءؤرىةوزظدذ"], marks: ["أإآ؟،؛«»ـ-", "ًٌٍَُِّْ_.", "٠١٢٣٤٥٦٧٨٩"] }
    })
    readonly property var keys: layouts[layout] ?? layouts.en
    readonly property var signs: ["?!'():/+*=", "<>%→\"&;€━[]"]
    readonly property var rows: numbers ? ["789", "456", "123", "0.-", ",e+ "]
        : ["1234567890"].concat(accents ? keys.marks : keys.letters, full && layout !== "ja" ? [signs[accents ? 1 : 0]] : [])
    readonly property real gap: Math.round(0.4 * theme.unit)
    readonly property real keyWidth: numbers ? Math.min(2 * theme.controlHeight, Math.floor((width - 4 * gap) / 4.5)) : Math.floor((width - 12 * gap) / 12)
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
    function large(character: string) : string {
        const code = character.charCodeAt(0)
        return code >= 0x3041 && code <= 0x3096 ? String.fromCharCode(code + 0x60) : character === "ß" ? character : character.toUpperCase()
    }
    function type(character: string) {
        typed(capitals ? large(character) : character)
        if (layout !== "ja") capitals = false
    }
    function nextLayout() {
        const all = Array.from(OperatorScreen.languages, language => language.code)
        layout = all[(all.indexOf(layout) + 1) % all.length]
        capitals = false
        accents = false
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
                    text: modelData === " " ? "␣" : root.capitals ? root.large(modelData) : modelData
                    label: modelData === " " ? texts.text("space") : text
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
            Key {
                visible: root.numbers && line.index === 1
                objectName: visible ? "cursorLeft" : ""
                glyph: "previous"
                label: texts.text("cursor_left")
                onActivated: root.moved(-1)
            }
            Key {
                visible: root.numbers && line.index === 2
                objectName: visible ? "cursorRight" : ""
                glyph: "next"
                label: texts.text("cursor_right")
                onActivated: root.moved(1)
            }
        }
    }
    Row {
        visible: !root.numbers
        spacing: root.gap
        WideKey {
            objectName: "capitals"
            primary: root.capitals
            quiet: !root.capitals
            text: root.layout === "ja" ? "ア" : "Aa"
            label: texts.text("capitals")
            onActivated: root.capitals = !root.capitals
        }
        WideKey {
            objectName: "accents"
            primary: root.accents
            quiet: !root.accents
            text: root.layout === "ja" ? "゛" : root.layout === "zh" ? "，。" : root.layout === "ar" ? "أ؟" : "äé"
            label: texts.text("accents")
            onActivated: root.accents = !root.accents
        }
        Key {
            objectName: "layout"
            visible: OperatorScreen.languages.length > 1
            text: root.layout.toUpperCase()
            label: texts.text("operator.language")
            onActivated: root.nextLayout()
        }
        Key {
            objectName: root.numbers ? "" : "letter "
            width: 4 * root.keyWidth + 3 * root.gap
            text: "␣"
            label: texts.text("space")
            onActivated: root.typed(" ")
        }
        Key {
            objectName: "newLine"
            visible: root.lines
            text: "↵"
            label: texts.text("new_line")
            onActivated: root.typed("\n")
        }
        Key {
            objectName: root.numbers ? "" : "cursorLeft"
            glyph: "previous"
            label: texts.text("cursor_left")
            onActivated: root.moved(-1)
        }
        Key {
            objectName: root.numbers ? "" : "cursorRight"
            glyph: "next"
            label: texts.text("cursor_right")
            onActivated: root.moved(1)
        }
    }
}
