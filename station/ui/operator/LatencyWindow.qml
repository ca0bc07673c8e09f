import QtQuick
import QtQuick.Window
import Turnpoint

Window {
    id: root
    required property LatencyController controller
    required property real pixelsPerMm

    width: 1280
    height: 800
    visible: true
    title: "Turnpoint, panel latency"

    LatencyPage {
        anchors.fill: parent
        controller: root.controller
        pixelsPerMm: root.pixelsPerMm
        onClosed: root.close()
    }
    Connections {
        target: root.controller
        function onFinished() { root.close() }
    }
}
