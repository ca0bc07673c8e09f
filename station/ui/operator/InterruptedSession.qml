import QtQuick
import Turnpoint

// Offers to continue the interrupted session. Takes no room if there is none.
Rectangle {
    id: root
    required property Theme theme
    required property Texts texts
    required property OperatorController operating
    visible: says.text !== ""
    height: visible ? resume.height + Math.round(1.2 * root.theme.unit) : 0
    radius: root.theme.radius
    color: root.theme.raised
    border { color: root.theme.action; width: root.theme.stroke }
    PlainText {
        id: says
        objectName: "interruptedSession"
        anchors { left: parent.left; right: resume.left; verticalCenter: parent.verticalCenter; margins: Math.round(1.2 * root.theme.unit) }
        text: root.texts.interrupted(root.operating.interrupted)
        color: root.theme.ink
        font { pixelSize: root.theme.textBody; weight: Font.DemiBold }
        elide: Text.ElideRight
    }
    ActionButton {
        id: resume
        objectName: "resume"
        anchors { right: parent.right; verticalCenter: parent.verticalCenter; rightMargin: Math.round(0.6 * root.theme.unit) }
        theme: root.theme
        enabled: !root.operating.preparing && !root.operating.otherMachine
        text: root.texts.text("operator.resume")
        onActivated: root.operating.resume()
    }
}
