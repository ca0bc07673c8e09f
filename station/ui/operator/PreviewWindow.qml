import QtQuick
import QtQuick.Window
import Turnpoint

Window {
    id: root
    required property PreviewController controller
    required property real pixelsPerMm

    width: 1280
    height: 800
    visible: true
    title: "Turnpoint, preview"

    PreviewPage {
        anchors.fill: parent
        controller: root.controller
        pixelsPerMm: root.pixelsPerMm
    }
}
