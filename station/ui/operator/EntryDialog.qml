import QtQuick
import Turnpoint

// Asks for a line of text, with a keyboard on the screen and with suggestions. It covers the page. With `pick`, the
// user taps one of the suggestions instead of typing; with `list`, several of them.
Rectangle {
    id: root
    required property Theme theme
    property string title
    property string keepText
    property string cancelText
    /// With `pick`: the text of a button that takes the choice back; "" without one.
    property string unsetText
    property var suggestions: []
    property bool emptyAllowed: false
    property bool pick: false
    property bool list: false
    /// True if nothing but the suggestions can be chosen.
    property bool closed: false
    /// How a suggestion is said on the page, where that is not the suggestion itself.
    property var sayings: ({})
    /// True if sentences are typed. The keyboard then has capitals and more signs.
    property bool sentences: false
    /// True if the text may have several lines. In the line that is typed, a line break looks like a space.
    property bool lines: false
    /// True if a number is typed, or several. The keyboard then has nothing else.
    property bool numbers: false
    /// An explanation of what to type, and the reason why the last text was refused.
    property string help
    property string refused
    signal accepted(text: string)
    /// Emitted with each change of the text.
    signal typed(text: string)
    signal cancelled()
    property string told

    function open(text: string) {
        told = text
        entry.text = text
        visible = true
        entry.forceActiveFocus()
        entry.cursorPosition = entry.length
    }
    function said(word: string): string {
        return sayings[word] ?? word
    }
    function tell() {
        if (entry.text === told) return
        told = entry.text
        typed(told)
    }
    function choose(word: string) {
        if (pick || (!list && said(word) !== word)) {
            if (pick && entry.text === word) return cancel()
            entry.text = word
            keep()
        } else if (list) {
            const words = entry.text.split(",").map(part => part.trim()).filter(part => part !== "")
            entry.text = (words.includes(word) ? words.filter(other => other !== word) : words.concat([word])).join(", ")
        } else {
            entry.text = word
        }
    }
    function keep() {
        if (entry.text === "" && !emptyAllowed) return
        visible = false
        accepted(entry.text)
    }

    visible: false
    color: theme.paper
    Shield {}
    Keys.onEscapePressed: cancel()
    function cancel() {
        visible = false
        cancelled()
    }
    // The line that is typed and its buttons stay in view; on a small screen, what is below them scrolls.
    Column {
        id: head
        anchors { left: parent.left; right: parent.right; top: parent.top; margins: 2 * root.theme.unit }
        spacing: root.theme.unit
        PlainText {
            width: parent.width
            text: root.title
            color: root.theme.ink
            font { pixelSize: root.theme.textTitle; weight: Font.Bold }
            wrapMode: Text.Wrap
        }
        PlainText {
            visible: text !== ""
            width: parent.width
            text: root.refused !== "" ? root.refused : root.help
            color: root.refused !== "" ? root.theme.wrong : root.theme.quiet
            font.pixelSize: root.theme.textSmall
            wrapMode: Text.Wrap
        }
        Rectangle {
            width: parent.width
            height: root.theme.controlHeight
            radius: root.theme.radius
            color: root.theme.raised
            border { color: root.theme.action; width: root.theme.stroke }
            visible: !root.pick && !(root.list && root.closed)
            TextInput {
                id: entry
                objectName: "entry"
                anchors { fill: parent; leftMargin: root.theme.unit; rightMargin: root.theme.unit }
                verticalAlignment: TextInput.AlignVCenter
                color: root.theme.ink
                font { pixelSize: root.theme.textBody; family: Catalogue.family }
                clip: true
                onAccepted: root.keep()
                onTextEdited: root.tell()
                Accessible.role: Accessible.EditableText
                Accessible.name: root.title
            }
        }
        Flow {
            width: parent.width
            spacing: root.theme.unit
            ActionButton {
                objectName: "keepEntry"
                visible: !root.pick
                theme: root.theme
                enabled: entry.text !== "" || root.emptyAllowed
                text: root.keepText
                onActivated: root.keep()
            }
            ActionButton {
                objectName: "unsetEntry"
                visible: root.pick && root.emptyAllowed && root.unsetText !== "" && entry.text !== ""
                theme: root.theme
                primary: false
                text: root.unsetText
                onActivated: {
                    entry.text = ""
                    root.keep()
                }
            }
            ActionButton {
                objectName: "cancelEntry"
                theme: root.theme
                primary: false
                text: root.cancelText
                onActivated: root.cancel()
            }
        }
    }
    Flickable {
        id: scroll
        objectName: "entryScroll"
        anchors { left: parent.left; right: parent.right; top: head.bottom; bottom: parent.bottom; margins: 2 * root.theme.unit; topMargin: root.theme.unit; bottomMargin: root.theme.unit }
        contentHeight: sheet.height
        interactive: contentHeight > height
        boundsBehavior: Flickable.StopAtBounds
        clip: true
        Column {
            id: sheet
            width: scroll.width
            spacing: root.theme.unit
            ScreenKeyboard {
                visible: !root.pick && !(root.list && root.suggestions.length > 0)
                full: root.sentences
                lines: root.lines
                numbers: root.numbers
                width: parent.width
                theme: root.theme
                onTyped: character => {
                    entry.insert(entry.cursorPosition, character)
                    root.tell()
                }
                onErased: {
                    if (entry.cursorPosition > 0) entry.remove(entry.cursorPosition - 1, entry.cursorPosition)
                    root.tell()
                }
                onMoved: by => entry.cursorPosition = Math.max(0, Math.min(entry.length, entry.cursorPosition + by))
            }
            Flow {
                visible: root.suggestions.length > 0
                width: parent.width
                spacing: Math.round(0.6 * root.theme.unit)
                Repeater {
                    model: root.suggestions
                    ActionButton {
                        required property string modelData
                        theme: root.theme
                        readonly property bool chosen: root.pick ? entry.text === modelData : root.list && entry.text.split(",").some(part => part.trim() === modelData)
                        objectName: "suggestion-" + modelData
                        primary: chosen
                        quiet: !chosen
                        glyph: chosen ? "tick" : ""
                        text: root.said(modelData)
                        onActivated: root.choose(modelData)
                    }
                }
            }
        }
    }
    ScrollCue { theme: root.theme; place: scroll }
}
