import QtQuick
import QtQuick.Window
import Turnpoint

// The station's window: first the operator's start page, if there is one, then the questions to the
// participant before the session, then the session. The operator's view and the report can be opened on top
// of the participant's pages.
Window {
    id: root
    required property SessionBridge bridge
    required property StartController start
    required property LiveModel live
    required property ReportModel report
    // The operator's pages; null if a session was started from the command line.
    property OperatorController operating: null
    property StudiesController studies: null
    property SessionsController sessions: null
    property RigController rig: null
    property DesignController design: null
    required property OperatorLock operatorLock
    /// True while the operator's page is locked, until somebody has typed the code.
    property bool locked: false
    required property real pixelsPerMm
    /// The angle in degrees by which the pages are turned clockwise, because the panel is not mounted upright.
    property int turned: 0
    property bool leftHanded: false
    readonly property bool asking: start.stage === StartController.Language || start.stage === StartController.Consent
                                   || start.stage === StartController.Code

    /// What to do once the code has been typed: open the "view" of the running session, let the operator
    /// "arm" the amplifier, show the "report", "leave" the participant's pages for the operator's page, or
    /// "unlock" the operator's page.
    property string wish
    function ask(what: string) {
        wish = what
        gate.visible = true
    }
    function grant() {
        if (wish === "arm") participant.armable = true
        if (wish === "report" && report.ready) reportPage.wanted = true
        else if (wish === "report") participant.counting = true
        if (wish === "leave") start.close()
        if (wish === "unlock") locked = false
        if (wish !== "view") return
        // The operator's view would cover a running trial, so pause the session first. The trial is then
        // repeated later.
        if (participant.inTrial) bridge.pause()
        liveView.wanted = true
    }
    /// Leaves the participant's pages, which needs the operator's code. If there is no operator's page, this
    /// closes the window.
    function leave() { ask("leave") }
    /// Goes back to the previous question to the participant. On the first question, leaves these pages.
    function back() { if (!start.back()) leave() }

    /// The session's pages are created only after the first page is on the screen, so that the first page
    /// appears early.
    property bool begun: false
    readonly property ParticipantView participant: session.item as ParticipantView
    onFrameSwapped: begun = true
    Component.onCompleted: if (locked) ask("unlock")

    width: 1280
    height: 800
    visible: true
    title: "Turnpoint"
    color: theme.paper

    // Ignore taps for a short time after a page change: they were meant for the previous page.
    Timer {
        id: arming
        interval: 350
    }
    Connections {
        target: root.start
        function onChanged() {
            arming.restart()
            if (root.start.stage === StartController.Operator) root.leftHanded = false
        }
    }
    Theme {
        id: theme
        width: panel.width
        height: panel.height
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
    TurnedPanel {
        id: panel
        degrees: root.turned

        RunModeFrame {
            id: frame
            anchors.fill: parent
            LayoutMirroring.enabled: texts.mirrored
            LayoutMirroring.childrenInherit: true
            visible: root.asking && shown
            theme: theme
            texts: texts
            runMode: root.asking ? root.start.runMode : ""
        }
        Item {
            LayoutMirroring.enabled: texts.mirrored
            LayoutMirroring.childrenInherit: true
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
                onDeclined: root.leave()
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
                onHandChosen: left => root.leftHanded = left
                onEdited: code => codePage.known = root.start.isKnown(code)
                onAccepted: code => root.start.enterCode(code)
            }
        }
        Loader {
            id: session
            anchors.fill: parent
            visible: root.start.stage === StartController.Session
            active: root.begun || visible
            sourceComponent: ParticipantView {
                objectName: "participantView"
                bridge: root.bridge
                pixelsPerMm: root.pixelsPerMm
                leftHanded: root.leftHanded
                hasReport: root.report.ready
                onClosed: root.leave()
                onReportWanted: root.ask("report")
                onOperatorWanted: root.ask("view")
                onArmingWanted: root.ask("arm")
            }
        }
        OperatorGate {
            id: gate
            objectName: "gate"
            anchors.fill: parent
            visible: false
            theme: theme
            lock: root.operatorLock
            last: root.locked
            onAbandoned: visible = false
            onPassed: {
                visible = false
                root.grant()
            }
        }

        // Each of these pages is created when it is first needed, so that the station's first page does not wait
        // for it.
        Loader {
            id: liveView
            property bool wanted: false
            anchors.fill: parent
            active: wanted
            sourceComponent: LiveView {
                objectName: "liveView"
                live: root.live
                bridge: root.bridge
                pixelsPerMm: root.pixelsPerMm
                closable: true
                onClosed: liveView.wanted = false
            }
            // Closes the operator's view when the session continues, because nothing of that view may be visible
            // in a trial.
            Connections {
                target: root.bridge
                function onShown() { if (root.participant?.inTrial ?? false) liveView.wanted = false }
            }
        }
        Loader {
            id: reportPage
            property bool wanted: false
            anchors.fill: parent
            active: wanted
            sourceComponent: ReportPage {
                objectName: "reportPage"
                report: root.report
                runMode: root.bridge.page.runMode
                pixelsPerMm: root.pixelsPerMm
                onClosed: reportPage.wanted = false
            }
        }
        Loader {
            anchors.fill: parent
            active: root.operating !== null && root.start.stage === StartController.Operator && !root.locked
            sourceComponent: StationPages {
                objectName: "stationPages"
                operating: root.operating
                studies: root.studies
                sessions: root.sessions
                rig: root.rig
                design: root.design
                pixelsPerMm: root.pixelsPerMm
            }
        }
    }
}
