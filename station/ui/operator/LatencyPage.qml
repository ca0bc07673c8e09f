import QtQuick
import Turnpoint

// Measures the touch panel's latency, for the operator. The dark field flashes at each tap. The texts are in
// English, like those of the command line.
Rectangle {
    id: root
    required property LatencyController controller
    required property real pixelsPerMm
    signal closed()

    color: look.paper

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
        spacing: 0.6 * look.unit
        PlainText {
            text: "Latency of the touch panel"
            color: look.ink
            font { pixelSize: look.textTitle; weight: Font.Bold }
        }
        PlainText {
            width: parent.width
            text: root.controller.byButton
                ? "Hold the button against the fingertip, so that each tap on the dark field also presses it. This measures input latency: the time from the press of the finger to the time stamp of the answer."
                : "Fix the photodiode on the square at the left, and tap the dark field. This measures display latency: the time from the time stamp of a touch until the square lights up."
            color: look.ink
            font.pixelSize: look.textBody
            wrapMode: Text.Wrap
        }
        PlainText {
            objectName: "result"
            width: parent.width
            text: root.controller.taps + " taps, " + root.controller.edges + " edges, " + root.controller.pairs + " pairs of the "
                + root.controller.wanted + " or more that are needed; time stamps of the " + root.controller.quality
                + (root.controller.result !== "" ? "\n" + root.controller.result : "\n ")
            color: look.ink
            font { pixelSize: look.textBody; weight: Font.DemiBold }
            wrapMode: Text.Wrap
        }
    }
    Rectangle {
        id: field
        objectName: "latencyField"
        Accessible.role: Accessible.Button
        Accessible.name: "Touch field"
        anchors { left: parent.left; right: parent.right; top: words.bottom; bottom: buttons.top; margins: look.margin }
        radius: look.radius
        color: flash.running ? "white" : "black"
        border { color: look.ink; width: look.stroke }
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
    Row {
        id: buttons
        anchors { right: parent.right; bottom: parent.bottom; margins: look.margin }
        spacing: look.unit
        ActionButton {
            objectName: "latencyLeave"
            theme: look
            primary: false
            holdMs: root.controller.taps > 0 ? 900 : 0
            text: root.controller.taps > 0 ? "Hold to leave without saving" : "Leave"
            onActivated: root.closed()
        }
        ActionButton {
            objectName: "latencyAgain"
            theme: look
            primary: false
            holdMs: root.controller.taps > 0 ? 900 : 0
            text: root.controller.taps > 0 ? "Hold to delete the taps" : "Start over"
            onActivated: root.controller.again()
        }
        ActionButton {
            objectName: "latencyKeep"
            theme: look
            enabled: root.controller.pairs >= root.controller.wanted
            text: "Keep this"
            onActivated: root.controller.keep()
        }
    }
}
