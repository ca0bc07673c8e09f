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
    readonly property real band: shown ? Math.round(Math.max(4 * theme.unit, words.implicitHeight + Math.round(0.8 * theme.unit))) : 0
    readonly property real gap: Math.round(1.2 * theme.unit)
    readonly property real letters: Math.max(2 * theme.unit, theme.textLeast)
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
        Grid {
            id: words
            anchors.centerIn: parent
            // on a narrow screen below each other
            columns: first.implicitWidth + second.implicitWidth + root.gap <= root.width - 2 * root.theme.unit ? 2 : 1
            columnSpacing: root.gap
            horizontalItemAlignment: Grid.AlignHCenter
            verticalItemAlignment: Grid.AlignVCenter
            PlainText {
                id: first
                text: root.pilot ? root.texts.pilot : root.texts.simulated
                color: root.foreground
                font { pixelSize: root.letters; weight: Font.ExtraBold; letterSpacing: Math.round(0.15 * root.theme.unit) }
            }
            PlainText {
                id: second
                text: root.pilot ? root.texts.pilotText : root.texts.simulatedText
                color: root.foreground
                font { pixelSize: root.letters; weight: Font.Medium }
            }
        }
    }
}
