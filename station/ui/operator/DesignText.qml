import QtQuick
import Turnpoint

// The text of the file. Forms and text follow each other: a moment after the last key, the forms show what was typed.
// Below it stands what can be written at the cursor. A tap, or the Tab key for the first one, writes it.
Rectangle {
    id: root
    required property Theme theme
    required property Texts texts
    required property DesignController design
    property var completion: ({ from: 0, words: [] })

    radius: theme.radius
    color: theme.raised
    border { color: theme.line; width: 1 }

    function follow() {
        if (edit.text === design.text) return
        const at = edit.cursorPosition
        edit.text = design.text
        edit.cursorPosition = Math.min(at, edit.length)
    }
    function suggest() { completion = edit.activeFocus && edit.selectedText === "" ? design.complete(edit.text, edit.cursorPosition) : { from: 0, words: [] } }
    function write(index: int) {
        const chosen = completion.words[index]
        edit.remove(completion.from, edit.cursorPosition)
        edit.insert(completion.from, chosen.insert)
        edit.forceActiveFocus()
        suggest()
    }
    Component.onCompleted: follow()
    Component.onDestruction: if (typed.running) root.design.setText(edit.text)
    Connections {
        target: root.design
        function onChanged() { if (!typed.running) root.follow() }
    }
    Timer {
        id: typed
        interval: 500
        onTriggered: root.design.setText(edit.text)
    }
    Timer {
        id: soon
        interval: 1
        onTriggered: root.suggest()
    }
    Flickable {
        id: scroll
        anchors { left: parent.left; right: parent.right; top: parent.top; bottom: words.visible ? words.top : parent.bottom; margins: root.theme.unit }
        contentWidth: edit.width
        contentHeight: edit.height
        boundsBehavior: Flickable.StopAtBounds
        clip: true
        function reveal(cursor: rect) {
            if (cursor.y < contentY) contentY = cursor.y
            else if (cursor.y + cursor.height > contentY + height) contentY = cursor.y + cursor.height - height
        }
        TextEdit {
            id: edit
            objectName: "designText"
            LayoutMirroring.enabled: false
            width: Math.max(scroll.width, implicitWidth)
            height: Math.max(scroll.height, implicitHeight)
            color: root.theme.ink
            selectByMouse: true
            selectionColor: root.theme.action
            selectedTextColor: root.theme.actionText
            font { family: "monospace"; pixelSize: root.theme.textSmall }
            textFormat: TextEdit.PlainText
            Accessible.role: Accessible.EditableText
            Accessible.name: root.design.name
            onTextChanged: if (text !== root.design.text) typed.restart()
            onCursorPositionChanged: soon.restart()
            onActiveFocusChanged: soon.restart()
            onCursorRectangleChanged: if (activeFocus) scroll.reveal(cursorRectangle)
            Keys.onTabPressed: event => {
                event.accepted = root.completion.words.length > 0
                if (event.accepted) root.write(0)
            }
        }
    }
    ScrollCue { theme: root.theme; place: scroll }
    Flickable {
        id: words
        objectName: "completions"
        visible: root.completion.words.length > 0
        anchors { left: parent.left; right: parent.right; bottom: help.visible ? help.top : parent.bottom; margins: 0.6 * root.theme.unit }
        height: root.theme.controlHeight
        contentWidth: row.width
        boundsBehavior: Flickable.StopAtBounds
        flickableDirection: Flickable.HorizontalFlick
        clip: true
        LayoutMirroring.enabled: false
        LayoutMirroring.childrenInherit: true
        Row {
            id: row
            spacing: 0.5 * root.theme.unit
            Repeater {
                model: root.completion.words
                ActionButton {
                    required property var modelData
                    required property int index
                    objectName: "completion-" + modelData.word
                    theme: root.theme
                    primary: false
                    quiet: index > 0
                    size: root.theme.textSmall
                    text: modelData.word
                    onActivated: root.write(index)
                }
            }
        }
    }
    PlainText {
        id: help
        objectName: "completionHelp"
        anchors { left: parent.left; right: parent.right; bottom: parent.bottom; margins: root.theme.unit; bottomMargin: 0.6 * root.theme.unit }
        visible: words.visible && text !== ""
        text: root.completion.words.length > 0 ? root.completion.words[0].help : ""
        color: root.theme.quiet
        font.pixelSize: root.theme.textSmall
        maximumLineCount: 2
        elide: Text.ElideRight
        wrapMode: Text.Wrap
    }
}
