import QtQuick
import Turnpoint

// The questions to the participant before a session, one page at a time: language, consent and code.
Item {
    id: root
    required property StartController start
    required property real pixelsPerMm
    property bool leftHanded: false
    signal handChosen(left: bool)
    signal declined()
    /// The participant went back from the first question.
    signal abandoned()

    readonly property bool asking: start.stage === StartController.Language || start.stage === StartController.Consent
                                   || start.stage === StartController.Code
    function back() { if (!start.back()) abandoned() }

    LayoutMirroring.enabled: texts.mirrored
    LayoutMirroring.childrenInherit: true

    // Ignore taps for a short time after a page change: they were meant for the previous page.
    Timer {
        id: arming
        interval: 350
        running: true
    }
    Connections {
        target: root.start
        function onChanged() { arming.restart() }
    }
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
    Binding {
        target: Catalogue
        property: "shown"
        value: root.start.language
        when: root.asking
    }
    RunModeFrame {
        id: frame
        anchors.fill: parent
        visible: root.asking && shown
        theme: theme
        texts: texts
        runMode: root.asking ? root.start.runMode : ""
    }
    Item {
        anchors { fill: parent; margins: theme.margin; topMargin: frame.band + (frame.shown ? theme.unit : theme.margin) }
        LanguagePage {
            objectName: "languagePage"
            anchors.fill: parent
            visible: root.start.stage === StartController.Language
            theme: theme
            texts: texts
            armed: !arming.running
            names: root.start.languageNames
            onBack: root.back()
            onChosen: index => root.start.chooseLanguage(index)
        }
        ConsentPage {
            objectName: "consentPage"
            anchors.fill: parent
            visible: root.start.stage === StartController.Consent
            theme: theme
            texts: texts
            version: root.start.consentVersion
            armed: !arming.running
            onBack: root.back()
            onAgreed: root.start.consent()
            onDeclined: root.declined()
        }
        CodePage {
            id: codePage
            objectName: "codePage"
            anchors.fill: parent
            visible: root.start.stage === StartController.Code
            theme: theme
            texts: texts
            leftHanded: root.leftHanded
            asksHand: true
            armed: !arming.running
            onBack: root.back()
            onHandChosen: left => root.handChosen(left)
            onEdited: code => codePage.known = root.start.isKnown(code)
            onAccepted: code => root.start.enterCode(code)
        }
    }
}
