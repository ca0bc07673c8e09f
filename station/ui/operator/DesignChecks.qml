import QtQuick
import Turnpoint

// What the check says about the study: whether it can run, how long it takes, every problem (a tap leads to its field),
// and cues that give answers away.
OperatorCard {
    id: root
    required property Texts texts
    required property DesignController design
    signal remarkChosen(index: int)

    PlainText {
        objectName: "designVerdict"
        width: root.inner
        text: root.texts.text(root.design.verdict === "checking" ? "operator.checking" : root.design.verdict === "bad" ? "operator.study_bad"
            : root.design.verdict === "warned" ? "operator.study_warned" : "operator.study_good")
        color: root.design.verdict === "bad" ? root.theme.wrong : root.design.verdict === "good" ? root.theme.right : root.theme.ink
        font { pixelSize: root.theme.textTitle; weight: Font.Bold }
        wrapMode: Text.Wrap
    }
    Repeater {
        model: root.design.remarks
        Rectangle {
            id: remark
            required property var modelData
            required property int index
            readonly property bool problem: modelData.kind === "problem"
            objectName: "designRemark" + index
            width: root.inner
            height: Math.max(root.theme.controlHeight, words.implicitHeight + root.theme.unit)
            radius: root.theme.radius
            color: root.theme.paper
            border { color: problem ? root.theme.wrong : root.theme.line; width: activeFocus ? root.theme.stroke : root.theme.stroke / 2 }
            activeFocusOnTab: true
            Accessible.role: Accessible.Button
            Accessible.name: (problem ? root.texts.text("operator.problem") : modelData.kind === "warning" ? root.texts.text("operator.warning") : root.texts.text("operator.remark"))
                + ": " + root.texts.say(modelData.what) + (modelData.hint === "" ? "" : ". " + root.texts.say(modelData.hint))
            Accessible.onPressAction: root.remarkChosen(index)
            Keys.onReturnPressed: root.remarkChosen(index)
            Keys.onSpacePressed: root.remarkChosen(index)
            Column {
                id: words
                anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter; margins: Math.round(0.8 * root.theme.unit) }
                PlainText {
                    readAloud: false
                    width: parent.width
                    text: (remark.problem ? root.texts.text("operator.problem") : remark.modelData.kind === "warning" ? root.texts.text("operator.warning") : root.texts.text("operator.remark"))
                        + (remark.modelData.line > 0 ? "   ·   " + root.texts.fill("operator.line", remark.modelData.line) : "")
                    color: remark.problem ? root.theme.wrong : root.theme.quiet
                    font { pixelSize: root.theme.textSmall; weight: Font.Bold }
                }
                PlainText {
                    readAloud: false
                    width: parent.width
                    text: root.texts.say(remark.modelData.what) + (remark.modelData.hint === "" ? "" : "\n" + root.texts.arrow + root.texts.say(remark.modelData.hint))
                    color: root.theme.ink
                    font.pixelSize: root.theme.textSmall
                    wrapMode: Text.Wrap
                }
            }
            TapHandler { onTapped: root.remarkChosen(remark.index) }
        }
    }
    FactTable {
        width: root.inner
        theme: root.theme
        texts: root.texts
        heading: root.texts.text("operator.the_session")
        facts: root.design.facts
        labelShare: 0.32
    }
    Repeater {
        model: root.design.cues
        Column {
            id: cue
            required property var modelData
            width: root.inner
            PlainText {
                width: parent.width
                text: root.texts.text("operator.cues") + ": " + root.texts.say(cue.modelData.name) + ", " + root.texts.say(cue.modelData.says)
                color: root.theme.ink
                font { pixelSize: root.theme.textSmall; weight: Font.Bold }
                wrapMode: Text.Wrap
            }
            PlainText {
                width: parent.width
                text: root.texts.arrow + root.texts.say(cue.modelData.advice)
                color: root.theme.quiet
                font.pixelSize: root.theme.textSmall
                wrapMode: Text.Wrap
            }
        }
    }
}
