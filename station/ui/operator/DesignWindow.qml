import QtQuick
import QtQuick.Window
import Turnpoint

Window {
    id: root
    required property DesignController controller
    required property real pixelsPerMm

    width: 1280
    height: 800
    visible: true
    title: "Turnpoint, design"

    Binding {
        target: Catalogue
        property: "shown"
        value: OperatorScreen.language
    }
    DesignPage {
        anchors.fill: parent
        design: root.controller
        pixelsPerMm: root.pixelsPerMm
        onClosed: root.close()
    }
}
