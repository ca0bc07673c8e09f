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
    FittedColumn {
        theme: root.theme
        anchors { left: parent.left; right: parent.right; top: back.bottom; bottom: buttons.top; bottomMargin: root.theme.unit }
        spacing: 2 * root.theme.unit
        PlainText {
            width: parent.width
            text: root.refused ? root.texts.declinedTitle : root.texts.consentTitle
            color: root.theme.ink
            font { pixelSize: root.theme.textTitle; weight: Font.Bold }
            horizontalAlignment: Text.AlignHCenter
            wrapMode: Text.Wrap
        }
        PlainText {
            objectName: "consentVersion"
            width: parent.width
            text: root.refused ? root.texts.declinedText : root.texts.consentText.arg(root.version)
            color: root.theme.ink
            font.pixelSize: 1.1 * root.theme.textBody
            lineHeight: 1.25
            horizontalAlignment: Text.AlignHCenter
            wrapMode: Text.Wrap
        }
    }
    Row {
        id: buttons
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
        spacing: root.theme.targetGap
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
