import QtQuick
import QtTest
import Turnpoint

// Tests the keyboard of the screen: the letters of each language, the pad for numbers, and a line that stays in view while
// it is typed.
Item {
    id: stage
    width: 800
    height: 480

    Theme { id: theme; width: stage.width; height: stage.height; pixelsPerMm: 5.2; dense: true }
    ScreenKeyboard {
        id: keyboard
        width: stage.width - 40
        theme: theme
        onTyped: character => stage.typed += character
    }
    property string typed
    EntryDialog {
        id: dialog
        anchors.fill: parent
        theme: theme
        title: "Question"
        keepText: "Use"
        cancelText: "Cancel"
        suggestions: ["boundary_mm", "mark_mm", "offset_mm"]
    }

    PageTest {
        name: "Keyboard"
        when: windowShown

        /// What a person needs to write a sentence in each language.
        readonly property var alphabets: ({
            en: "abcdefghijklmnopqrstuvwxyz0123456789-._,?!'():/+*=<>%→",
            de: "abcdefghijklmnopqrstuvwxyzäöüß0123456789-._,?!'():/+*=„“<>%→",
            es: "abcdefghijklmnopqrstuvwxyzáéíóúüñ0123456789-._,?!'():/+*=¿¡<>%→",
            ja: "あいうえおかきくけこさしすせそたちつてとなにぬねのはひふへほまみむめもやゆよらりるれろわをんがぎぐげござじずぜぞだぢづでどばびぶべぼぱぴぷぺぽゃゅょっー、。？",
            zh: "abcdefghijklmnopqrstuvwxyz0123456789，。？！：“”",
            ar: "ابتثجحخدذرزسشصضطظعغفقكلمنهويىةءئؤأإآ0123456789؟،"
        })

        function init() {
            stage.typed = ""
            keyboard.full = true
            keyboard.numbers = false
            keyboard.accents = false
            keyboard.capitals = false
            keyboard.layout = "en"
            dialog.visible = false
        }
        /// All keys below an item that are shown.
        function keysOf(item) { return all(item, key => /^letter/.test(key.objectName)) }
        function tap(item, name) {
            const key = find(item, name)
            verify(key, name)
            mouseClick(key)
        }

        function test_each_language_has_its_letters_data() {
            return Object.keys(alphabets).map(code => ({ tag: code }))
        }
        function test_each_language_has_its_letters(row) {
            keyboard.layout = row.tag
            let letters = ""
            for (const accents of [false, true]) {
                keyboard.accents = accents
                wait(0)
                for (const key of keysOf(keyboard)) {
                    letters += key.text
                    verify(key.x + key.parent.x >= 0 && key.mapToItem(keyboard, key.width, 0).x <= keyboard.width, key.text)
                }
            }
            for (const letter of alphabets[row.tag]) verify(letters.includes(letter), letter)
        }
        function test_the_six_languages_of_the_station_have_a_layout() {
            compare(Object.keys(alphabets).filter(code => !keyboard.layouts[code]), [])
            compare(OperatorScreen.languages.map(language => language.code).filter(code => !keyboard.layouts[code]), [])
        }
        function test_a_key_chooses_the_language() {
            const before = OperatorScreen.language
            for (const language of OperatorScreen.languages) tap(keyboard, "layout")
            compare(keyboard.layout, "en")
            tap(keyboard, "layout")
            verify(keyboard.layout !== "en")
            compare(OperatorScreen.language, before)   // the pages keep theirs
        }
        function test_capitals_are_those_of_the_language() {
            keyboard.layout = "de"
            wait(50)                                   // the keys get their places
            tap(keyboard, "capitals")
            tap(keyboard, "letterö")
            tap(keyboard, "letterö")
            compare(stage.typed, "Öö")
            keyboard.layout = "ja"
            wait(50)
            tap(keyboard, "capitals")
            tap(keyboard, "letterか")
            tap(keyboard, "letterな")
            compare(stage.typed, "Ööカナ")
        }
        function test_words_with_accents_are_typed_by_taps_in_each_language_data() {
            return [{ tag: "en", word: "Café naïve" }, { tag: "de", word: "Übergröße à Ça" }, { tag: "es", word: "¿Qué niño, pingüino Ñ?" },
                    { tag: "ja", word: "がっこうで、ぱん" }, { tag: "zh", word: "nǐ，hǎo！" }, { tag: "ar", word: "أسئلة؟" }]
        }
        function test_words_with_accents_are_typed_by_taps_in_each_language(row) {
            const codes = Array.from(OperatorScreen.languages, language => language.code)
            for (let i = 0; i < codes.length && keyboard.layout !== row.tag; ++i) tap(keyboard, "layout")
            compare(keyboard.layout, row.tag)
            let taps = 0
            for (const letter of row.word) {
                const small = letter.toLowerCase()
                if (small !== letter) { tap(keyboard, "capitals"); ++taps }
                if (!find(keyboard, "letter" + small)) { tap(keyboard, "accents"); ++taps }
                wait(0)
                tap(keyboard, "letter" + small)
                ++taps
            }
            compare(stage.typed, row.word)
            verify(taps <= 2.2 * row.word.length, taps)
        }
        function test_numbers_have_a_pad_of_their_own() {
            keyboard.numbers = true
            wait(0)
            const letters = keysOf(keyboard).map(key => key.text).join("")
            for (const character of "0123456789.-,e+") verify(letters.includes(character), character)
            compare(letters.length, 16)
            for (const character of "-1.5e+3 2") tap(keyboard, "letter" + character)
            compare(stage.typed, "-1.5e+3 2")
            for (const name of ["erase", "cursorLeft", "cursorRight"]) verify(find(keyboard, name), name)
        }
        function test_the_line_and_its_buttons_stay_in_view_while_it_is_typed() {
            dialog.open("")
            wait(20)
            for (const name of ["entry", "keepEntry", "cancelEntry", "letterq", "erase"]) {
                const item = find(dialog, name), at = item.mapToItem(dialog, 0, 0)
                verify(at.y >= 0 && at.y + item.height <= dialog.height, name)
            }
            const typed = createTemporaryQmlObject("import QtTest; SignalSpy { signalName: 'typed' }", stage)
            typed.target = dialog
            for (const letter of "at") tap(dialog, "letter" + letter)
            compare(typed.count, 2)
            compare(typed.signalArguments[1][0], "at")
            keyClick(Qt.Key_Escape)
            verify(!dialog.visible)
        }
    }
}
