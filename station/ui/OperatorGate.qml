import QtQuick
import Turnpoint

// The way from the participant's screen to the operator's: digits, after a long press that nobody makes by
// accident; or, of a station that is locked, before anything else.
Rectangle {
    id: root
    required property Theme theme
    required property string code
    /// There is nothing behind it to go back to.
    property bool last: false
    property string typed
    readonly property var keys: ["1", "2", "3", "4", "5", "6", "7", "8", "9", "", "0", "⌫"]
    signal passed()
    signal abandoned()

    color: theme.paper
    onVisibleChanged: typed = ""

    function type(key: string) {
        typed = key === "⌫" ? typed.slice(0, -1) : typed + key
        if (typed === code) return passed()
        if (typed.length >= code.length) typed = ""
    }

    MouseArea { anchors.fill: parent }
    Column {
        anchors.centerIn: parent
        spacing: 1.2 * root.theme.unit
        PlainText {
            anchors.horizontalCenter: parent.horizontalCenter
            text: root.typed === "" ? "Operator's code" : "•".repeat(root.typed.length)
            color: root.theme.ink
            font { pixelSize: root.theme.textTitle; weight: Font.Bold }
        }
        Grid {
            anchors.horizontalCenter: parent.horizontalCenter
            columns: 3
            spacing: root.theme.unit
            Repeater {
                model: root.keys
                ActionButton {
                    required property string modelData
                    objectName: "digit" + modelData
                    opacity: modelData === "" ? 0 : 1
                    enabled: modelData !== ""
                    width: 11 * root.theme.unit
                    height: Math.min(root.theme.controlHeight, 7 * root.theme.unit)
                    theme: root.theme
                    primary: false
                    text: modelData === "⌫" ? "" : modelData
                    glyph: modelData === "⌫" ? "backspace" : ""
                    onActivated: root.type(modelData)
                }
            }
        }
        ActionButton {
            objectName: "gateLeave"
            opacity: root.last ? 0 : 1
            enabled: !root.last
            anchors.horizontalCenter: parent.horizontalCenter
            theme: root.theme
            primary: false
            quiet: true
            height: Math.min(root.theme.controlHeight, 7 * root.theme.unit)
            text: "Back"
            onActivated: root.abandoned()
        }
    }
}
