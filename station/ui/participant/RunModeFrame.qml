import QtQuick
import Turnpoint

// Shows nothing in a live session. In any other session it draws a band across the top and a frame around the
// page, so that nobody takes the page, or a photograph of it, for a live session.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property string runMode

    readonly property bool shown: runMode !== "" && runMode !== "live"
    readonly property bool pilot: runMode === "pilot"
    readonly property color background: pilot ? theme.warning : theme.simulated
    readonly property color foreground: pilot ? theme.warningText : theme.actionText
    readonly property real band: shown ? 4 * theme.unit : 0
    readonly property real edge: shown ? theme.unit : 0

    visible: shown

    Rectangle {
        anchors.fill: parent
        color: "transparent"
        border { color: root.background; width: root.edge }
    }
    Rectangle {
        id: band
        width: parent.width
        height: root.band
        color: root.background
        Row {
            anchors.centerIn: parent
            spacing: 1.2 * root.theme.unit
            PlainText {
                text: root.pilot ? root.texts.pilot : root.texts.simulated
                color: root.foreground
                font { pixelSize: 2.2 * root.theme.unit; weight: Font.ExtraBold; letterSpacing: 0.15 * root.theme.unit }
                anchors.verticalCenter: parent.verticalCenter
            }
            PlainText {
                text: root.pilot ? root.texts.pilotText : root.texts.simulatedText
                color: root.foreground
                font { pixelSize: 2 * root.theme.unit; weight: Font.Medium }
                anchors.verticalCenter: parent.verticalCenter
            }
        }
    }
}
