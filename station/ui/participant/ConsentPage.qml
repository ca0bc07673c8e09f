import QtQuick
import Turnpoint

// Asks whether the participant has signed this version of the consent form. The form itself is on paper.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property string version
    signal agreed()
    signal declined()

    Column {
        anchors { left: parent.left; right: parent.right; top: parent.top; bottom: buttons.top }
        topPadding: Math.max(0, (height - 22 * root.theme.unit) / 2)
        spacing: 2 * root.theme.unit
        PlainText {
            width: parent.width
            text: root.texts.consentTitle
            color: root.theme.ink
            font { pixelSize: root.theme.textTitle; weight: Font.Bold }
            horizontalAlignment: Text.AlignHCenter
            wrapMode: Text.Wrap
        }
        PlainText {
            objectName: "consentVersion"
            width: parent.width
            text: root.texts.consentText.arg(root.version)
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
            theme: root.theme
            primary: false
            text: root.texts.consentNo
            onActivated: root.declined()
        }
        ActionButton {
            objectName: "agreed"
            theme: root.theme
            text: root.texts.consentYes
            onActivated: root.agreed()
        }
    }
}
