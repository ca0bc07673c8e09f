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
    /// True if a new code is chosen here.
    property bool choosing: false
    property string typed
    property bool wrong: false
    readonly property bool tall: height > width
    readonly property real keyHeight: tall ? Math.min(theme.targetMin, Math.round(0.13 * height)) : Math.round(Math.min(root.theme.controlHeight, (lock.builtIn && !choosing ? 5.2 : 5.8) * root.theme.unit))
    readonly property var keys: ["1", "2", "3", "4", "5", "6", "7", "8", "9", "⌫", "0", "OK"]
    signal passed()
    signal abandoned()

    color: theme.paper
    onVisibleChanged: {
        typed = ""
        wrong = false
        if (visible) forceActiveFocus()
    }
    Component.onCompleted: forceActiveFocus()
    Keys.onPressed: event => {
        event.accepted = true
        if (event.key === Qt.Key_Return || event.key === Qt.Key_Enter) type("OK")
        else if (event.key === Qt.Key_Backspace) type("⌫")
        else if (event.key === Qt.Key_Escape) { if (!last) abandoned() }
        else if (/^[0-9]$/.test(event.text)) type(event.text)
        else event.accepted = false
    }

    function type(key: string) {
        if (lock.waitS > 0 || lock.checking) return
        wrong = false
        if (key === "OK" && typed !== "") {
            if (choosing) lock.choose(typed)
            else lock.enter(typed)
        }
        typed = key === "OK" ? "" : key === "⌫" ? typed.slice(0, -1) : (typed + key).slice(0, lock.digits)
    }
    Connections {
        target: root.lock
        function onOpened() { root.passed() }
        function onChosen() { root.passed() }
        function onRefused() { root.wrong = true }
    }

    Texts { id: texts; language: OperatorScreen.language }
    Shield {}
    Column {
        anchors.centerIn: parent
        spacing: Math.round(0.9 * root.theme.unit)
        PlainText {
            anchors.horizontalCenter: parent.horizontalCenter
            text: texts.text(root.choosing ? "operator.code_choose" : "operator.gate_title")
            color: root.theme.ink
            font { pixelSize: Math.max(0.8 * root.theme.textTitle, root.theme.textLeast); weight: Font.Bold }
        }
        PlainText {
            objectName: "gateSays"
            anchors.horizontalCenter: parent.horizontalCenter
            // One dot for each typed digit. There are no empty places, so nobody learns the length of the
            // right code.
            // A new code is shown while it is typed, so that its owner can read it.
            text: root.choosing ? (root.lock.checking ? texts.text("operator.checking") : root.wrong ? texts.text("operator.code_refused")
                                   : root.typed === "" ? texts.text("operator.code_digits") : root.typed)
                : root.lock.waitS > 0 ? texts.fill("operator.gate_wait", root.lock.waitS)
                : root.lock.checking ? texts.text("operator.checking") : root.wrong ? texts.text("operator.gate_wrong")
                : root.typed === "" ? texts.text("operator.gate_type") : "•".repeat(root.typed.length)
            color: root.wrong || root.lock.waitS > 0 ? root.theme.wrong : root.theme.ink
            font { pixelSize: root.theme.textBody; weight: Font.DemiBold }
        }
        PlainText {
            objectName: "builtIn"
            visible: root.lock.builtIn && !root.choosing
            width: Math.min(implicitWidth, root.width - 2 * root.theme.margin)
            anchors.horizontalCenter: parent.horizontalCenter
            text: texts.fill("operator.code_built_in", root.lock.shownCode)
            color: root.theme.ink
            font.pixelSize: root.theme.textSmall
            horizontalAlignment: Text.AlignHCenter
            wrapMode: Text.Wrap
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
                    width: root.tall ? Math.min(root.theme.targetMin, Math.floor((root.width - 2 * root.theme.margin - 2 * root.theme.unit) / 3)) : 11 * root.theme.unit
                    height: root.keyHeight
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
            height: root.keyHeight
            text: texts.text(root.choosing ? "operator.code_later" : "back")
            onActivated: root.abandoned()
        }
    }
}
