import QtQuick
import Turnpoint

// Asks where to write files: to a folder of this machine, or to a disk that is plugged in.
Rectangle {
    id: root
    required property Theme theme
    required property Texts texts
    required property SessionsController sessions
    property string title
    /// True if the page also asks what to export, and in which format.
    property bool exporting: false
    /// session, study or all
    property string what: "session"
    property string format: "csv"
    signal chosen(place: int)

    function open() {
        sessions.lookForDisks()
        visible = true
        forceActiveFocus()
    }

    visible: false
    color: theme.paper
    Shield {}
    Keys.onEscapePressed: visible = false
    PlainText {
        id: heading
        anchors { left: parent.left; right: parent.right; top: parent.top; margins: 2 * root.theme.unit }
        text: root.title
        color: root.theme.ink
        font { pixelSize: root.theme.textTitle; weight: Font.Bold }
        wrapMode: Text.Wrap
    }
    OperatorCard {
        id: card
        anchors { left: parent.left; right: parent.right; top: heading.bottom; bottom: cancel.top; margins: 2 * root.theme.unit; topMargin: root.theme.unit; bottomMargin: root.theme.unit }
        theme: root.theme
        Flow {
            visible: root.exporting
            width: card.inner
            spacing: root.theme.unit
            ChoiceButton { objectName: "exportOne"; theme: root.theme; chosen: root.what === "session"; text: root.texts.text("operator.this_session"); onActivated: root.what = "session" }
            ChoiceButton { objectName: "exportStudy"; theme: root.theme; chosen: root.what === "study"; text: root.texts.text("operator.this_study"); onActivated: root.what = "study" }
            ChoiceButton { objectName: "exportAll"; theme: root.theme; chosen: root.what === "all"; text: root.texts.text("operator.all_sessions"); onActivated: root.what = "all" }
            Item { width: 2 * root.theme.unit; height: 1 }
            ChoiceButton { objectName: "csv"; theme: root.theme; chosen: root.format === "csv"; text: "CSV"; onActivated: root.format = "csv" }
            ChoiceButton { objectName: "bids"; theme: root.theme; chosen: root.format === "bids"; text: "BIDS"; onActivated: root.format = "bids" }
        }
        Repeater {
            model: root.sessions.places
            Item {
                id: place
                required property var modelData
                required property int index
                width: card.inner
                height: Math.max(go.height, words.height) + root.theme.unit
                Column {
                    id: words
                    anchors { left: parent.left; right: go.left; rightMargin: root.theme.unit; verticalCenter: parent.verticalCenter }
                    PlainText {
                        width: parent.width
                        text: place.modelData.disk ? place.modelData.name : root.texts.text("operator.this_machine")
                        color: root.theme.ink
                        font { pixelSize: root.theme.textBody; weight: Font.DemiBold }
                        wrapMode: Text.Wrap
                    }
                    PlainText {
                        width: parent.width
                        text: place.modelData.mounted ? place.modelData.folder : root.texts.text("operator.not_mounted")
                        color: root.theme.quiet
                        font.pixelSize: root.theme.textSmall
                        wrapMode: Text.Wrap
                    }
                }
                ActionButton {
                    id: go
                    objectName: "place" + place.index
                    anchors { right: parent.right; verticalCenter: parent.verticalCenter }
                    theme: root.theme
                    text: root.texts.text("operator.write_here")
                    onActivated: {
                        root.visible = false
                        root.chosen(place.index)
                    }
                }
            }
        }
        PlainText {
            objectName: "noDisk"
            visible: root.sessions.places.length === 1
            width: card.inner
            text: root.texts.text("operator.no_disk")
            color: root.theme.quiet
            font.pixelSize: root.theme.textBody
            wrapMode: Text.Wrap
        }
    }
    Row {
        id: cancel
        anchors { left: parent.left; bottom: parent.bottom; margins: 2 * root.theme.unit }
        spacing: root.theme.unit
        ActionButton {
            objectName: "cancelPlace"
            theme: root.theme
            primary: false
            text: root.texts.text("operator.cancel")
            onActivated: root.visible = false
        }
        ActionButton {
            objectName: "lookAgain"
            theme: root.theme
            primary: false
            quiet: true
            text: root.texts.text("operator.look_again")
            onActivated: root.sessions.lookForDisks()
        }
    }
}
