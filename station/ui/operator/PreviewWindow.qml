import QtQuick
import QtQuick.Window
import Turnpoint

Window {
    id: root
    required property PreviewController controller
    required property real pixelsPerMm
    property int turned: 0

    width: 1280
    height: 800
    visible: true
    title: "Turnpoint, preview"

    TurnedPanel {
        degrees: root.turned
        across: root.width
        down: root.height
        PreviewPage {
            anchors.fill: parent
            controller: root.controller
            pixelsPerMm: root.pixelsPerMm
        }
    }
}
