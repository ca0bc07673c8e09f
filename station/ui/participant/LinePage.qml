import QtQuick
import Turnpoint

// Page for a rating on a line between two texts. Nothing is marked, and there is no Done button, until the line
// is touched, so that no start position influences the answer.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property SessionBridge bridge
    property bool armed: true
    readonly property PageModel page: bridge.page
    /// Position of the participant's mark, from 0 to 1 along the line; below 0 if there is no mark yet.
    property real mark: -1
    onVisibleChanged: mark = -1

    readonly property real value: page.valueLow + mark * (page.valueHigh - page.valueLow)
    function moveTo(place: real) {
        const step = Math.pow(10, -page.valueDecimals) / (page.valueHigh - page.valueLow)
        const next = Math.max(0, Math.min(1, Math.round(place / step) * step))
        if (next === mark) return
        mark = next
        bridge.moveSlider(value)
    }

    PlainText {
        anchors { left: parent.left; right: parent.right; top: parent.top; bottom: labels.top; bottomMargin: root.theme.unit }
        text: root.texts.phrased(root.page.text)
        color: root.theme.ink
        font { pixelSize: 1.15 * root.theme.textBody; weight: Font.Medium }
        fontSizeMode: Text.Fit
        minimumPixelSize: root.theme.textLeast
        wrapMode: Text.Wrap
        horizontalAlignment: Text.AlignHCenter
        verticalAlignment: Text.AlignVCenter
    }
    Item {
        id: labels
        // the line runs from left to right in every language, so that marks can be compared
        LayoutMirroring.enabled: false
        LayoutMirroring.childrenInherit: true
        readonly property int count: root.page.anchorTexts.length
        /// Position of an anchor (a labelled point of the line), in pixels from the left.
        function place(index: int): real { return line.inset + (root.page.anchorPlaces[index] ?? 0) * (width - 2 * line.inset) }
        anchors { left: parent.left; right: parent.right; bottom: line.top }
        /// On a narrow screen, every second text is in a row above the others, so that each has twice the width.
        readonly property bool staggered: count > 2 && root.height > root.width
        height: (staggered ? 2 : 1) * row
        readonly property real row: Math.round(Math.min(3.4 * root.theme.textBody, 0.25 * root.height))
        readonly property int step: staggered ? 2 : 1
        /// Returns the border between the space for the text of this anchor and that for the text of the next
        /// one. The texts at the two ends may extend to one side only, so they get more space.
        function border(index: int): real {
            const share = count < 3 ? 0.5 : index === 0 ? 0.6 : index === count - 2 ? 0.4 : 0.5
            return (1 - share) * place(index) + share * place(index + step)
        }
        Repeater {
            model: labels.count
            PlainText {
                required property int index
                readonly property real at: labels.place(index)
                readonly property bool first: index === 0
                readonly property bool last: index === labels.count - 1
                readonly property bool raised: labels.staggered && index % 2 === 1 && !last
                readonly property real start: first || index < labels.step ? 0 : labels.border(index - labels.step) + root.theme.unit / 4
                readonly property real end: last || index + labels.step >= labels.count ? labels.width : labels.border(index) - root.theme.unit / 4
                readonly property real half: Math.min(at - start, end - at)
                x: first || last ? start : at - half
                width: first || last ? end - start : 2 * half
                y: raised ? 0 : labels.height - labels.row
                height: labels.row
                text: root.texts.phrased(root.page.anchorTexts[index] ?? "")
                color: root.theme.ink
                font.pixelSize: root.theme.textBody
                fontSizeMode: Text.Fit
                minimumPixelSize: root.theme.textLeast
                wrapMode: Text.Wrap
                horizontalAlignment: first ? Text.AlignLeft : last ? Text.AlignRight : Text.AlignHCenter
                verticalAlignment: Text.AlignBottom
            }
        }
    }
    Item {
        id: line
        objectName: "line"
        Accessible.role: Accessible.Slider
        Accessible.name: root.page.text
        readonly property real inset: 2 * root.theme.unit
        anchors { left: parent.left; right: parent.right; bottom: confirm.top; bottomMargin: root.theme.unit }
        height: Math.min(root.theme.targetMin, Math.max(Math.round(10 * root.theme.pixelsPerMm), Math.round(0.22 * root.height)))
        Rectangle {
            anchors { left: parent.left; right: parent.right; margins: line.inset; verticalCenter: parent.verticalCenter }
            height: root.theme.stroke
            color: root.theme.ink
        }
        Repeater {
            model: root.page.anchorPlaces.length
            Rectangle {
                required property int index
                width: root.theme.stroke
                height: 0.35 * line.height
                x: line.inset + (root.page.anchorPlaces[index] ?? 0) * (line.width - 2 * line.inset) - width / 2
                anchors.verticalCenter: parent.verticalCenter
                color: root.theme.ink
            }
        }
        Rectangle {
            objectName: "mark"
            visible: root.mark >= 0
            width: Math.round(1.2 * root.theme.unit)
            height: 0.8 * line.height
            radius: width / 2
            x: line.inset + root.mark * (line.width - 2 * line.inset) - width / 2
            anchors.verticalCenter: parent.verticalCenter
            color: root.theme.action
        }
        MouseArea {
            anchors.fill: parent
            enabled: root.armed
            function follow(x: real) { root.moveTo((x - line.inset) / (line.width - 2 * line.inset)) }
            onPressed: mouse => follow(mouse.x)
            onPositionChanged: mouse => follow(mouse.x)
        }
    }
    ActionButton {
        id: confirm
        objectName: "proceed"
        visible: root.mark >= 0
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
        height: line.height
        width: Math.max(implicitWidth, 22 * root.theme.unit)
        theme: root.theme
        armed: root.armed
        text: root.texts.done
        onActivated: root.bridge.answerValue(root.value)
    }
}
