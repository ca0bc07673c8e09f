import QtQuick
import Turnpoint

// Everything that a participant sees during a session: the page, and around it the run mode, the block's
// instruction, a way to pause, and the progress.
Rectangle {
    id: root
    required property SessionBridge bridge
    required property real pixelsPerMm
    property bool leftHanded: false
    /// True if the end page can open the report of the finished session.
    property bool hasReport: false
    /// True if the end page shows the session's numbers. It can show them as long as there is no report.
    property alias counting: endPage.counting
    signal closed()
    signal reportWanted()
    /// Emitted when somebody has held the progress bar for a long time, which operators do and participants
    /// do not.
    signal operatorWanted()
    /// Emitted when an operator wants to arm the amplifier; `armable` means that the code has been entered.
    signal armingWanted()
    property bool armable: false
    /// True if the page is a picture of itself beside the operator's pages. It then chooses the fonts of all texts
    /// only if its language needs fonts of its own.
    property bool preview: false

    readonly property PageModel page: bridge.page
    readonly property int kind: page.kind
    readonly property bool inTrial: kind === PageModel.Cue || kind === PageModel.Stimulus || kind === PageModel.Pause
                                    || kind === PageModel.Response || kind === PageModel.Feedback
                                    || kind === PageModel.Interval
                                    || kind === PageModel.Confidence
    readonly property bool enters: kind === PageModel.Line || kind === PageModel.Number
    readonly property bool questions: kind === PageModel.Question || kind === PageModel.Explanation
    readonly property bool mayPause: inTrial || enters || questions || kind === PageModel.Adjust || kind === PageModel.Instructions
                                     || kind === PageModel.Rest

    color: theme.paper
    LayoutMirroring.enabled: texts.mirrored
    LayoutMirroring.childrenInherit: true
    Binding {
        target: Catalogue
        property: "shown"
        value: root.page.language
        when: root.visible && (!root.preview || /^(zh|ko)/.test(root.page.language))
    }

    Theme {
        id: theme
        width: root.width
        height: root.height
        pixelsPerMm: root.pixelsPerMm
    }
    Texts {
        id: texts
        language: root.page.language
    }
    // Ignore taps for a short time after a page change: they were meant for the previous page.
    Timer {
        id: arming
        interval: 350
        running: true
    }
    /// Changes whenever the participant sees a different page: another kind, title or text.
    readonly property string topic: kind + "\n" + page.title + "\n" + page.text + "\n" + page.safe
    onTopicChanged: arming.restart()
    onKindChanged: armable = false

    RunModeFrame {
        id: frame
        anchors.fill: parent
        theme: theme
        texts: texts
        runMode: root.page.runMode
    }

    Item {
        id: header
        anchors {
            left: parent.left; right: parent.right; top: parent.top
            leftMargin: theme.margin; rightMargin: theme.margin; topMargin: frame.band + theme.unit
        }
        // The same on all pages of a trial, so that nothing moves when the button appears.
        height: root.mayPause ? Math.max(pause.height, badge.height, root.page.offersAgain ? again.implicitHeight : 0) : 0
        InstructionBadge {
            id: badge
            anchors.verticalCenter: parent.verticalCenter
            x: root.leftHanded ? parent.width - width : 0
            visible: instruction !== "" && (root.inTrial || root.enters)
            theme: theme
            texts: texts
            instruction: root.page.instruction
            size: 0.9 * theme.textBody
        }
        BackButton {
            id: back
            visible: root.page.back
            // The Back button is opposite the pause button. Neither is mirrored for languages read from right
            // to left.
            anchors { left: undefined; verticalCenter: parent.verticalCenter }
            x: root.leftHanded ? parent.width - width : 0
            theme: theme
            texts: texts
            armed: !arming.running
            onActivated: root.bridge.back()
        }
        // Feel the intervals of the trial again. It stands in the middle of what badge and pause button leave, so that
        // it is nearer to none of the answers.
        ActionButton {
            id: again
            objectName: "again"
            visible: root.page.again
            anchors.verticalCenter: parent.verticalCenter
            readonly property real badgeRoom: badge.visible ? badge.width + theme.unit : 0
            readonly property real pauseRoom: pause.width + theme.unit
            readonly property real from: root.leftHanded ? pauseRoom : badgeRoom
            readonly property real room: parent.width - badgeRoom - pauseRoom
            width: Math.min(implicitWidth, Math.floor(room))
            x: Math.round(from + (room - width) / 2)
            implicitHeight: Math.max(pause.implicitHeight, theme.targetLeast)
            theme: theme
            primary: false
            size: theme.textSmall
            text: texts.text("again")
            armed: !arming.running
            onActivated: root.bridge.again()
        }
        ActionButton {
            id: pause
            objectName: "pause"
            visible: root.mayPause
            anchors.verticalCenter: parent.verticalCenter
            x: root.leftHanded ? 0 : parent.width - width
            implicitHeight: Math.ceil(Math.max(9 * theme.pixelsPerMm, 5 * theme.unit))
            theme: theme
            primary: false
            quiet: true
            size: theme.textSmall
            glyph: "bars"
            text: texts.pause
            atOnce: true
            onActivated: root.bridge.pause()
        }
    }

    Item {
        id: body
        anchors {
            left: parent.left; right: parent.right; top: header.bottom; bottom: progress.top
            leftMargin: theme.margin; rightMargin: theme.margin
            topMargin: theme.unit; bottomMargin: Math.round(1.2 * theme.unit)
        }
        TrialPage {
            objectName: "trialPage"
            anchors.fill: parent
            visible: root.inTrial
            theme: theme
            texts: texts
            bridge: root.bridge
        }
        InstructionsPage {
            anchors.fill: parent
            visible: root.kind === PageModel.Instructions
            theme: theme
            texts: texts
            bridge: root.bridge
            armed: !arming.running
        }
        RestPage {
            anchors.fill: parent
            visible: root.kind === PageModel.Rest
            theme: theme
            texts: texts
            bridge: root.bridge
            armed: !arming.running
        }
        QuestionPage {
            anchors.fill: parent
            visible: root.kind === PageModel.Question
            theme: theme
            texts: texts
            bridge: root.bridge
            armed: !arming.running
        }
        ExplanationPage {
            anchors.fill: parent
            visible: root.kind === PageModel.Explanation
            theme: theme
            texts: texts
            bridge: root.bridge
            armed: !arming.running
        }
        AdjustPage {
            anchors.fill: parent
            visible: root.kind === PageModel.Adjust
            theme: theme
            texts: texts
            bridge: root.bridge
            leftHanded: root.leftHanded
            armed: !arming.running
        }
        LinePage {
            anchors.fill: parent
            visible: root.kind === PageModel.Line
            theme: theme
            texts: texts
            bridge: root.bridge
            armed: !arming.running
        }
        NumberPage {
            anchors.fill: parent
            visible: root.kind === PageModel.Number
            theme: theme
            texts: texts
            bridge: root.bridge
            armed: !arming.running
        }
        NoticePage {
            anchors.fill: parent
            visible: root.kind === PageModel.Fault || root.kind === PageModel.Paused || root.kind === PageModel.Failed
            theme: theme
            texts: texts
            bridge: root.bridge
            armed: !arming.running
            armable: root.armable
            onClosed: root.closed()
            onArmingWanted: root.armingWanted()
        }
        EndPage {
            id: endPage
            anchors.fill: parent
            visible: root.kind === PageModel.End
            theme: theme
            texts: texts
            bridge: root.bridge
            hasReport: root.hasReport
            armed: !arming.running
            onClosed: root.closed()
            onReportWanted: root.reportWanted()
        }
    }

    MouseArea {
        objectName: "operatorCorner"
        Accessible.role: Accessible.Button
        Accessible.name: texts.forOperator
        LayoutMirroring.enabled: false
        anchors { right: parent.right; bottom: parent.bottom }
        width: 12 * theme.unit
        height: Math.max(progress.height + 2 * theme.unit, 4 * theme.unit)
        // Touches during a trial belong to the trial, so the pause button is disabled until the trial's end.
        enabled: !root.inTrial || root.kind === PageModel.Interval
        pressAndHoldInterval: 2000
        onPressAndHold: root.operatorWanted()
    }
    ProgressStrip {
        id: progress
        anchors {
            left: parent.left; right: parent.right; bottom: parent.bottom
            leftMargin: theme.margin; rightMargin: theme.margin; bottomMargin: frame.edge + theme.unit
        }
        theme: theme
        texts: texts
        // not during a trial, in which nothing may change
        minutes: root.inTrial && root.kind !== PageModel.Interval ? shownMinutes : root.page.minutesLeft
        property int shownMinutes: -1
        onMinutesChanged: shownMinutes = minutes
        done: root.page.trialsDone
        total: root.page.trialsTotal
    }
}
