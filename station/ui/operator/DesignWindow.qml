import QtQuick
import QtQuick.Window
import Turnpoint

Window {
    id: root
    required property DesignController controller
    required property real pixelsPerMm
    property int turned: 0

    width: 1280
    height: 800
    visible: true
    title: "Turnpoint, design"

    Binding {
        target: Catalogue
        property: "shown"
        value: OperatorScreen.language
    }
    TurnedPanel {
        degrees: root.turned
        across: root.width
        down: root.height
        DesignPage {
            anchors.fill: parent
            design: root.controller
            pixelsPerMm: root.pixelsPerMm
            onClosed: root.close()
        }
    }
}
