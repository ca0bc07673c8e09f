import QtQuick
import Turnpoint

// What the study can be expected to find: the numbers that simulated sessions of the draft estimate, and how far the
// estimates spread.
OperatorCard {
    id: root
    required property Texts texts
    required property Precision precision

    PlainText {
        objectName: "precisionSays"
        width: root.inner
        text: root.precision.problem !== "" ? root.texts.say(root.precision.problem) : root.texts.text("design.precision_text")
        color: root.precision.problem !== "" ? root.theme.wrong : root.theme.ink
        font.pixelSize: root.theme.textBody
        wrapMode: Text.Wrap
    }
    PlainText {
        objectName: "precisionState"
        width: root.inner
        visible: root.precision.busy || root.precision.sessions > 0
        text: root.precision.busy ? root.texts.fill("design.precision_busy", Math.round(100 * root.precision.progress))
            : root.texts.fill("design.precision_sessions", root.precision.sessions)
        color: root.theme.quiet
        font { pixelSize: root.theme.textSmall; weight: Font.DemiBold }
        wrapMode: Text.Wrap
    }
    Rectangle {
        objectName: "precisionBar"
        visible: root.precision.busy
        width: root.inner
        height: Math.round(0.8 * root.theme.unit)
        radius: height / 2
        color: root.theme.paper
        border { color: root.theme.line; width: 1 }
        Accessible.role: Accessible.ProgressBar
        Accessible.name: Math.round(100 * root.precision.progress) + " %"
        Rectangle {
            width: Math.max(height, parent.width * root.precision.progress)
            height: parent.height
            radius: height / 2
            color: root.theme.action
        }
    }
    Repeater {
        model: root.precision.numbers
        Column {
            id: number
            required property var modelData
            required property int index
            objectName: "precision" + index
            width: root.inner
            spacing: Math.round(0.15 * root.theme.unit)
            // numbers of an earlier draft are pale until those of this one are there
            opacity: root.precision.busy && root.precision.progress < 0.09 ? 0.5 : 1
            PlainText {
                width: parent.width
                text: number.modelData.name
                color: root.theme.action
                font { pixelSize: root.theme.textBody; weight: Font.Bold }
                wrapMode: Text.Wrap
            }
            PlainText {
                width: parent.width
                text: root.texts.fill(number.modelData.tailed ? "design.precision_median" : "design.precision_estimate", number.modelData.estimate, number.modelData.spread)
                color: root.theme.ink
                font { pixelSize: root.theme.textBody; weight: Font.DemiBold }
                wrapMode: Text.Wrap
            }
            PlainText {
                visible: number.modelData.truth !== ""
                width: parent.width
                text: root.texts.fill("design.precision_truth", number.modelData.truth)
                color: root.theme.quiet
                font.pixelSize: root.theme.textSmall
                wrapMode: Text.Wrap
            }
            PlainText {
                visible: number.modelData.width !== "" && number.modelData.coverage !== ""
                width: parent.width
                text: root.texts.fill("design.precision_interval", number.modelData.width, number.modelData.coverage)
                color: root.theme.quiet
                font.pixelSize: root.theme.textSmall
                wrapMode: Text.Wrap
            }
        }
    }
    FigureView {
        objectName: "precisionFigure"
        visible: root.precision.figure !== undefined && root.precision.numbers.length > 0
        width: root.inner
        height: Math.max(1, root.precision.numbers.length) * Math.max(16 * root.theme.unit, 13 * root.theme.textSmall)
        textPixels: 0.8 * root.theme.textSmall
        dark: root.theme.dark
        paper: root.theme.raised
        picture: root.precision.figure
    }
}
