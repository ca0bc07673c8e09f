import QtQuick
import Turnpoint

// Asks for a line of text, with a keyboard on the screen and with suggestions. It covers the page.
Rectangle {
    id: root
    required property Theme theme
    property string title
    property string keepText
    property string cancelText
    property var suggestions: []
    property bool emptyAllowed: false
    signal accepted(text: string)

    function open(text: string) {
        entry.text = text
        visible = true
        entry.forceActiveFocus()
    }
    function keep() {
        if (entry.text === "" && !emptyAllowed) return
        visible = false
        accepted(entry.text)
    }

    visible: false
    color: theme.paper
    MouseArea { anchors.fill: parent }
    Keys.onEscapePressed: visible = false
    Column {
        anchors { fill: parent; margins: 2 * root.theme.unit }
        spacing: root.theme.unit
        PlainText {
            width: parent.width
            text: root.title
            color: root.theme.ink
            font { pixelSize: root.theme.textTitle; weight: Font.Bold }
            wrapMode: Text.Wrap
        }
        Rectangle {
            width: parent.width
            height: root.theme.controlHeight
            radius: root.theme.radius
            color: root.theme.raised
            border { color: root.theme.action; width: root.theme.stroke }
            TextInput {
                id: entry
                objectName: "entry"
                anchors { fill: parent; leftMargin: root.theme.unit; rightMargin: root.theme.unit }
                verticalAlignment: TextInput.AlignVCenter
                color: root.theme.ink
                font { pixelSize: root.theme.textBody; family: Catalogue.family }
                clip: true
                onAccepted: root.keep()
                Accessible.role: Accessible.EditableText
                Accessible.name: root.title
            }
        }
        Flow {
            visible: root.suggestions.length > 0
            width: parent.width
            spacing: 0.6 * root.theme.unit
            Repeater {
                model: root.suggestions
                ActionButton {
                    required property string modelData
                    theme: root.theme
                    primary: false
                    quiet: true
                    text: modelData
                    onActivated: entry.text = modelData
                }
            }
        }
        ScreenKeyboard {
            width: parent.width
            theme: root.theme
            onTyped: character => entry.text += character
            onErased: entry.text = entry.text.slice(0, -1)
        }
        Flow {
            width: parent.width
            spacing: root.theme.unit
            ActionButton {
                objectName: "keepEntry"
                theme: root.theme
                enabled: entry.text !== "" || root.emptyAllowed
                text: root.keepText
                onActivated: root.keep()
            }
            ActionButton {
                objectName: "cancelEntry"
                theme: root.theme
                primary: false
                text: root.cancelText
                onActivated: root.visible = false
            }
        }
    }
}
