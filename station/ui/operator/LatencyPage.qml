import QtQuick
import Turnpoint

// Measures the touch panel's latency, for the operator. The dark field flashes at each tap.
Rectangle {
    id: root
    required property LatencyController controller
    required property real pixelsPerMm
    signal closed()

    color: look.paper
    LayoutMirroring.enabled: texts.mirrored
    LayoutMirroring.childrenInherit: true

    Texts { id: texts; language: OperatorScreen.language }
    Theme {
        id: look
        width: root.width
        height: root.height
        pixelsPerMm: root.pixelsPerMm
        dense: true
    }

    Column {
        id: words
        anchors { left: parent.left; right: parent.right; top: parent.top; margins: look.margin }
        spacing: Math.round(0.6 * look.unit)
        PlainText {
            width: parent.width
            text: texts.text("latency.title")
            color: look.ink
            font { pixelSize: look.textTitle; weight: Font.Bold }
        }
        PlainText {
            width: parent.width
            text: texts.text(root.controller.byButton ? "latency.by_button" : "latency.by_photodiode")
            color: look.ink
            font.pixelSize: look.textBody
            wrapMode: Text.Wrap
        }
        PlainText {
            objectName: "result"
            width: parent.width
            text: texts.fill("latency.counts", root.controller.taps, root.controller.edges, root.controller.pairs, root.controller.wanted, texts.text(root.controller.quality === "kernel" ? "latency.kernel" : "latency.toolkit")) + "\n" + (root.controller.medianMs === undefined ? " "
                : texts.fill("latency.result", root.controller.medianMs.toFixed(2), root.controller.jitterMs.toFixed(2), root.controller.unmatched, root.controller.taps))
            color: look.ink
            font { pixelSize: look.textBody; weight: Font.DemiBold }
            wrapMode: Text.Wrap
        }
    }
    Rectangle {
        id: field
        objectName: "latencyField"
        Accessible.role: Accessible.Button
        Accessible.name: texts.text("latency.field")
        anchors { left: parent.left; right: parent.right; top: words.bottom; bottom: buttons.top; margins: look.margin }
        radius: look.radius
        color: flash.running ? "white" : "black"
        border { color: look.ink; width: look.stroke }
        // The photodiode's square is at the left in every language.
        LayoutMirroring.enabled: false
        LayoutMirroring.childrenInherit: true
        Rectangle {
            anchors { left: parent.left; verticalCenter: parent.verticalCenter; leftMargin: look.unit }
            visible: !root.controller.byButton
            width: 20 * root.pixelsPerMm
            height: width
            color: "transparent"
            border { color: flash.running ? "black" : "white"; width: 1 }
        }
        Timer {
            id: flash
            interval: 200
        }
        MouseArea {
            anchors.fill: parent
            onPressed: mouse => {
                flash.restart()
                const window = root.Window.window, place = mapToItem(null, mouse.x, mouse.y)
                root.controller.tap(place.x / window.width, place.y / window.height)
            }
        }
    }
    Flow {
        id: buttons
        anchors { left: parent.left; right: parent.right; bottom: parent.bottom; margins: look.margin }
        layoutDirection: Qt.RightToLeft
        spacing: look.unit
        ActionButton {
            objectName: "latencyKeep"
            theme: look
            enabled: root.controller.pairs >= root.controller.wanted
            text: texts.text("latency.keep")
            onActivated: root.controller.keep()
        }
        ActionButton {
            objectName: "latencyAgain"
            theme: look
            primary: false
            holdMs: root.controller.taps > 0 ? 900 : 0
            text: texts.text(root.controller.taps > 0 ? "latency.hold_again" : "latency.again")
            onActivated: root.controller.again()
        }
        ActionButton {
            objectName: "latencyLeave"
            theme: look
            primary: false
            holdMs: root.controller.taps > 0 ? 900 : 0
            text: root.controller.taps > 0 ? texts.text("operator.guide_leave") : texts.back
            onActivated: root.closed()
        }
    }
}
