import QtQuick
import QtQuick.Window
import Turnpoint

// The station's window: first the participant's code where none was given, then the session.
Window {
    id: root
    required property SessionBridge bridge
    required property StartController start
    required property real pixelsPerMm
    property bool leftHanded: false
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
        language: root.start.language
    }
    LanguagePage {
        objectName: "languagePage"
        anchors { fill: parent; margins: theme.margin }
        visible: root.start.stage === StartController.Language
        theme: theme
        names: root.start.languageNames
        onChosen: index => root.start.chooseLanguage(index)
    }
    CodePage {
        id: codePage
        objectName: "codePage"
        anchors { fill: parent; margins: theme.margin }
        visible: root.start.stage === StartController.Code
        theme: theme
        texts: texts
        leftHanded: root.leftHanded
        onEdited: code => codePage.known = root.start.isKnown(code)
        onAccepted: code => root.start.enterCode(code)
    }
    ParticipantView {
        objectName: "participantView"
        anchors.fill: parent
        visible: root.start.stage === StartController.Session
        bridge: root.bridge
        pixelsPerMm: root.pixelsPerMm
        leftHanded: root.leftHanded
        onClosed: root.sessionClosed()
    }
}
