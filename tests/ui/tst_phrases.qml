import QtQuick
import QtTest
import Turnpoint

// Tests where a text may break into lines.
Item {
    id: stage
    width: 800
    height: 200

    Texts { id: japanese; language: "ja" }
    Texts { id: german; language: "de" }
    TextMetrics { id: metrics; font: shown.font }
    Text {
        id: shown
        property var lines: []
        font.pixelSize: 24
        wrapMode: Text.Wrap
        onLineLaidOut: line => { lines[line.number] = line.implicitWidth }
    }

    TestCase {
        name: "Phrases"
        when: windowShown

        /// Returns the pieces of a text between possible line breaks.
        function pieces(text) {
            const joined = japanese.phrased(text), found = [""]
            for (let i = 0; i < joined.length; ++i) {
                if (joined[i] === "\u2060") continue
                if (i > 0 && joined[i - 1] !== "\u2060") found.push("")
                found[found.length - 1] += joined[i]
            }
            return found
        }
        function widthOf(text) {
            metrics.text = text
            return metrics.advanceWidth
        }

        function test_a_japanese_text_breaks_where_a_phrase_ends_data() {
            return [{ tag: "なめらかな|部分が|印で|終わるように、|つまみを|動かしてください。" },
                    { tag: "実験者を|お待ちください" },
                    { tag: "指定と|異なる|刺激になります。|別の|端子か|機器を|使ってください。" },
                    { tag: "アンプを|有効にしてから|「次へ」を|押します。" },
                    { tag: "回答は|すべて|保存されました。" }]
        }
        function test_a_japanese_text_breaks_where_a_phrase_ends(row) {
            const wanted = row.tag.split("|"), text = wanted.join("")
            // No line break is allowed between two hiragana. A piece may therefore contain two phrases, but
            // never half a phrase.
            let begun = 0
            const starts = wanted.map(piece => (begun += piece.length) - piece.length)
            begun = 0
            for (const piece of pieces(text)) {
                verify(starts.includes(begun), piece)
                begun += piece.length
            }
            compare(begun, text.length)
            verify(pieces(text).length > 1)
        }

        function test_a_shown_line_ends_where_a_phrase_ends() {
            const text = "なめらかな部分が印で終わるように、つまみを動かしてください。"
            shown.width = widthOf("なめらかな部分が印で終わるように、つまみを動かしてく") + 2
            shown.text = text
            compare(shown.lineCount, 2)
            // text that was not divided into phrases breaks inside a phrase
            verify(shown.lines[0] > widthOf("なめらかな部分が印で終わるように、つまみを動か"))
            shown.text = japanese.phrased(text)
            compare(shown.lineCount, 2)
            fuzzyCompare(shown.lines[0], widthOf("なめらかな部分が印で終わるように、つまみを"), 2)
            shown.width = widthOf("なめらか")
            verify(shown.contentWidth <= shown.width + 1)  // a phrase longer than a line is broken
        }

        function test_words_in_other_languages_and_scripts_are_not_changed() {
            compare(german.phrased("Bitte auf Fertig tippen."), "Bitte auf Fertig tippen.")
            compare(japanese.phrased("turnpoint doctor 44.1 kHz"), "turnpoint doctor 44.1 kHz")
        }
    }
}
