import QtQuick
import Turnpoint

// What the check says about the chosen session: why it cannot begin, what it consists of, and which cues could give
// answers away.
Rectangle {
    id: root
    required property Theme theme
    required property Texts texts
    required property OperatorController operating
    /// Why the chosen session would begin too early; "" if it would not.
    required property string tooEarly
    signal earlyWanted()

    /// Why no session can begin.
    function reasons() {
        const all = []
        for (const problem of operating.problems) all.push(texts.say(problem))
        for (const reason of operating.notLive) all.push(texts.fill("operator.not_live", texts.say(reason)))
        return all
    }

    radius: root.theme.radius
    color: root.theme.raised
    border { color: root.theme.line; width: 1 }
    PlainText {
        visible: root.operating.checking
        anchors.centerIn: parent
        text: root.texts.text("operator.checking")
        color: root.theme.quiet
        font.pixelSize: root.theme.textBody
    }
    Flickable {
        id: scroll
        objectName: "summaryScroll"
        anchors { fill: parent; margins: Math.round(1.4 * root.theme.unit) }
        visible: !root.operating.checking
        contentHeight: sheet.height
        boundsBehavior: Flickable.StopAtBounds
        clip: true
        Column {
            id: sheet
            width: scroll.width
            spacing: Math.round(1.1 * root.theme.unit)
            Repeater {
                model: root.reasons()
                Row {
                    id: problem
                    required property string modelData
                    width: sheet.width
                    spacing: Math.round(0.8 * root.theme.unit)
                    Glyph {
                        id: sign
                        height: 1.4 * root.theme.textBody
                        name: "alert"
                        color: root.theme.wrong
                    }
                    PlainText {
                        width: parent.width - sign.width - parent.spacing
                        text: problem.modelData
                        color: root.theme.wrong
                        font { pixelSize: root.theme.textSmall; weight: Font.DemiBold }
                        wrapMode: Text.Wrap
                    }
                }
            }
            // The session is refused, but the operator may overrule that with a reason.
            Row {
                objectName: "refusedAsEarly"
                visible: root.tooEarly !== ""
                width: sheet.width
                spacing: Math.round(0.8 * root.theme.unit)
                Glyph {
                    id: earlySign
                    height: 1.4 * root.theme.textBody
                    name: "alert"
                    color: root.theme.wrong
                }
                PlainText {
                    width: parent.width - earlySign.width - parent.spacing
                    text: root.tooEarly
                    color: root.theme.wrong
                    font { pixelSize: root.theme.textSmall; weight: Font.DemiBold }
                    wrapMode: Text.Wrap
                }
            }
            ActionButton {
                objectName: "beginEarly"
                anchors.left: parent.left
                visible: root.tooEarly !== ""
                theme: root.theme
                enabled: root.operating.mayBegin
                primary: false
                danger: true
                holdMs: 900
                text: root.texts.text("operator.hold_early")
                onActivated: root.earlyWanted()
            }
            FactTable {
                width: parent.width
                theme: root.theme
                texts: root.texts
                heading: root.texts.text("operator.the_session")
                facts: root.operating.facts
                labelShare: 0.32
            }
            Column {
                visible: root.operating.cues.length > 0
                width: parent.width
                spacing: Math.round(0.35 * root.theme.unit)
                PlainText {
                    width: parent.width
                    text: root.texts.text("operator.cues")
                    color: root.theme.action
                    font { pixelSize: root.theme.textBody; weight: Font.Bold }
                }
                Repeater {
                    model: root.operating.cues
                    Item {
                        id: cue
                        required property var modelData
                        width: sheet.width
                        height: named.implicitHeight
                        Glyph {
                            id: mark
                            anchors.left: parent.left
                            visible: cue.modelData.leaks
                            height: 1.1 * root.theme.textSmall
                            name: "alert"
                            color: root.theme.wrong
                        }
                        PlainText {
                            id: named
                            anchors { left: parent.left; leftMargin: 1.8 * root.theme.textSmall; right: parent.right }
                            horizontalAlignment: Text.AlignLeft
                            text: root.texts.say(cue.modelData.name) + ": " + root.texts.say(cue.modelData.says)
                            color: cue.modelData.leaks ? root.theme.wrong : root.theme.quiet
                            font { pixelSize: root.theme.textSmall; weight: cue.modelData.leaks ? Font.DemiBold : Font.Normal }
                            wrapMode: Text.Wrap
                        }
                    }
                }
            }
            Repeater {
                model: root.operating.warnings
                PlainText {
                    required property var modelData
                    width: sheet.width
                    text: root.texts.say(modelData)
                    color: root.theme.ink
                    font.pixelSize: root.theme.textSmall
                    wrapMode: Text.Wrap
                }
            }
        }
    }
    ScrollCue { theme: root.theme; place: scroll }
}
