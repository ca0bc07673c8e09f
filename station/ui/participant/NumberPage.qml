import QtQuick
import Turnpoint

// Page on which the participant types a number. Done appears once the task accepts the number.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property SessionBridge bridge
    property bool armed: true
    readonly property PageModel page: bridge.page
    property string typed: ""
    onVisibleChanged: typed = ""

    readonly property string point: Qt.locale(page.language).decimalPoint
    readonly property real value: typed === "" || typed === "." ? NaN : Number(typed)
    readonly property bool accepted: value >= page.valueLow && value <= page.valueHigh
    /// On a tall screen the keypad has three columns, otherwise six.
    readonly property bool tall: height > width
    readonly property var keys: tall ? ["1", "2", "3", "4", "5", "6", "7", "8", "9", ".", "0", "<"]
                                     : ["1", "2", "3", "4", "5", "<", "6", "7", "8", "9", "0", "."]

    function press(key: string) {
        if (key === "<") typed = typed.slice(0, -1)
        else if (key === "." ? !typed.includes(".") : typed.length < 7 && !full()) typed += key
    }
    function full() : bool {
        const at = typed.indexOf(".")
        return at >= 0 && typed.length - at > page.valueDecimals
    }

    PlainText {
        anchors.top: parent.top
        width: root.tall ? root.width : entry.x - root.theme.targetGap
        height: (root.tall ? entry.y : pad.y) - root.theme.unit
        text: root.texts.phrased((root.page.first === "" ? "" : root.page.first + "\n") + root.page.text)
        color: root.theme.ink
        font { pixelSize: 1.1 * root.theme.textBody; weight: Font.Medium }
        fontSizeMode: Text.Fit
        minimumPixelSize: root.theme.textLeast
        wrapMode: Text.Wrap
        horizontalAlignment: Text.AlignHCenter
        verticalAlignment: Text.AlignVCenter
    }
    Row {
        id: entry
        LayoutMirroring.enabled: false
        LayoutMirroring.childrenInherit: true
        anchors { bottom: pad.top; bottomMargin: root.theme.unit }
        x: root.tall ? Math.round((root.width - width) / 2) : pad.x + pad.width - width
        spacing: root.theme.targetGap
        height: pad.key
        Rectangle {
            width: Math.min((root.theme.inches < 6 ? 15 : 24) * root.theme.unit, root.width - done.width - parent.spacing)
            height: parent.height
            radius: root.theme.radius
            color: root.theme.raised
            border { color: root.theme.ink; width: root.theme.stroke }
            PlainText {
                objectName: "typed"
                anchors { fill: parent; margins: root.theme.unit }
                text: root.typed.replace(".", root.point)
                color: root.theme.ink
                font { pixelSize: root.theme.textHuge; weight: Font.DemiBold }
                fontSizeMode: Text.Fit
                minimumPixelSize: root.theme.textLeast
                horizontalAlignment: Text.AlignRight
                verticalAlignment: Text.AlignVCenter
            }
        }
        ActionButton {
            id: done
            objectName: "proceed"
            opacity: root.accepted ? 1 : 0
            enabled: root.accepted
            height: parent.height
            width: Math.max(implicitWidth, root.theme.targetMin)
            theme: root.theme
            armed: root.armed
            text: root.texts.done
            onActivated: root.bridge.answerValue(root.value)
        }
    }
    Grid {
        id: pad
        LayoutMirroring.enabled: false
        readonly property real gap: Math.min(root.theme.targetGap, root.theme.unit)
        readonly property int lines: 12 / columns
        /// As large as a finger needs, if the question keeps three lines beside or above the keys.
        readonly property real most: Math.floor((root.height - (root.tall ? 3.6 * root.theme.textLeast + root.theme.unit : 0) - root.theme.unit) / (lines + 1) - gap)
        readonly property real key: Math.min(Math.max(root.theme.targetMin, Math.round(0.14 * root.height)), Math.max(root.theme.targetLeast, most))
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
        columns: root.tall ? 3 : 6
        spacing: gap
        Repeater {
            model: 12
            ActionButton {
                required property int index
                readonly property string key: root.keys[index]
                objectName: "key" + key
                opacity: enabled ? 1 : 0
                enabled: key !== "." || root.page.valueDecimals > 0
                width: Math.floor(Math.min(Math.max(root.theme.targetMin, 1.6 * height), (root.width - (pad.columns - 1) * pad.gap) / pad.columns))
                height: pad.key
                theme: root.theme
                primary: false
                armed: root.armed
                size: root.theme.textTitle
                glyph: key === "<" ? "backspace" : ""
                text: key === "<" ? "" : key === "." ? root.point : key
                label: key === "<" ? root.texts.text("erase") : text
                onActivated: root.press(key)
            }
        }
    }
}
