import QtQuick
import QtQuick.Window
import Turnpoint

// The station's window: first the participant's code where none was given, then the session.
Window {
    id: root
    required property SessionBridge bridge
    required property real pixelsPerMm
    required property string language
    property bool leftHanded: false
    property bool askCode: false
    property bool codeKnown: false
    signal codeEdited(code: string)
    signal codeAccepted(code: string)
    signal sessionClosed()

    width: 1280
    height: 800
    visible: true
    title: "Turnpoint"
    color: theme.paper

    Theme {
        id: theme
        width: root.width
        height: root.height
        pixelsPerMm: root.pixelsPerMm
    }
    Texts {
        id: texts
        language: root.language
    }
    ParticipantView {
        objectName: "participantView"
        anchors.fill: parent
        visible: !root.askCode
        bridge: root.bridge
        pixelsPerMm: root.pixelsPerMm
        leftHanded: root.leftHanded
        onClosed: root.sessionClosed()
    }
    CodePage {
        objectName: "codePage"
        anchors { fill: parent; margins: theme.margin }
        visible: root.askCode
        theme: theme
        texts: texts
        leftHanded: root.leftHanded
        known: root.codeKnown
        onEdited: code => root.codeEdited(code)
        onAccepted: code => root.codeAccepted(code)
    }
}
