import QtQuick
import Turnpoint

// The operator enters the code of the participant, or chooses a known one.
Rectangle {
    id: root
    /// The theme of the operator's pages, and one with larger keys.
    required property Theme theme
    required property Theme largeTheme
    required property Texts texts
    required property OperatorController operating
    signal closed()

    color: root.theme.paper
    Shield {}
    CodePage {
        id: codePage
        objectName: "operatorCode"
        anchors { fill: parent; margins: root.largeTheme.margin; bottomMargin: root.largeTheme.margin + (known.visible ? known.height + root.theme.unit : 0) }
        theme: root.largeTheme
        texts: root.texts
        confirms: false
        title: root.texts.text("operator.code_title")
        help: root.texts.text("operator.code_help")
        onBack: root.closed()
        onAccepted: code => {
            root.operating.enterParticipant(code)
            root.closed()
        }
    }
    Flow {
        id: known
        visible: root.operating.participants.length > 0
        anchors { left: parent.left; right: parent.right; bottom: parent.bottom; margins: root.largeTheme.margin }
        height: root.theme.controlHeight
        clip: true
        spacing: root.theme.unit
        Repeater {
            model: root.operating.participants
            ChoiceButton {
                theme: root.theme
                required property string modelData
                text: modelData
                onActivated: {
                    root.operating.enterParticipant(modelData)
                    root.closed()
                }
            }
        }
    }
}
