import QtQuick
import QtQuick.Window
import Turnpoint

// The window with the operator's live view, on a second screen.
Window {
    id: root
    required property LiveModel live
    required property SessionBridge bridge
    required property real pixelsPerMm

    width: 1280
    height: 800
    visible: true
    title: "Turnpoint, operator"

    LiveView {
        anchors.fill: parent
        live: root.live
        bridge: root.bridge
        pixelsPerMm: root.pixelsPerMm
    }
}
