import QtQuick
import Turnpoint

// Asks for the operator's code before the participant's screen shows the operator's pages. On a locked
// station this is the first page.
Rectangle {
    id: root
    required property real pixelsPerMm
    readonly property Theme theme: Theme {
        width: root.width
        height: root.height
        pixelsPerMm: root.pixelsPerMm
    }
    required property OperatorLock lock
    /// True if there is no page to go back to.
    property bool last: false
    property string typed
    property bool wrong: false
    readonly property var keys: ["1", "2", "3", "4", "5", "6", "7", "8", "9", "⌫", "0", "OK"]
    signal passed()
    signal abandoned()

    color: theme.paper
    onVisibleChanged: {
        typed = ""
        wrong = false
    }

    function type(key: string) {
        wrong = false
        if (key === "OK") lock.enter(typed)
        typed = key === "OK" ? "" : key === "⌫" ? typed.slice(0, -1) : (typed + key).slice(0, lock.digits)
    }
    Connections {
        target: root.lock
        function onOpened() { root.passed() }
        function onRefused() { root.wrong = true }
    }

    Texts { id: texts; language: OperatorScreen.language }
    Shield {}
    Column {
        anchors.centerIn: parent
        spacing: 0.9 * root.theme.unit
        PlainText {
            anchors.horizontalCenter: parent.horizontalCenter
            text: texts.text("operator.gate_title")
            color: root.theme.ink
            font { pixelSize: 0.8 * root.theme.textTitle; weight: Font.Bold }
        }
        PlainText {
            objectName: "gateSays"
            anchors.horizontalCenter: parent.horizontalCenter
            // One dot for each typed digit. There are no empty places, so nobody learns the length of the
            // right code.
            text: root.lock.waitS > 0 ? texts.text("operator.gate_wait").arg(root.lock.waitS)
                : root.lock.checking ? texts.text("operator.checking") : root.wrong ? texts.text("operator.gate_wrong")
                : root.typed === "" ? texts.text("operator.gate_type") : "•".repeat(root.typed.length)
            color: root.wrong || root.lock.waitS > 0 ? root.theme.wrong : root.theme.ink
            font { pixelSize: root.theme.textBody; weight: Font.DemiBold }
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
                    enabled: root.lock.waitS === 0 && !root.lock.checking
                    width: 11 * root.theme.unit
                    height: Math.min(root.theme.controlHeight, 5.8 * root.theme.unit)
                    theme: root.theme
                    primary: false
                    text: modelData === "⌫" ? "" : modelData
                    glyph: modelData === "⌫" ? "backspace" : ""
                    label: modelData === "⌫" ? texts.text("erase") : modelData
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
            height: Math.min(root.theme.controlHeight, 5.8 * root.theme.unit)
            text: texts.back
            onActivated: root.abandoned()
        }
    }
}
