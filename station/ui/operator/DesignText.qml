import QtQuick
import Turnpoint

// The text of the file. Forms and text follow each other: a moment after the last key, the forms show what was typed.
Rectangle {
    id: root
    required property Theme theme
    required property DesignController design

    radius: theme.radius
    color: theme.raised
    border { color: theme.line; width: 1 }

    function follow() {
        if (edit.text === design.text) return
        const at = edit.cursorPosition
        edit.text = design.text
        edit.cursorPosition = Math.min(at, edit.length)
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
        anchors { fill: parent; margins: root.theme.unit }
        contentWidth: edit.width
        contentHeight: edit.height
        boundsBehavior: Flickable.StopAtBounds
        clip: true
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
        }
    }
    ScrollCue { theme: root.theme; place: scroll }
}
