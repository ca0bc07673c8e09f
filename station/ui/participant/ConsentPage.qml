import QtQuick
import Turnpoint

// Asks whether the participant has signed this version of the consent form. The form itself is on paper. A
// participant who has not signed it sees what to do next, and can go back to the question.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property string version
    property bool armed: true
    /// True after the participant has answered "No".
    property bool refused: false
    signal agreed()
    /// Emitted when the operator wants to leave the page after the participant has not consented.
    signal declined()
    signal back()

    onVisibleChanged: refused = false
    Timer {
        id: arming
        interval: 350
    }
    onRefusedChanged: arming.restart()

    BackButton {
        id: back
        theme: root.theme
        texts: root.texts
        armed: root.armed
        onActivated: {
            if (!root.refused) root.back()
            root.refused = false
        }
    }
    Statement {
        theme: root.theme
        texts: root.texts
        anchors { left: parent.left; right: parent.right; top: back.bottom; bottom: buttons.top; bottomMargin: root.theme.unit }
        title: root.refused ? root.texts.declinedTitle : root.texts.consentTitle
        text: root.refused ? root.texts.declinedText : root.texts.fill("consent_text", root.version)
        size: Math.round(1.1 * root.theme.textBody)
        textName: "consentVersion"
        armed: root.armed && !arming.running
    }
    ButtonGroup {
        id: buttons
        theme: root.theme
        room: root.width
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
        ActionButton {
            objectName: "declined"
            width: Math.max(implicitWidth, 18 * root.theme.unit)
            theme: root.theme
            primary: false
            armed: root.armed && !arming.running
            text: root.refused ? root.texts.forOperator : root.texts.consentNo
            onActivated: {
                if (root.refused) root.declined()
                root.refused = true
            }
        }
        ActionButton {
            objectName: "agreed"
            visible: !root.refused
            width: Math.max(implicitWidth, 18 * root.theme.unit)
            theme: root.theme
            primary: false
            armed: root.armed && !arming.running
            text: root.texts.consentYes
            onActivated: root.agreed()
        }
    }
}
