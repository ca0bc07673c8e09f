import QtQuick
import Turnpoint

// The guided calibration: first the measurements to choose from, then one point after another. Each point has a picture
// of what to do, the tone that is played, and what was read.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property CalibrationGuide guide
    readonly property bool measuring: guide.chosen !== ""
    readonly property string unit: guide.chosen === "response" ? " µm" : guide.chosen === "boundaries" ? " mm" : guide.chosen === "sound" ? " dB" : ""
    readonly property var point: guide.point
    readonly property var surface: guide.surface
    readonly property string reading: point.value ?? ""

    function name(series: string) : string {
        const names = { response: "operator.guide_response", boundaries: "operator.guide_boundaries", friction: "operator.guide_friction",
                        sound: "operator.guide_sound", panel_button: "operator.guide_panel_button", panel_photodiode: "operator.guide_panel_photodiode" }
        return series === "" ? "" : texts.text(names[series])
    }

    OperatorCard {
        id: card
        anchors { left: parent.left; right: parent.right; top: parent.top; bottom: buttons.top; bottomMargin: root.theme.unit }
        theme: root.theme
        heading: root.measuring ? root.name(root.guide.chosen) + " · " + root.texts.fill("operator.guide_point", root.guide.at + 1, root.guide.count) : ""
        PlainText {
            objectName: "guideSays"
            width: card.inner
            text: root.guide.chosen === "response" ? root.texts.text("operator.guide_response_text")
                : root.guide.chosen === "boundaries" ? root.texts.text("operator.guide_boundaries_text")
                : root.guide.chosen === "friction" ? root.texts.text("operator.guide_friction_text")
                : root.guide.chosen === "sound" ? root.texts.text("operator.guide_sound_text")
                : root.guide.file !== "" ? root.texts.fill("operator.guide_done", root.guide.file.split("/").pop()) : root.texts.text("operator.guide_text")
            color: root.theme.ink
            font.pixelSize: root.theme.textBody
            wrapMode: Text.Wrap
        }
        PlainText {
            objectName: "guideProblem"
            visible: text !== ""
            width: card.inner
            text: root.texts.say(root.guide.problem)
            color: root.theme.wrong
            font { pixelSize: root.theme.textBody; weight: Font.DemiBold }
            wrapMode: Text.Wrap
        }
        // where to measure: a mark that is dragged to the edge of the sand, or a sign on a picture of the surface
        Loader {
            active: root.guide.chosen === "boundaries"
            visible: active
            width: card.inner
            sourceComponent: DesignStrip {
                objectName: "sandStrip"
                theme: root.theme
                texts: root.texts
                surface: root.surface
                boundaryMm: root.reading === "" ? Math.round(root.surface.lengthMm / 2) : Number(root.reading)
                onMoved: (which, mm) => root.guide.enter(mm.toFixed(1))
            }
        }
        Item {
            visible: root.measuring && root.guide.chosen !== "boundaries"
            width: card.inner
            readonly property real strip: Math.max(Math.round(8.4 * root.theme.unit), 1.4 * root.theme.controlHeight)
            height: root.guide.chosen === "sound" ? strip / 0.7 : strip  // the meter is above the surface
            SurfaceDrawing {
                id: picture
                objectName: "guidePicture"
                anchors { left: parent.left; right: parent.right; bottom: parent.bottom }
                height: parent.strip
                surface: root.surface
                showFinger: root.guide.chosen === "friction"
                textPixels: root.theme.textSmall
                ink: root.theme.ink
                paper: root.theme.raised
                accent: root.theme.action
            }
            Glyph {
                objectName: "guideSign"
                visible: root.guide.chosen !== "friction"
                name: root.guide.chosen === "sound" ? "gauge" : "rings"
                color: root.theme.action
                height: 0.57 * parent.strip
                width: height
                x: root.guide.chosen === "sound" ? (parent.width - width) / 2 : picture.width > 0 ? picture.xOf(0) - width / 2 + (root.surface.wideEndLeft ? 1 : -1) * width / 2 : 0
                y: root.guide.chosen === "sound" ? 0 : 0.21 * parent.strip
            }
        }
        PlainText {
            objectName: "guideTone"
            visible: root.measuring
            width: card.inner
            text: root.texts.fill("operator.guide_tone", root.point.kHz ?? "", root.point.um ?? "", root.point.percent ?? "", root.point.transducer ?? "")
            color: root.theme.quiet
            font.pixelSize: root.theme.textSmall
            wrapMode: Text.Wrap
        }
        Flow {
            visible: root.measuring
            width: card.inner
            spacing: root.theme.unit
            ActionButton {
                objectName: "guidePlay"
                theme: root.theme
                danger: root.guide.playing
                atOnce: root.guide.playing
                enabled: root.guide.playing || root.guide.mayPlay
                glyph: root.guide.playing ? "cross" : "run"
                holdMs: !root.guide.playing && root.guide.real ? 900 : 0
                text: root.guide.playing ? root.texts.fill("operator.guide_left", root.guide.remainingSeconds.toFixed(1))
                    : root.texts.text(root.guide.real ? "operator.guide_hold" : "operator.guide_play")
                onActivated: {
                    if (root.guide.playing) root.guide.stop()
                    else root.guide.play()
                }
            }
            ActionButton {
                objectName: "guideReading"
                theme: root.theme
                primary: false
                text: root.texts.fill("operator.guide_reading", root.reading === "" ? root.texts.text("operator.guide_none") : root.reading + root.unit)
                onActivated: entry.ask(false)
            }
            ActionButton {
                objectName: "guidePhase"
                visible: root.guide.chosen === "response"
                theme: root.theme
                primary: false
                text: root.texts.fill("operator.guide_phase", (root.point.phase ?? "") === "" ? root.texts.text("operator.guide_none") : root.point.phase + "°")
                onActivated: entry.ask(true)
            }
        }
        // What the pick-ups read while the tone plays, as a text and as a bar up to the converter's
        // full scale. Below the buttons, which must not move under a finger that is about to press Stop.
        Repeater {
            model: root.measuring ? root.guide.readings : []
            Column {
                id: reading
                required property var modelData
                objectName: "guideLive"
                width: card.inner
                spacing: Math.round(0.2 * root.theme.unit)
                PlainText {
                    width: parent.width
                    text: root.texts.fill("operator.guide_pick_up", reading.modelData.channel, (reading.modelData.um === "" ? "" : reading.modelData.um + " µm, ") + root.texts.fill("operator.guide_of_range", reading.modelData.percent.toFixed(1)))
                    color: root.theme.ink
                    font.pixelSize: root.theme.textBody
                    wrapMode: Text.Wrap
                }
                Rectangle {
                    width: parent.width
                    height: Math.round(0.8 * root.theme.unit)
                    radius: height / 2
                    color: root.theme.paper
                    border { color: root.theme.line; width: 1 }
                    Rectangle {
                        width: Math.max(height, parent.width * Math.min(1, reading.modelData.percent / 100))
                        height: parent.height
                        radius: height / 2
                        color: reading.modelData.percent >= 98 ? root.theme.wrong : root.theme.action
                    }
                }
            }
        }
        Repeater {
            model: root.measuring ? [] : root.guide.series
            Item {
                id: line
                required property var modelData
                width: card.inner
                height: root.theme.controlHeight
                PlainText {
                    anchors { left: parent.left; right: start.left; rightMargin: root.theme.unit; verticalCenter: parent.verticalCenter }
                    text: (line.modelData.measured ? "✓ " : "") + root.name(line.modelData.name) + " · "
                        + root.texts.text(line.modelData.measured ? "operator.fact_measured" : "operator.guide_missing")
                    color: line.modelData.measured ? root.theme.ink : root.theme.quiet
                    font.pixelSize: root.theme.textBody
                    wrapMode: Text.Wrap
                    maximumLineCount: 2
                    fontSizeMode: Text.Fit
                    minimumPixelSize: 0.7 * root.theme.textSmall
                    height: parent.height
                    verticalAlignment: Text.AlignVCenter
                }
                ActionButton {
                    id: start
                    objectName: "guide-" + line.modelData.name
                    anchors.right: parent.right
                    theme: root.theme
                    primary: false
                    text: root.texts.text("operator.guide_begin")
                    label: text + ": " + root.name(line.modelData.name)
                    onActivated: root.guide.begin(line.modelData.name)
                }
            }
        }
        FigureView {
            objectName: "guideFigure"
            visible: root.guide.figure !== undefined && !root.measuring
            width: card.inner
            height: Math.max(50 * root.theme.unit, 0.8 * width)
            textPixels: 0.75 * root.theme.textSmall
            dark: root.theme.dark
            paper: root.theme.raised
            picture: root.guide.figure
        }
    }
    Flow {
        id: buttons
        anchors { left: parent.left; right: parent.right; bottom: parent.bottom }
        visible: root.measuring
        height: visible ? implicitHeight : 0
        layoutDirection: Qt.RightToLeft
        spacing: root.theme.unit
        ActionButton {
            objectName: "guideFinish"
            theme: root.theme
            enabled: root.guide.mayFinish
            text: root.texts.fill("operator.guide_finish", root.guide.entered, root.guide.count)
            onActivated: root.guide.finish()
        }
        ActionButton {
            objectName: "guideNext"
            theme: root.theme
            primary: false
            enabled: !root.guide.playing && root.guide.at < root.guide.count - 1
            glyph: root.texts.mirrored ? "previous" : "next"
            label: root.texts.fill("design.next", card.heading)
            onActivated: root.guide.show(root.guide.at + 1)
        }
        ActionButton {
            objectName: "guidePrevious"
            theme: root.theme
            primary: false
            enabled: !root.guide.playing && root.guide.at > 0
            glyph: root.texts.mirrored ? "next" : "previous"
            label: root.texts.fill("design.previous", card.heading)
            onActivated: root.guide.show(root.guide.at - 1)
        }
        ActionButton {
            objectName: "guideLeave"
            theme: root.theme
            primary: false
            holdMs: root.guide.entered > 0 ? 900 : 0
            text: root.guide.entered > 0 ? root.texts.text("operator.guide_leave") : root.texts.back
            onActivated: root.guide.leave()
        }
    }
    EntryDialog {
        id: entry
        property bool phase: false
        objectName: "guideEntry"
        anchors.fill: parent
        theme: root.theme
        title: root.name(root.guide.chosen) + (phase ? " (°)" : root.unit !== "" ? " (" + root.unit.trim() + ")" : "")
        keepText: root.texts.text("design.use")
        cancelText: root.texts.text("operator.cancel")
        numbers: true
        emptyAllowed: !phase
        function ask(forPhase: bool) {
            phase = forPhase
            refused = ""
            open(forPhase ? root.point.phase : root.reading)
        }
        onAccepted: text => {
            if (phase ? root.guide.enterPhase(text) : root.guide.enter(text)) return
            refused = root.texts.say(root.guide.problem)
            open(text)
        }
    }
}
