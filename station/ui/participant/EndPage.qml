import QtQuick
import Turnpoint

// Thanks the participant, says the score if answers have points, and shows nothing else. The session's numbers are for the operator, who reaches
// them by a button and the operator's code. They are in the operator's language.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property SessionBridge bridge
    readonly property PageModel page: bridge.page
    readonly property bool hasNumbers: page.summaryLabels.length > 0
    property bool hasReport: false
    property bool armed: true
    /// True while the numbers are shown, which requires the operator's code.
    property bool counting: false
    signal closed()
    signal reportWanted()

    Statement {
        theme: root.theme
        texts: root.texts
        anchors { left: parent.left; right: parent.right; top: parent.top; bottom: buttons.top; bottomMargin: root.theme.unit }
        glyph: "tick"
        glyphHeight: 12 * root.theme.unit
        tint: root.theme.right
        title: root.page.title !== "" ? root.texts.phrased(root.page.title) : root.texts.thanks
        text: root.page.text !== "" ? root.texts.phrased(root.page.text)
            : root.page.resumable ? root.texts.stoppedText : root.texts.thanksText
        color: root.theme.quiet
        armed: root.armed
    }
    ButtonGroup {
        id: buttons
        theme: root.theme
        room: root.width
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
        ActionButton {
            objectName: "results"
            theme: root.theme
            armed: root.armed
            primary: false
            quiet: true
            visible: root.hasReport || root.hasNumbers
            text: root.texts.forOperator
            onActivated: root.reportWanted()
        }
        ActionButton {
            objectName: "close"
            theme: root.theme
            armed: root.armed
            primary: false
            text: root.texts.close
            onActivated: root.closed()
        }
    }

    Texts { id: spoken; language: OperatorScreen.language }

    // The session's numbers, for the operator. They are shown if there is no report yet or none could be
    // made.
    Rectangle {
        visible: root.counting
        LayoutMirroring.enabled: spoken.mirrored
        LayoutMirroring.childrenInherit: true
        anchors.fill: parent
        color: root.theme.paper
        Shield {}
        PlainText {
            id: heading
            anchors { left: parent.left; right: parent.right; top: parent.top }
            text: spoken.text("report.numbers")
            color: root.theme.ink
            font { pixelSize: 0.85 * root.theme.textTitle; weight: Font.Bold }
            elide: Text.ElideRight
        }
        Grid {
            id: numbers
            anchors { left: parent.left; right: parent.right; top: heading.bottom; topMargin: Math.round(1.6 * root.theme.unit) }
            columns: 2
            columnSpacing: 4 * root.theme.unit
            rowSpacing: root.theme.unit
            Repeater {
                model: root.page.summaryLabels
                Item {
                    id: entry
                    required property int index
                    required property var modelData
                    width: (numbers.width - numbers.columnSpacing) / 2
                    height: label.implicitHeight
                    PlainText {
                        id: label
                        anchors.left: parent.left
                        horizontalAlignment: Text.AlignLeft
                        width: parent.width - value.width - root.theme.unit
                        text: spoken.say(entry.modelData)
                        color: root.theme.quiet
                        font.pixelSize: root.theme.textSmall
                        elide: Text.ElideRight
                    }
                    PlainText {
                        id: value
                        anchors.right: parent.right
                        text: root.page.summaryValues[entry.index] ?? ""
                        color: root.theme.ink
                        font { pixelSize: root.theme.textSmall; weight: Font.DemiBold }
                    }
                }
            }
        }
        ActionButton {
            objectName: "closeNumbers"
            anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
            theme: root.theme
            primary: false
            text: spoken.close
            onActivated: root.counting = false
        }
    }
}
