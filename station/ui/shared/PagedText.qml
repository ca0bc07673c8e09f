import QtQuick
import Turnpoint

// A text that must be read. It is as large as the place allows, and never smaller than the smallest size: a text that
// does not fit then is shown on several pages, which end with a sentence if possible. The page's own button turns to the
// next one (see `turn()`) and has a TextTurner beside it or, with `turns`, this item has its own.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    property string text
    property real size: theme.textBody
    property int weight: Font.Normal
    property color color: theme.ink
    property bool armed: true
    /// True if this item has a button for the next page.
    property bool turns: false
    property int verticalAlignment: Text.AlignVCenter
    /// The height that the text takes at its full size.
    readonly property real natural: whole.height
    readonly property bool more: page + 1 < parts.length
    property var parts: [""]
    property int page: 0
    /// Shows the next page of the text. Returns false if this is the last one.
    function turn() : bool {
        if (more) ++page
        return more
    }

    onTextChanged: divide()
    onWidthChanged: divide()
    onHeightChanged: divide()
    onSizeChanged: divide()
    Component.onCompleted: divide()

    function divide() {
        page = 0
        if (width <= 0 || height <= 0 || text === "") return void(parts = [text])
        for (fitted.letters = Math.ceil(size); ; fitted.letters = Math.max(theme.textLeast, fitted.letters - 1)) {
            if (fits(text, height)) return void(parts = [text])
            if (fitted.letters <= theme.textLeast) break
        }
        const room = height - (turns ? turner.height : 0)
        // words with the space after them; Chinese and Japanese may break after each character
        const words = text.match(/[^\s\u3000-\u9fff\uff00-\uffef]+\s*|[\u3000-\u9fff\uff00-\uffef](?!\u2060)\s*|[\s\u2060\u3000-\u9fff\uff00-\uffef]/g) ?? [text]
        const all = []
        for (let from = 0; from < words.length;) {
            let low = 1, high = words.length - from
            while (low < high) {
                const middle = Math.ceil((low + high) / 2)
                if (fits(words.slice(from, from + middle).join("").trim(), room)) low = middle
                else high = middle - 1
            }
            let end = from + low
            if (end < words.length)
                for (let at = end; at > from + low / 2; --at)
                    if (/[.!?\u3002\uff01\uff1f\u061f]["\u00bb\u201c\u201d)]?\s*$|\n\s*$/.test(words[at - 1])) { end = at; break }
            all.push(words.slice(from, end).join("").trim())
            from = end
        }
        parts = all
    }
    function fits(words: string, room: real) : bool {
        fitted.text = words
        return fitted.contentHeight <= room
    }

    PlainText {
        id: fitted
        property real letters: root.theme.textBody
        visible: false
        width: root.width
        font { pixelSize: letters; weight: root.weight }
        wrapMode: Text.Wrap
    }
    PlainText {
        id: whole
        visible: false
        width: root.width
        text: root.text
        font { pixelSize: root.size; weight: root.weight }
        wrapMode: Text.Wrap
    }
    PlainText {
        objectName: "pagedText"
        anchors { left: parent.left; right: parent.right; top: parent.top; bottom: parent.bottom; bottomMargin: turner.visible ? turner.height : 0 }
        text: root.parts[root.page] ?? ""
        color: root.color
        font { pixelSize: fitted.letters; weight: root.weight }
        wrapMode: Text.Wrap
        horizontalAlignment: Text.AlignHCenter
        verticalAlignment: root.verticalAlignment
    }
    TextTurner {
        id: turner
        theme: root.theme
        texts: root.texts
        of: root
        armed: root.armed
        visible: root.turns && root.parts.length > 1
        anchors { left: parent.left; right: parent.right; bottom: parent.bottom }
        ActionButton {
            objectName: "textNext"
            height: turner.height
            theme: root.theme
            primary: false
            quiet: true
            enabled: root.more
            armed: root.armed
            glyph: "next"
            rotation: root.texts.mirrored ? 180 : 0
            label: root.texts.proceed
            onActivated: root.turn()
        }
    }
}
