import QtQuick
import Turnpoint

// The text of the file. Forms and text follow each other: a moment after the last key, the forms show what was typed.
Rectangle {
    id: root
    required property Theme theme
    required property Texts texts
    required property DesignController design
    /// Whether the keyboard of the screen is shown.
    property bool typing: false

    radius: theme.radius
    color: theme.raised
    border { color: theme.line; width: 1 }

    function follow() {
        if (edit.text === design.text) return
        const at = edit.cursorPosition
        edit.text = design.text
        edit.cursorPosition = Math.min(at, edit.length)
    }
    /// Puts the cursor at the beginning of a line, counted from 1.
    function goTo(line: int) {
        let at = 0
        for (let i = 1; i < line && edit.text.indexOf("\n", at) >= 0; ++i) at = edit.text.indexOf("\n", at) + 1
        edit.forceActiveFocus()
        edit.cursorPosition = at
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
    Flickable {
        id: scroll
        anchors { left: parent.left; right: parent.right; top: parent.top; bottom: keyboard.top; margins: root.theme.unit }
        onHeightChanged: reveal(edit.cursorRectangle)
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
            onCursorRectangleChanged: if (activeFocus) scroll.reveal(cursorRectangle)
        }
    }
    ScrollCue { theme: root.theme; place: scroll }
    ActionButton {
        objectName: "keyboard"
        anchors { right: parent.right; bottom: keyboard.top; margins: Math.round(0.5 * root.theme.unit) }
        theme: root.theme
        primary: root.typing
        quiet: !root.typing
        text: root.texts.text("design.keyboard")
        onActivated: {
            root.typing = !root.typing
            edit.forceActiveFocus()
        }
    }
    Loader {
        id: keyboard
        anchors { left: parent.left; right: parent.right; bottom: parent.bottom; margins: root.theme.unit }
        active: root.typing
        visible: active
        height: active ? implicitHeight : 0
        sourceComponent: ScreenKeyboard {
            theme: root.theme
            full: true
            lines: true
            onTyped: character => edit.insert(edit.cursorPosition, character)
            onErased: if (edit.cursorPosition > 0) edit.remove(edit.cursorPosition - 1, edit.cursorPosition)
            onMoved: by => edit.cursorPosition = Math.max(0, Math.min(edit.length, edit.cursorPosition + by))
        }
    }
}
