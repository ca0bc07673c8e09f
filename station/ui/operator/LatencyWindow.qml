import QtQuick
import QtQuick.Window
import Turnpoint

Window {
    id: root
    required property LatencyController controller
    required property real pixelsPerMm
    property int turned: 0

    width: 1280
    height: 800
    visible: true
    title: "Turnpoint, panel latency"

    TurnedPanel {
        degrees: root.turned
        across: root.width
        down: root.height
        LatencyPage {
            anchors.fill: parent
            controller: root.controller
            pixelsPerMm: root.pixelsPerMm
            onClosed: root.close()
        }
    }
    Connections {
        target: root.controller
        function onFinished() { root.close() }
    }
}
