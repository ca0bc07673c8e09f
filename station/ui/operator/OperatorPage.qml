import QtQuick
import Turnpoint

// The operator's start page: choose a protocol (which is checked on this rig), participant, language, live or
// pilot mode and arming, or continue an interrupted session.
Rectangle {
    id: root
    required property OperatorController operating
    required property real pixelsPerMm
    property bool typing: false
    readonly property real gap: look.unit
    /// On a tall screen, items that are side by side on a wide screen are stacked.
    readonly property bool tall: height > width
    /// Why the chosen session would begin too early; "" if it would not.
    readonly property string tooEarly: texts.tooEarly(operating.tooEarly)

    color: look.paper

    Theme {
        id: look
        width: root.width
        height: root.height
        pixelsPerMm: root.pixelsPerMm
        dense: true
    }
    Theme {
        id: largeTheme
        width: root.width
        height: root.height
        pixelsPerMm: root.pixelsPerMm
    }
    Texts { id: texts; language: OperatorScreen.language }

    // Large text on a small screen may not fit into the height of the page; the page then scrolls.
    Flickable {
        id: wholePage
        clip: true
        anchors.fill: parent
        contentHeight: page.height
        interactive: contentHeight > height
        boundsBehavior: Flickable.StopAtBounds
        Item {
            id: page
            /// Height of everything except the list of protocols and the summary, which need about five lines
            /// each.
            readonly property real fixed: header.height + interrupted.height + machine.height + footer.height + 2 * look.margin + 4 * root.gap
            width: wholePage.width
            height: Math.max(root.height, fixed + (root.tall ? 16 : 8) * look.textBody)
            Item {
                id: header
                anchors { left: parent.left; right: parent.right; top: parent.top; margins: look.margin }
                height: 3 * look.unit
                PlainText {
                    id: brand
                    anchors { left: parent.left; verticalCenter: parent.verticalCenter }
                    text: "Turnpoint"
                    color: look.ink
                    font { pixelSize: look.textTitle; weight: Font.Bold }
                }
                PlainText {
                    anchors { left: brand.right; leftMargin: 2 * look.unit; right: parent.right; baseline: brand.baseline }
                    text: root.operating.rig + "   ·   " + root.operating.database
                    color: look.quiet
                    font.pixelSize: look.textSmall
                    elide: Text.ElideMiddle
                }
            }

            // An interrupted session is at the top, because the operator has most likely come to continue it.
            InterruptedSession {
                id: interrupted
                anchors { left: parent.left; right: parent.right; top: header.bottom; margins: look.margin; topMargin: visible ? root.gap : 0 }
                theme: look
                texts: texts
                operating: root.operating
            }

            OtherMachine {
                id: machine
                anchors { left: parent.left; right: parent.right; top: interrupted.bottom; margins: look.margin; topMargin: visible ? root.gap : 0 }
                theme: look
                texts: texts
                operating: root.operating
                onReplaced: button => {
                    replacing.opener = button
                    replacing.open()
                }
                onCopied: naming.open("")
            }

            Item {
                id: body
                anchors { left: parent.left; right: parent.right; top: machine.bottom; bottom: footer.top; margins: look.margin; topMargin: root.gap; bottomMargin: root.gap }
            }
            ProtocolList {
                id: list
                x: texts.mirrored && !root.tall ? body.x + body.width - width : body.x
                y: body.y
                width: root.tall ? body.width : 0.34 * root.width
                height: root.tall ? 0.36 * body.height : body.height
                theme: look
                protocols: root.operating.protocols
                selected: root.operating.selected
                emptyText: texts.fill("operator.no_protocols", root.operating.folder)
                unusableText: texts.text("operator.study_bad")
                onChosen: index => root.operating.select(index)
            }

            SessionSummary {
                id: summary
                x: root.tall || texts.mirrored ? body.x : list.x + list.width + root.gap
                y: root.tall ? list.y + list.height + root.gap : body.y
                width: root.tall ? body.width : body.width - list.width - root.gap
                height: body.y + body.height - y
                theme: look
                texts: texts
                operating: root.operating
                tooEarly: root.tooEarly
                onEarlyWanted: early.open("")
            }

            SessionChoices {
                id: footer
                anchors { left: parent.left; right: parent.right; bottom: parent.bottom; margins: look.margin }
                theme: look
                texts: texts
                operating: root.operating
                gap: root.gap
                onCodeWanted: root.typing = true
            }
        }
    }
    ScrollCue { theme: look; place: wholePage }
    EntryDialog {
        id: early
        objectName: "early"
        anchors.fill: parent
        theme: look
        sentences: true
        title: texts.text("operator.early_title")
        help: root.tooEarly
        keepText: texts.text("operator.begin_early")
        cancelText: texts.text("operator.cancel")
        onAccepted: text => root.operating.beginEarly(text)
    }

    ConfirmDialog {
        id: replacing
        objectName: "replacing"
        anchors.fill: parent
        theme: look
        texts: texts
        title: texts.text("operator.replaced_title")
        text: texts.fill("operator.replaced_text", root.operating.station)
        keepText: texts.text("operator.cancel")
        confirmText: texts.text("operator.replaced_do")
        onConfirmed: root.operating.replaceMachine()
    }
    EntryDialog {
        id: naming
        objectName: "naming"
        anchors.fill: parent
        theme: look
        title: texts.text("operator.copy_title")
        help: texts.fill("operator.copy_help", root.operating.station)
        keepText: texts.text("operator.copy_do")
        cancelText: texts.text("operator.cancel")
        onAccepted: text => root.operating.nameCopy(text)
    }

    ParticipantEntry {
        visible: root.typing
        anchors.fill: parent
        theme: look
        largeTheme: largeTheme
        texts: texts
        operating: root.operating
        onClosed: root.typing = false
    }
}
