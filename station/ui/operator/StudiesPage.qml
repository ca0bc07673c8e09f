import QtQuick
import Turnpoint

// The protocols in the station's folder. For the chosen protocol, the page shows everything that a check
// says: each problem with its line and a hint, and, for each cue that gives answers away, what can be done
// about it.
Rectangle {
    id: root
    required property StudiesController studies
    required property real pixelsPerMm
    readonly property bool tall: height > width
    readonly property color verdictColor: studies.verdict === "bad" ? look.wrong : studies.verdict === "good" ? look.right : look.ink
    /// The name of a study that the program could not save when it ended; "" if there is none.
    property string kept
    signal continueWanted()
    signal discardWanted()
    signal runWanted(index: int)
    signal newWanted()
    signal changeWanted(path: string)

    color: look.paper
    Component.onCompleted: studies.open()

    Theme {
        id: look
        width: root.width
        height: root.height
        pixelsPerMm: root.pixelsPerMm
        dense: true
    }
    Texts { id: texts; language: OperatorScreen.language }

    ProtocolList {
        id: list
        anchors { left: parent.left; top: parent.top; margins: look.margin }
        width: root.tall ? root.width - 2 * look.margin : 0.34 * root.width
        height: root.tall ? 0.3 * root.height : root.height - 2 * look.margin
        theme: look
        protocols: root.studies.protocols
        selected: root.studies.selected
        emptyText: texts.fill("operator.no_protocols", root.studies.folder)
        unusableText: texts.text("operator.study_bad")
        onChosen: index => root.studies.select(index)
    }
    OperatorCard {
        id: card
        anchors { left: root.tall ? parent.left : list.right; right: parent.right; top: root.tall ? list.bottom : parent.top; bottom: footer.top; margins: look.margin; topMargin: root.tall ? look.unit : look.margin; bottomMargin: look.unit; leftMargin: root.tall ? look.margin : look.unit }
        theme: look
        Flow {
            objectName: "keptStudy"
            visible: root.kept !== ""
            width: card.inner
            spacing: look.unit
            PlainText {
                width: Math.min(implicitWidth, parent.width)
                text: texts.fill("design.kept", root.kept)
                color: look.ink
                font { pixelSize: look.textBody; weight: Font.DemiBold }
                wrapMode: Text.Wrap
            }
            ActionButton {
                objectName: "continueKept"
                theme: look
                text: texts.text("design.kept_continue")
                onActivated: root.continueWanted()
            }
            ActionButton {
                objectName: "discardKept"
                theme: look
                primary: false
                danger: true
                holdMs: 1000
                text: texts.text("design.kept_discard")
                onActivated: root.discardWanted()
            }
        }
        PlainText {
            objectName: "verdict"
            width: parent.width
            text: root.studies.verdict === "" ? "" : texts.text(root.studies.verdict === "checking" ? "operator.checking"
                : root.studies.verdict === "bad" ? "operator.study_bad" : root.studies.verdict === "warned" ? "operator.study_warned" : "operator.study_good")
            color: root.verdictColor
            font { pixelSize: look.textTitle; weight: Font.Bold }
            wrapMode: Text.Wrap
        }
        Repeater {
            model: root.studies.remarks
            Column {
                id: remark
                required property var modelData
                required property int index
                readonly property bool problem: modelData.kind === "problem"
                objectName: "remark" + index
                width: card.inner
                PlainText {
                    width: parent.width
                    text: (remark.problem ? texts.text("operator.problem") : remark.modelData.kind === "warning" ? texts.text("operator.warning") : texts.text("operator.remark"))
                        + (remark.modelData.file === "" ? "" : "   ·   " + remark.modelData.file)
                        + (remark.modelData.line > 0 ? "   ·   " + texts.fill("operator.line", remark.modelData.line) : "")
                    color: remark.problem ? look.wrong : look.quiet
                    font { pixelSize: look.textSmall; weight: Font.Bold }
                    wrapMode: Text.Wrap
                }
                PlainText {
                    width: parent.width
                    text: texts.say(remark.modelData.what)
                    color: look.ink
                    font { pixelSize: look.textBody; weight: remark.problem ? Font.DemiBold : Font.Normal }
                    wrapMode: Text.Wrap
                }
                PlainText {
                    visible: remark.modelData.hint !== ""
                    width: parent.width
                    text: texts.arrow + texts.say(remark.modelData.hint)
                    color: look.quiet
                    font.pixelSize: look.textBody
                    wrapMode: Text.Wrap
                }
            }
        }
        FactTable {
            width: card.inner
            theme: look
            texts: texts
            heading: texts.text("operator.the_session")
            facts: root.studies.facts
            labelShare: 0.32
        }
        PlainText {
            visible: root.studies.cues.length > 0
            width: card.inner
            text: texts.text("operator.cues")
            color: look.action
            font { pixelSize: look.textBody; weight: Font.Bold }
            wrapMode: Text.Wrap
        }
        Repeater {
            model: root.studies.cues
            Column {
                id: cue
                required property var modelData
                width: card.inner
                PlainText {
                    width: parent.width
                    text: texts.say(cue.modelData.name) + ": " + texts.say(cue.modelData.says)
                    color: look.ink
                    font { pixelSize: look.textSmall; weight: cue.modelData.leaks ? Font.Bold : Font.Normal }
                    wrapMode: Text.Wrap
                }
                PlainText {
                    visible: cue.modelData.leaks
                    width: parent.width
                    text: texts.arrow + texts.say(cue.modelData.advice)
                    color: look.quiet
                    font.pixelSize: look.textSmall
                    wrapMode: Text.Wrap
                }
            }
        }
    }
    Item {
        id: footer
        anchors { left: card.left; right: card.right; bottom: parent.bottom; bottomMargin: look.margin }
        height: actions.height
        Flow {
            id: actions
            width: parent.width
            spacing: look.unit
            ActionButton {
                objectName: "runStudy"
                theme: look
                enabled: root.studies.verdict === "good" || root.studies.verdict === "warned"
                text: texts.text("operator.run_this")
                onActivated: root.runWanted(root.studies.selected)
            }
            ActionButton {
                objectName: "checkAgain"
                theme: look
                primary: false
                enabled: root.studies.selected >= 0
                text: texts.text("operator.check_again")
                onActivated: root.studies.open()
            }
            ActionButton {
                objectName: "changeStudy"
                theme: look
                primary: false
                enabled: root.studies.selected >= 0
                text: texts.text("design.change")
                onActivated: root.changeWanted(root.studies.path(root.studies.selected))
            }
            ActionButton {
                objectName: "newStudy"
                theme: look
                primary: false
                glyph: "plus"
                text: texts.text("design.new_study")
                onActivated: root.newWanted()
            }
        }
    }
}
