import QtQuick
import Turnpoint

// Everything that a trial shows, in a single layout: the surface at the top, the question in the middle, the
// answers below. The phases of a trial fill or empty these three places. Nothing moves while a stimulus runs, unless
// the protocol asks for guidance during stimuli.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property SessionBridge bridge
    readonly property PageModel page: bridge.page

    readonly property bool cue: page.kind === PageModel.Cue
    readonly property bool stimulus: page.kind === PageModel.Stimulus
    readonly property bool feedback: page.kind === PageModel.Feedback
    readonly property bool asks: page.answersOpen && page.answers.length > 0
    readonly property bool counted: page.intervals > 1

    // A flash lasts for a moment from the frame that shows it, however late this frame is. There is one flash in a trial,
    // and each trial begins with a cue of 0.8 s or more, so no second has three flashes, which could cause a seizure.
    readonly property bool signalledByFlash: page.flash
    readonly property bool flashing: signalledByFlash && !flash.over
    onSignalledByFlashChanged: {
        flash.stop()
        flash.over = false
    }
    Connections {
        target: root.Window.window
        enabled: root.flashing
        function onFrameSwapped() { flash.start() }
    }
    Timer {
        id: flash
        objectName: "flash"
        property bool over: false
        interval: 100
        onTriggered: over = true
    }

    // Tapping an answer twice by accident must not also count as a confidence rating: the page ignores taps for a
    // moment. If the program was held up, taps of that moment arrive only after its end, so the page waits for those too.
    readonly property bool confides: page.kind === PageModel.Confidence
    readonly property bool guarded: second.running || waiting.running
    onConfidesChanged: if (confides) second.restart()
    Timer {
        id: second
        interval: 350
        onTriggered: waiting.restart()
    }
    Timer {
        id: waiting
        interval: 50
    }
    // The session shows the question again if a tap was no answer, because it began too early by the kernel's time.
    Connections {
        target: root.bridge
        enabled: root.confides
        function onShown() { field.again() }
    }

    SurfaceDrawing {
        id: surface
        objectName: "surface"
        // A question about the mark needs it, so then it is there on every panel, and the question takes what is left.
        readonly property real least: places.visible ? 10 * root.theme.unit : root.page.hasMark && !root.counted ? 7 * root.theme.unit : 0
        visible: !root.counted && !root.page.answerNow && height >= 7 * root.theme.unit && (root.cue || root.stimulus || root.page.kind === PageModel.Response)
        anchors { left: parent.left; right: parent.right; top: parent.top }
        /// What is below the surface besides the question and the pacer.
        readonly property real belowWithoutPacer: bars.height + (bars.visible ? 2 : 1) * root.theme.unit
        readonly property real below: belowWithoutPacer + pacer.height + (pacer.visible ? 1 : 0) * root.theme.unit
        height: Math.round(Math.max(least, Math.min(0.46 * parent.height, parent.height - answers.height - below - Math.max(asked.height + root.theme.unit, (pacer.visible ? 3.6 : bars.visible ? 3.5 : 9) * root.theme.unit))))
        surface: root.page.surface
        hasMark: root.page.hasMark
        markMm: root.page.markMm
        showFinger: root.cue
        textPixels: root.theme.textSmall
        ink: root.theme.ink
        paper: root.theme.paper
        accent: root.theme.action
    }

    // One dot for each interval; the dot of the current interval is filled. Dots and answers have the order of the
    // protocol from left to right, like the buttons, even if texts are read from right to left.
    Row {
        id: places
        LayoutMirroring.enabled: false
        visible: root.counted && !root.page.answerNow && !root.confides && !root.feedback && root.page.kind !== PageModel.Interval
        anchors { horizontalCenter: parent.horizontalCenter; verticalCenter: surface.verticalCenter }
        spacing: root.theme.targetGap
        Repeater {
            model: root.page.intervals
            Rectangle {
                id: place
                required property int index
                readonly property bool running: root.stimulus && root.page.interval === index + 1
                width: Math.round(Math.min(13 * root.theme.unit, surface.height))
                height: width
                radius: width / 2
                color: running ? root.theme.ink : "transparent"
                border { color: running ? root.theme.ink : root.theme.line; width: root.theme.stroke }
                PlainText {
                    objectName: "intervalName"
                    anchors.centerIn: parent
                    text: root.page.intervalNames.length > place.index ? root.page.intervalNames[place.index] : place.index + 1
                    color: place.running ? root.theme.actionText : root.theme.quiet
                    font { pixelSize: Math.min(root.theme.textHuge, 0.5 * place.width); weight: Font.DemiBold }
                }
            }
        }
    }

    // Force and speed of the finger, beside each other. During a stimulus they are empty and nothing moves.
    Row {
        id: bars
        objectName: "bars"
        visible: root.page.guided && !root.page.answerNow && !root.feedback && !root.confides
        anchors { left: parent.left; right: parent.right; bottom: pacer.top; bottomMargin: visible ? root.theme.unit : 0 }
        height: visible ? Math.max(force.implicitHeight, speed.implicitHeight) : 0
        spacing: 3 * root.theme.unit
        readonly property int count: (force.visible ? 1 : 0) + (speed.visible ? 1 : 0)
        GuidanceBar {
            id: force
            visible: root.page.forceBar.length > 0
            width: (bars.width - bars.spacing * (bars.count - 1)) / Math.max(1, bars.count)
            theme: root.theme
            label: root.texts.text("force")
            bar: root.page.forceBar
            frozen: root.page.barsFrozen
        }
        GuidanceBar {
            id: speed
            visible: root.page.speedBar.length > 0
            width: force.width
            theme: root.theme
            label: root.texts.text("pace")
            bar: root.page.speedBar
            frozen: root.page.barsFrozen
        }
    }

    // The speed that is asked for. It does not move while an answer is awaited either, so that it disturbs nobody.
    Pacer {
        id: pacer
        objectName: "pacer"
        // On a small panel the question, the answers, the surface and the dots of the intervals come first.
        readonly property bool fits: root.height - answers.height - bars.height - implicitHeight >= Math.max((root.counted ? 19.6 : 6.6) * root.theme.unit, surface.least + asked.height + 3 * root.theme.unit)
        visible: bars.visible && root.page.paceMmPerS > 0 && fits
        anchors { left: parent.left; right: parent.right; bottom: answers.top; bottomMargin: visible ? root.theme.unit : 0 }
        height: visible ? implicitHeight : 0
        theme: root.theme
        speedMmPerS: root.page.paceMmPerS
        running: visible && !root.page.barsFrozen && !root.asks
    }

    // The response signal: a band over the whole width, dark and large enough to be noticed while looking elsewhere. A
    // flash makes the whole page dark for a moment, and then light again. Both say what to do, so that they do not depend
    // on brightness alone.
    Rectangle {
        objectName: "signal"
        visible: root.page.answerNow && !root.feedback
        anchors {
            left: parent.left; right: parent.right; top: parent.top
            bottom: root.flashing ? parent.bottom : answers.top
            bottomMargin: root.flashing ? 0 : root.theme.targetGap
        }
        readonly property bool dark: root.flashing || !root.signalledByFlash
        radius: root.theme.radius
        color: dark ? root.theme.ink : "transparent"
        PlainText {
            anchors { fill: parent; margins: root.theme.unit }
            text: root.texts.answerNow
            color: parent.dark ? root.theme.actionText : root.theme.ink
            font { pixelSize: root.theme.textHuge; weight: Font.Bold }
            fontSizeMode: Text.Fit
            minimumPixelSize: root.theme.textLeast
            wrapMode: Text.Wrap
            horizontalAlignment: Text.AlignHCenter
            verticalAlignment: Text.AlignVCenter
        }
    }

    // the question at the smallest size, which tells how much room it needs
    PlainText {
        id: asked
        visible: false
        width: parent.width
        text: question.text
        font { pixelSize: root.theme.textLeast; weight: Font.Medium }
        wrapMode: Text.Wrap
    }
    PlainText {
        id: question
        visible: !root.feedback && !root.page.answerNow && root.page.kind !== PageModel.Interval
        anchors { left: parent.left; right: parent.right; bottom: bars.top; bottomMargin: Math.min(Math.round(1.5 * root.theme.unit), Math.max(0, (bars.y - surface.y - (surface.visible || places.visible ? surface.height : 0) - asked.height) / 2)); top: surface.visible || places.visible ? surface.bottom : parent.top }
        text: root.cue && root.page.cue !== "" ? root.texts.phrased(root.page.cue)
            : root.counted && root.stimulus ? root.texts.slideNow
            : root.counted && !root.asks ? root.texts.getReady
            : root.cue ? root.texts.slideHere : root.texts.phrased(root.page.text)
        color: root.theme.ink
        font { pixelSize: 1.15 * root.theme.textBody; weight: Font.Medium }
        fontSizeMode: Text.Fit
        minimumPixelSize: root.theme.textLeast
        wrapMode: Text.Wrap
        horizontalAlignment: Text.AlignHCenter
        verticalAlignment: Text.AlignVCenter
    }

    AnswerRow {
        id: answers
        visible: root.asks && !root.flashing
        anchors { left: parent.left; right: parent.right; bottom: parent.bottom }
        height: Math.max(leastHeight, Math.min(Math.round(0.36 * parent.height), most))
        // the question and, if it speaks of the mark, the surface keep their place
        most: Math.floor(parent.height - asked.height - surface.belowWithoutPacer - surface.least)
        theme: root.theme
        answers: root.page.answers
        captions: root.page.captions
        pressed: field.pressed
    }

    FeedbackView {
        visible: root.feedback
        anchors { verticalCenter: parent.verticalCenter; left: parent.left; right: parent.right }
        theme: root.theme
        texts: root.texts
        verdict: root.page.verdict
        message: root.page.text
    }

    TouchField {
        id: field
        objectName: "touchField"
        anchors.fill: parent
        bridge: root.bridge
        row: answers.buttons
        count: root.page.answers.length
        columns: answers.columns
        gap: answers.gap
        pixelsPerMm: root.theme.pixelsPerMm
        open: root.visible && root.asks && !root.guarded
    }
}
