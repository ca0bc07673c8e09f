import QtQuick
import Turnpoint

// The operator's choices for the next session: participant, language, live or pilot run and arming, and the button that
// begins it.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property OperatorController operating
    required property real gap
    signal codeWanted()

    height: choices.height

    component Choice: ChoiceButton { theme: root.theme }

    component Caption: PlainText {
        width: Math.ceil(implicitWidth)
        height: root.theme.controlHeight
        color: root.theme.quiet
        font.pixelSize: root.theme.textBody
        verticalAlignment: Text.AlignVCenter
    }
    // The software renderer does not clip symbols that scroll out of the form above, so this strip covers
    // them.
    Rectangle {
        anchors { fill: parent; topMargin: 1 - root.gap }
        color: root.theme.paper
    }
    Column {
        id: choices
        width: parent.width
        spacing: root.gap
        Flow {
            width: parent.width
            spacing: root.gap
            Row {
                spacing: root.gap
                leftPadding: root.texts.mirrored ? 2 * root.gap : 0
                rightPadding: root.texts.mirrored ? 0 : 2 * root.gap
                Caption { text: root.texts.text("operator.participant") }
                Choice {
                    objectName: "askCode"
                    chosen: root.operating.participant === ""
                    text: root.texts.text("operator.types_code")
                    onActivated: root.operating.enterParticipant("")
                }
                Choice {
                    objectName: "enterCode"
                    chosen: root.operating.participant !== ""
                    text: root.operating.participant === "" ? root.texts.text("operator.enter_now") : root.texts.fill(root.operating.participantKnown ? "operator.known" : "operator.new", root.operating.participant)
                    onActivated: root.codeWanted()
                }
            }
            Row {
                spacing: root.gap
                visible: root.operating.languages.length > 1
                Caption { text: root.texts.text("operator.language") }
                Choice {
                    objectName: "languageAsked"
                    chosen: root.operating.language < 0
                    text: root.texts.text("operator.asked")
                    onActivated: root.operating.chooseLanguage(-1)
                }
                Repeater {
                    model: root.operating.languages
                    Choice {
                        required property string modelData
                        required property int index
                        objectName: "language" + index
                        chosen: root.operating.language === index
                        text: modelData
                        onActivated: root.operating.chooseLanguage(index)
                    }
                }
            }
        }
        Item {
            id: last
            /// True if the last row has room for all its items beside the button that begins the
            /// session.
            readonly property bool wide: mode.implicitWidth + arm.implicitWidth + begin.width + 4 * root.gap <= width
            width: parent.width
            height: wide ? root.theme.controlHeight : ready.height + root.gap + begin.height
            Flow {
                id: ready
                anchors.left: parent.left
                width: last.wide ? parent.width - begin.width - root.gap : parent.width
                spacing: root.gap
                Row {
                    id: mode
                    spacing: root.gap
                    leftPadding: root.texts.mirrored ? root.gap : 0
                    rightPadding: root.texts.mirrored ? 0 : root.gap
                    Choice {
                        objectName: "pilot"
                        chosen: !root.operating.live
                        text: root.texts.text("operator.pilot_run")
                        onActivated: root.operating.setLive(false)
                    }
                    Choice {
                        objectName: "live"
                        chosen: root.operating.live
                        text: root.texts.text("operator.live_run")
                        onActivated: root.operating.setLive(true)
                    }
                }
                ActionButton {
                    id: arm
                    objectName: "arm"
                    theme: root.theme
                    primary: root.operating.armed
                    quiet: !root.operating.armed
                    holdMs: root.operating.armed ? 0 : 900
                    glyph: root.operating.armed ? "tick" : ""
                    text: root.operating.armed ? root.texts.text("operator.armed") : root.texts.text("hold_to_arm")
                    onActivated: root.operating.setArmed(!root.operating.armed)
                }
            }
            ActionButton {
                id: begin
                objectName: "begin"
                anchors { right: parent.right; bottom: parent.bottom }
                width: Math.max(implicitWidth, 18 * root.theme.unit)
                theme: root.theme
                enabled: root.operating.mayBegin
                text: root.texts.text(root.operating.preparing ? "operator.preparing" : root.operating.live ? "operator.begin_live" : "operator.begin_pilot")
                onActivated: root.operating.begin()
            }
        }
    }
}
