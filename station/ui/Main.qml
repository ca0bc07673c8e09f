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
    onAskingChanged: if (asking) questions.active = true

    /// What to do once the code has been typed: open the "view" of the running session, let the operator
    /// "arm" the amplifier, show the "report", "leave" the participant's pages for the operator's page, or
    /// "unlock" the operator's page.
    property string wish
    function ask(what: string) {
        wish = what
        gate.active = gate.wanted = true
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

    /// The session's pages are created only after the first page is on the screen, so that the first page
    /// appears early.
    property bool begun: false
    readonly property ParticipantView participant: session.item as ParticipantView
    onFrameSwapped: if (!begun) soon.start()
    Component.onCompleted: if (locked) ask("unlock")

    width: 1280
    height: 800
    visible: true
    title: "Turnpoint"
    color: theme.paper

    Timer {
        id: soon
        interval: 0
        onTriggered: root.begun = true
    }
    Theme {
        id: theme
        width: panel.width
        height: panel.height
        pixelsPerMm: root.pixelsPerMm
    }
    Connections {
        target: root.start
        function onChanged() { if (root.start.stage === StartController.Operator) root.leftHanded = false }
    }
    TurnedPanel {
        id: panel
        degrees: root.turned
        across: root.width
        down: root.height

        // The pages of this window are created when they are first needed, so that the station's first page does not
        // wait for them.
        Loader {
            id: questions
            anchors.fill: parent
            active: false
            sourceComponent: SessionQuestions {
                start: root.start
                pixelsPerMm: root.pixelsPerMm
                leftHanded: root.leftHanded
                onHandChosen: left => root.leftHanded = left
                onDeclined: root.leave()
                onAbandoned: root.leave()
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
        Loader {
            id: gate
            property bool wanted: false
            anchors.fill: parent
            active: false
            sourceComponent: OperatorGate {
                objectName: "gate"
                visible: gate.wanted
                pixelsPerMm: root.pixelsPerMm
                lock: root.operatorLock
                last: root.locked
                onAbandoned: gate.wanted = false
                onPassed: {
                    gate.wanted = false
                    root.grant()
                }
            }
        }
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
                lock: root.operatorLock
                pixelsPerMm: root.pixelsPerMm
            }
        }
    }
}
