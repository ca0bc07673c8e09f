import QtQuick
import Turnpoint

// Up to nine answers of equal size, letter size and colour, so that nothing favours one of them. They stand in
// one row or, if they would become smaller than a finger needs or than their words, in several. This item only draws; a
// TouchField over the page judges the touches on `buttons`.
Item {
    id: root
    required property Theme theme
    required property var answers
    /// Smaller texts below the answers. The list may be shorter than `answers`.
    property var captions: []
    required property int pressed
    /// The height that the page can spare for the answers.
    property real most: height
    /// The height that a button has if there is room.
    property real best: theme.targetMin
    readonly property alias buttons: grid
    readonly property int count: answers.length
    readonly property bool captioned: captions.some(caption => caption !== "")
    /// True if the captions do not fit on the buttons. They are then listed below them.
    readonly property bool listed: captioned && plan.listed
    /// How the answers are arranged: {columns, rows, gap, target (the least height of a button), listed, small (whether letters
    /// must be smaller than the smallest size)}. Large targets come first, and then few rows.
    readonly property var plan: {
        if (count === 0) return { columns: 1, rows: 1, gap: 2, target: theme.targetLeast, listed: false }
        const targets = [theme.targetMin, Math.round(0.8 * theme.targetMin), theme.targetLeast].filter(target => target <= best)
        const gaps = captioned ? [theme.unit, 2] : [theme.targetGap, Math.min(theme.targetGap, Math.round(2 * theme.pixelsPerMm)), 2]
        // The points of a scale stand in one row if they can, because its order is seen at a glance. Other answers stand in
        // several rows before they become smaller.
        const sizes = captioned ? [targets.slice(0, 2), targets.slice(2)] : targets.map(target => [target])
        for (const some of sizes)
            for (let rows = 1; rows <= count; ++rows)
                for (const target of some)
                    for (const gap of gaps)
                        for (const listed of captioned ? [false, true] : [false]) {
                            const made = arranged(rows, target, gap, listed)
                            if (made) return made
                        }
        // long texts take all the height that there is, and may take a little of what a finger needs
        for (let rows = 1; rows <= count; ++rows) {
            const made = arranged(rows, tallest(rows), 2, captioned)
            if (made) return made
        }
        // nothing fits: the widest buttons that are still high enough, with smaller letters rather than broken words
        let columns = 1
        while (columns < count && Math.ceil(count / columns) * (lowest + 2) > most - (captioned ? legend.implicitHeight + theme.unit : 0)) ++columns
        const rows = Math.ceil(count / columns)
        return { columns: columns, rows: rows, gap: 2, target: tallest(rows), listed: captioned, small: true }
    }
    readonly property int lowest: Math.round(0.9 * theme.targetLeast)
    /// The height of the buttons if so many rows with a narrow gap fill the height.
    function tallest(rows: int) : real {
        return Math.max(lowest, Math.floor((most - (captioned ? legend.implicitHeight + theme.unit : 0) + 2) / rows) - 2)
    }
    function arranged(rows: int, target: real, gap: real, listed: bool) : var {
        const columns = Math.ceil(count / rows)
        if (Math.ceil(count / columns) !== rows) return null
        const buttonWidth = Math.floor((width - (columns - 1) * gap) / columns)
        const high = rows * (target + gap) - gap + (listed ? legend.implicitHeight + theme.unit : 0)
        if (buttonWidth < Math.min(target, theme.targetMin) || high > most || !fitting(buttonWidth - 2 * insetOf(columns), target, rows, listed)) return null
        return { columns: columns, rows: rows, gap: gap, target: target, listed: listed }
    }
    readonly property int rows: Math.max(1, plan.rows)
    readonly property int columns: Math.max(1, plan.columns)
    readonly property real gap: plan.gap
    readonly property real buttonWidth: Math.floor((width - (columns - 1) * gap) / columns)
    readonly property real buttonHeight: Math.floor((height - (listed ? legend.implicitHeight + theme.unit : 0) - (rows - 1) * gap) / rows)
    /// The smallest height at which each answer is still as high as a finger needs.
    readonly property real leastHeight: rows * (plan.target + gap) - gap + (listed ? legend.implicitHeight + theme.unit : 0)
    readonly property bool halved: captioned && !listed
    readonly property real inset: insetOf(columns)
    readonly property real labelHeight: Math.floor((halved ? 0.5 : 1) * (buttonHeight - padding(rows)))
    /// The largest text size at which each answer fits its button without breaking a word.
    readonly property real letters: {
        let least = theme.textTitle
        for (let i = 0; i < count; ++i) least = Math.min(least, fits.itemAt(i)?.fontInfo.pixelSize ?? least)
        return least
    }

    function padding(rows: int) : real { return Math.round((rows > 1 ? 1.2 : 2) * theme.unit) }
    function insetOf(columns: int) : real { return Math.round((columns > 3 ? 0.6 : 1) * theme.unit) }
    /// True if all texts fit a button with this room for a line and of this height, in letters of the smallest size and without breaking a word.
    function fitting(width: real, buttonHeight: real, rows: int, listed: bool) : bool {
        const room = width - 2, high = buttonHeight - padding(rows)
        const halves = captioned && !listed
        for (let i = 0; i < count; ++i) {
            const label = linesOf(answers[i] ?? "", room), caption = halves ? linesOf(captions[i] ?? "", room) : 0
            if (Math.max(label, caption) * lineHeight > (halves ? 0.5 : 1) * high) return false
        }
        return true
    }
    /// The number of lines of a text in letters of the smallest size; very large if one of its words is wider than a line.
    function linesOf(text: string, room: real) : int {
        let lines = 1, at = 0
        for (const word of text.match(/[^\s\u00ad\u3000-\u9fff\uff00-\uffef]+[\s\u00ad]*|[\u3000-\u9fff\uff00-\uffef]/g) ?? []) {
            const wide = smallest.advanceWidth(word.trim().replace("\u00ad", "-"))
            if (wide > room) return 1000
            if (at + wide > room) { ++lines; at = 0 }
            at += smallest.advanceWidth(word)
        }
        return lines
    }
    /// The height of a line of the smallest letters. Arabic and other scripts need more than Latin.
    readonly property real lineHeight: Math.ceil(smallest.height * (answers.concat(captions).some(text => /[\u0590-\uffef]/.test(text)) ? 1.3 : 1))
    FontMetrics {
        id: smallest
        font { family: Catalogue.family; pixelSize: root.theme.textLeast; weight: Font.DemiBold }
    }

    Repeater {
        id: fits
        model: 9
        PlainText {
            required property int index
            visible: false
            width: root.buttonWidth - 2 * root.inset - 2
            height: root.labelHeight - (root.halved || root.rows > 1 ? 0 : 2) * root.theme.unit
            text: root.answers[index] ?? ""
            font { pixelSize: root.theme.textTitle; weight: Font.DemiBold }
            fontSizeMode: Text.Fit
            minimumPixelSize: Math.round((root.plan.small ? 0.65 : 1) * root.theme.textLeast)
            wrapMode: Text.WordWrap
        }
    }

    // The captions that do not fit on the buttons, as "1: not at all".
    Flow {
        id: legend
        visible: root.listed
        anchors { left: parent.left; right: parent.right; bottom: parent.bottom }
        spacing: 2 * root.theme.unit
        Repeater {
            model: root.captioned ? root.count : 0
            PlainText {
                required property int index
                visible: (root.captions[index] ?? "") !== ""
                text: (root.answers[index] ?? "") + ": " + (root.captions[index] ?? "")
                color: root.theme.ink
                font { pixelSize: root.theme.textLeast; weight: Font.Medium }
            }
        }
    }

    Item {
        id: grid
        x: Math.floor((parent.width - width) / 2)
        width: root.columns * (root.buttonWidth + root.gap) - root.gap
        height: root.rows * (root.buttonHeight + root.gap) - root.gap
        Repeater {
            // Create as many buttons as any trial can need once, so that no trial has to create one.
            model: 9
            Rectangle {
                id: button
                required property int index
                readonly property bool down: root.pressed === index
                objectName: "answer" + index
                Accessible.role: Accessible.Button
                Accessible.name: (root.answers[index] ?? "") + ((root.captions[index] ?? "") === "" ? "" : ", " + root.captions[index])
                visible: index < root.count
                width: root.buttonWidth
                height: root.buttonHeight
                x: index % root.columns * (width + root.gap)
                y: Math.floor(index / root.columns) * (height + root.gap)
                radius: root.theme.radius
                color: down ? root.theme.raised : root.theme.action
                border { color: root.theme.action; width: 3 * root.theme.stroke }
                PlainText {
                    readAloud: false
                    anchors { left: parent.left; right: parent.right; top: parent.top; leftMargin: root.inset; rightMargin: root.inset; topMargin: root.padding(root.rows) / 2 }
                    height: root.labelHeight
                    text: root.answers[button.index] ?? ""
                    color: button.down ? root.theme.action : root.theme.actionText
                    font { pixelSize: root.letters; weight: Font.DemiBold }
                    wrapMode: Text.Wrap
                    horizontalAlignment: Text.AlignHCenter
                    verticalAlignment: Text.AlignVCenter
                }
                PlainText {
                    readAloud: false
                    visible: root.halved
                    anchors { left: parent.left; right: parent.right; bottom: parent.bottom; margins: root.inset }
                    height: root.labelHeight
                    text: root.captions[button.index] ?? ""
                    color: button.down ? root.theme.action : root.theme.actionText
                    font { pixelSize: Math.max(root.theme.textLeast, Math.min(root.theme.textBody, Math.floor(root.labelHeight / 1.7))); weight: Font.Medium }
                    fontSizeMode: Text.Fit
                    minimumPixelSize: root.theme.textLeast
                    wrapMode: Text.WordWrap
                    horizontalAlignment: Text.AlignHCenter
                    verticalAlignment: Text.AlignVCenter
                }
            }
        }
    }
}
