import QtQuick
import Turnpoint

// The operator's page about the rig: its calibration, the findings of `turnpoint doctor` and of the
// self-test, and settings for how the operator's pages look.
Rectangle {
    id: root
    required property RigController rig
    required property real pixelsPerMm
    readonly property bool tall: height > width
    property string tab: "doctor"
    readonly property bool testing: tab === "selfTest"
    readonly property bool weighing: tab === "weights"
    readonly property bool guiding: tab === "guide"

    color: look.paper
    LayoutMirroring.enabled: texts.mirrored
    LayoutMirroring.childrenInherit: true
    Component.onCompleted: rig.open()
    Component.onDestruction: rig.guide.leave()

    /// What the operator is asked to do with the weights.
    readonly property var weightStep: rig.step
    readonly property var calibrationFacts: rig.calibration
    function step() : string {
        const remark = texts.say(weightStep.remark)
        return (weightStep.trouble !== "" ? texts.fill("operator.weights_repair", texts.say(weightStep.trouble)) + "\n" : remark !== "" ? remark + "\n" : "") + texts.say(weightStep.asked)
    }

    Theme {
        id: look
        width: root.width
        height: root.height
        pixelsPerMm: root.pixelsPerMm
        dense: true
    }
    Texts { id: texts; language: OperatorScreen.language }

    OperatorCard {
        id: state
        anchors { left: parent.left; top: parent.top; margins: look.margin }
        width: root.tall ? root.width - 2 * look.margin : 0.4 * root.width
        height: root.tall ? 0.42 * root.height : root.height - 2 * look.margin
        theme: look
        heading: texts.text("operator.calibration")
        PlainText {
            objectName: "calibrationState"
            width: state.inner
            text: root.rig.calibrationState === "good" ? texts.text("operator.calibration_good")
                : root.rig.calibrationState === "ageing" ? texts.text("operator.calibration_ageing")
                : root.rig.calibrationState === "bad" ? texts.text("operator.calibration_bad") : texts.text("operator.calibration_none")
            color: root.rig.calibrationState === "bad" ? look.wrong : look.ink
            font { pixelSize: look.textBody; weight: Font.DemiBold }
            wrapMode: Text.Wrap
        }
        FactTable {
            width: state.inner
            theme: look
            texts: texts
            labelShare: 0.3
            facts: root.calibrationFacts.map(fact => ({
                label: texts.text(fact.label),
                value: fact.parts.length > 0 ? fact.parts.map(part => texts.text(part)).join(", ") : fact.text === "" ? fact.value : texts.fill(fact.text, fact.value)
            }))
        }
        PlainText {
            width: state.inner
            text: root.rig.path
            color: look.quiet
            font.pixelSize: look.textSmall
            wrapMode: Text.WrapAnywhere
        }
        PlainText {
            width: state.inner
            topPadding: look.unit
            text: texts.text("operator.screen")
            color: look.action
            font { pixelSize: look.textBody; weight: Font.Bold }
        }
        Flow {
            width: state.inner
            spacing: Math.round(0.6 * look.unit)
            Repeater {
                model: OperatorScreen.languages
                ChoiceButton {
                    required property var modelData
                    objectName: "screen-" + modelData.code
                    theme: look
                    chosen: OperatorScreen.language === modelData.code
                    text: modelData.name
                    onActivated: OperatorScreen.language = modelData.code
                }
            }
        }
        Flow {
            width: state.inner
            spacing: Math.round(0.6 * look.unit)
            ChoiceButton { objectName: "light"; theme: look; chosen: !OperatorScreen.dark; text: texts.text("operator.light"); onActivated: OperatorScreen.dark = false }
            ChoiceButton { objectName: "dark"; theme: look; chosen: OperatorScreen.dark; text: texts.text("operator.dark"); onActivated: OperatorScreen.dark = true }
        }
        Flow {
            width: state.inner
            spacing: look.unit
            ActionButton {
                objectName: "smaller"
                theme: look
                primary: false
                glyph: "minus"
                label: texts.text("operator.text_smaller")
                enabled: OperatorScreen.textPercent > 100
                onActivated: OperatorScreen.textPercent -= 25
            }
            PlainText {
                objectName: "textSize"
                height: look.controlHeight
                verticalAlignment: Text.AlignVCenter
                text: texts.fill("operator.text_size", OperatorScreen.textPercent)
                color: look.ink
                font.pixelSize: look.textBody
            }
            ActionButton {
                objectName: "larger"
                theme: look
                primary: false
                glyph: "plus"
                label: texts.text("operator.text_larger")
                enabled: OperatorScreen.textPercent < 200
                onActivated: OperatorScreen.textPercent += 25
            }
        }
    }
    Flow {
        id: tabs
        anchors { left: results.left; right: results.right; top: root.tall ? state.bottom : parent.top; topMargin: root.tall ? look.unit : look.margin }
        spacing: look.unit
        ChoiceButton { objectName: "doctorTab"; theme: look; chosen: root.tab === "doctor"; text: texts.text("operator.doctor"); onActivated: root.tab = "doctor" }
        ChoiceButton { objectName: "selfTestTab"; theme: look; chosen: root.testing; text: texts.text("operator.self_test"); onActivated: root.tab = "selfTest" }
        ChoiceButton { objectName: "guideTab"; theme: look; enabled: root.rig.busy === ""; chosen: root.guiding; text: texts.text("operator.guide"); onActivated: root.tab = "guide" }
        ChoiceButton { objectName: "weightsTab"; visible: root.rig.hasCells; theme: look; chosen: root.weighing; text: texts.text("operator.weights"); onActivated: root.tab = "weights" }
    }
    CalibrationSteps {
        objectName: "calibrationSteps"
        visible: root.guiding
        anchors { left: results.left; right: results.right; top: results.top; bottom: parent.bottom; bottomMargin: look.margin }
        theme: look
        texts: texts
        guide: root.rig.guide
    }
    OperatorCard {
        id: results
        visible: !root.guiding
        anchors { left: root.tall ? parent.left : state.right; right: parent.right; top: tabs.bottom; bottom: begin.top; margins: look.margin; topMargin: look.unit; bottomMargin: look.unit; leftMargin: root.tall ? look.margin : look.unit }
        theme: look
        PlainText {
            objectName: "rigSays"
            width: results.inner
            text: root.rig.asked === "press_stop" ? texts.text("operator.press_stop")
                : root.rig.asked === "release_stop" ? texts.text("operator.release_stop")
                : root.rig.asked === "press_button" ? texts.fill("operator.press_button", root.rig.askedButton)
                : root.rig.asked !== "" ? root.step()
                : root.rig.busy !== "" ? texts.text("operator.working")
                : root.weighing ? texts.text("operator.weights_text")
                : root.testing ? texts.text("operator.self_test_text") : texts.text("operator.doctor_text")
            color: look.ink
            font { pixelSize: look.textBody; weight: root.rig.busy !== "" ? Font.Bold : Font.Normal }
            wrapMode: Text.Wrap
        }
        PlainText {
            objectName: "weightsReading"
            visible: root.rig.busy === "weights" && text !== ""
            width: results.inner
            text: root.rig.reading.length === 3 ? texts.fill(root.weightStep.converter ? "operator.weights_converter" : "operator.weights_cells", root.rig.reading[0], root.rig.reading[1], root.rig.reading[2]) : root.weightStep.unread ? texts.say(root.weightStep.unread) : ""
            color: look.ink
            font.pixelSize: look.textBody
            wrapMode: Text.Wrap
        }
        Repeater {
            model: root.rig.errors
            PlainText {
                required property var modelData
                width: results.inner
                text: texts.say(modelData)
                color: look.wrong
                font { pixelSize: look.textBody; weight: Font.DemiBold }
                wrapMode: Text.Wrap
            }
        }
        Repeater {
            model: root.weighing ? root.rig.weights : root.testing ? root.rig.checks : root.rig.findings
            Column {
                id: finding
                required property var modelData
                required property int index
                readonly property string state: modelData.status ?? modelData.verdict
                objectName: "finding" + index
                width: results.inner
                spacing: Math.round(0.2 * look.unit)
                Item {
                    width: parent.width
                    height: Math.max(named.implicitHeight, judged.implicitHeight)
                    PlainText {
                        id: named
                        anchors { left: parent.left; right: judged.left; rightMargin: look.unit }
                        text: texts.say(finding.modelData.name)
                        horizontalAlignment: Text.AlignLeft
                        color: look.ink
                        font { pixelSize: look.textBody; weight: Font.DemiBold }
                        wrapMode: Text.Wrap
                    }
                    PlainText {
                        id: judged
                        anchors.right: parent.right
                        text: finding.state === "ok" ? texts.text("operator.good") : finding.state === "warning" ? texts.text("operator.warning")
                            : finding.state === "failed" ? texts.text("operator.failed") : texts.text("operator.not_possible")
                        color: finding.state === "failed" ? look.wrong : finding.state === "ok" ? look.right : look.quiet
                        font { pixelSize: look.textBody; weight: Font.Bold }
                    }
                }
                // A bar that shows the check's reading on a scale from 0 to its limit.
                Rectangle {
                    objectName: visible ? "gauge" + finding.index : ""
                    visible: (finding.modelData.share ?? -1) >= 0
                    width: 0.5 * parent.width
                    height: Math.round(0.8 * look.unit)
                    radius: height / 2
                    color: look.paper
                    border { color: look.line; width: 1 }
                    Rectangle {
                        width: Math.max(height, parent.width * (finding.modelData.share ?? 0))
                        height: parent.height
                        radius: height / 2
                        color: finding.state === "failed" ? look.wrong : look.action
                    }
                }
                PlainText {
                    width: parent.width
                    text: texts.say(finding.modelData.what)
                    horizontalAlignment: Text.AlignLeft
                    color: look.quiet
                    font.pixelSize: look.textSmall
                    wrapMode: Text.Wrap
                }
                PlainText {
                    readonly property string mend: texts.say(finding.modelData.mend)
                    visible: mend !== ""
                    width: parent.width
                    text: texts.arrow + mend
                    horizontalAlignment: Text.AlignLeft
                    color: look.ink
                    font.pixelSize: look.textSmall
                    wrapMode: Text.Wrap
                }
            }
        }
    }
    Flow {
        id: begin
        visible: !root.guiding
        anchors { left: results.left; right: parent.right; bottom: parent.bottom; margins: look.margin; leftMargin: 0 }
        layoutDirection: Qt.RightToLeft
        spacing: look.unit
        ActionButton {
            objectName: root.weighing ? "weigh" : root.testing ? "selfTest" : "examine"
            visible: !(root.weighing && root.rig.busy === "weights")
            theme: look
            enabled: root.rig.busy === ""
            holdMs: root.testing ? 900 : 0
            text: root.weighing ? texts.text("operator.weights_begin") : root.testing ? texts.text("operator.hold_to_test") : texts.text("operator.examine")
            onActivated: root.weighing ? root.rig.weigh() : root.testing ? root.rig.selfTest() : root.rig.examine()
        }
        ActionButton {
            objectName: "weightsRead"
            visible: root.weighing && root.rig.busy === "weights"
            theme: look
            text: texts.text("operator.weights_read")
            enabled: root.rig.asked !== ""
            onActivated: root.rig.answer("read")
        }
        ActionButton {
            objectName: "weightsLeaveOut"
            visible: root.weighing && root.rig.busy === "weights"
            theme: look
            primary: false
            text: texts.text("operator.weights_leave_out")
            enabled: root.rig.asked === "weight"
            onActivated: root.rig.answer("leave_out")
        }
        ActionButton {
            objectName: "weightsStop"
            visible: root.weighing && root.rig.busy === "weights"
            theme: look
            primary: false
            holdMs: 900
            text: texts.text("operator.weights_stop")
            enabled: root.rig.asked !== ""
            onActivated: root.rig.answer("stop")
        }
    }
    // The measurement of the touch panel's latency covers the page. Its page gets the controller once, because the
    // controller is deleted after the page.
    Loader {
        id: latencyPlace
        anchors.fill: parent
        readonly property LatencyController measured: root.rig.guide.latency
        onMeasuredChanged: measured ? setSource("LatencyPage.qml", { controller: measured, pixelsPerMm: root.pixelsPerMm }) : source = ""
        Connections {
            target: latencyPlace.item
            function onClosed() { root.rig.guide.leave() }
        }
    }
}
