import QtQuick
import Turnpoint

// The operator's start page: choose a protocol (which is checked on this rig), participant, language, live or
// pilot mode and arming, or continue an interrupted session. What the check says is in English, like
// the command line.
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

    component Choice: ChoiceButton { theme: look }

    component Caption: PlainText {
        height: look.controlHeight
        color: look.quiet
        font.pixelSize: look.textBody
        verticalAlignment: Text.AlignVCenter
    }
    // Large text on a small screen may not fit into the height of the page; the page then scrolls.
    Flickable {
        id: wholePage
        anchors.fill: parent
        contentHeight: page.height
        interactive: contentHeight > height
        boundsBehavior: Flickable.StopAtBounds
        Item {
            id: page
            /// Height of everything except the list of protocols and the summary, which need about five lines
            /// each.
            readonly property real fixed: header.height + interrupted.height + footer.height + 2 * look.margin + 4 * root.gap
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
                    anchors { left: brand.right; leftMargin: 2 * look.unit; right: backup.left; rightMargin: 2 * look.unit; baseline: brand.baseline }
                    text: root.operating.rig + "   ·   " + root.operating.database
                    color: look.quiet
                    font.pixelSize: look.textSmall
                    elide: Text.ElideMiddle
                }
                BackupAge {
                    id: backup
                    anchors { right: parent.right; verticalCenter: parent.verticalCenter }
                    theme: look
                    texts: texts
                    age: root.operating.backup
                }
            }

            // An interrupted session is at the top, because the operator has most likely come to continue it.
            Rectangle {
                id: interrupted
                visible: says.text !== ""
                anchors { left: parent.left; right: parent.right; top: header.bottom; margins: look.margin; topMargin: visible ? root.gap : 0 }
                height: visible ? resume.height + 1.2 * look.unit : 0
                radius: look.radius
                color: look.raised
                border { color: look.action; width: look.stroke }
                PlainText {
                    id: says
                    objectName: "interruptedSession"
                    anchors { left: parent.left; right: resume.left; verticalCenter: parent.verticalCenter; margins: 1.2 * look.unit }
                    text: texts.interrupted(root.operating.interrupted)
                    color: look.ink
                    font { pixelSize: look.textBody; weight: Font.DemiBold }
                    elide: Text.ElideRight
                }
                ActionButton {
                    id: resume
                    objectName: "resume"
                    anchors { right: parent.right; verticalCenter: parent.verticalCenter; rightMargin: 0.6 * look.unit }
                    theme: look
                    enabled: !root.operating.preparing
                    text: texts.text("operator.resume")
                    onActivated: root.operating.resume()
                }
            }

            Item {
                id: body
                anchors { left: parent.left; right: parent.right; top: interrupted.bottom; bottom: footer.top; margins: look.margin; topMargin: root.gap; bottomMargin: root.gap }
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
                emptyText: texts.text("operator.no_protocols").arg(root.operating.folder)
                unusableText: texts.text("operator.study_bad")
                onChosen: index => root.operating.select(index)
            }

            Rectangle {
                id: summary
                x: root.tall || texts.mirrored ? body.x : list.x + list.width + root.gap
                y: root.tall ? list.y + list.height + root.gap : body.y
                width: root.tall ? body.width : body.width - list.width - root.gap
                height: body.y + body.height - y
                radius: look.radius
                color: look.raised
                border { color: look.line; width: 1 }
                PlainText {
                    visible: root.operating.checking
                    anchors.centerIn: parent
                    text: texts.text("operator.checking")
                    color: look.quiet
                    font.pixelSize: look.textBody
                }
                Flickable {
                    id: scroll
                    objectName: "summaryScroll"
                    anchors { fill: parent; margins: 1.4 * look.unit }
                    visible: !root.operating.checking
                    contentHeight: sheet.height
                    boundsBehavior: Flickable.StopAtBounds
                    clip: true
                    Column {
                        id: sheet
                        width: scroll.width
                        spacing: 1.1 * look.unit
                        Repeater {
                            model: root.operating.problems
                            Row {
                                id: problem
                                required property string modelData
                                width: sheet.width
                                spacing: 0.8 * look.unit
                                Glyph {
                                    id: sign
                                    height: 1.4 * look.textBody
                                    name: "alert"
                                    color: look.wrong
                                }
                                PlainText {
                                    width: parent.width - sign.width - parent.spacing
                                    text: problem.modelData
                                    color: look.wrong
                                    font { pixelSize: look.textSmall; weight: Font.DemiBold }
                                    wrapMode: Text.Wrap
                                }
                            }
                        }
                        // The session is refused, but the operator may overrule that with a reason.
                        Row {
                            objectName: "refusedAsEarly"
                            visible: root.tooEarly !== ""
                            width: sheet.width
                            spacing: 0.8 * look.unit
                            Glyph {
                                id: earlySign
                                height: 1.4 * look.textBody
                                name: "alert"
                                color: look.wrong
                            }
                            PlainText {
                                width: parent.width - earlySign.width - parent.spacing
                                text: root.tooEarly
                                color: look.wrong
                                font { pixelSize: look.textSmall; weight: Font.DemiBold }
                                wrapMode: Text.Wrap
                            }
                        }
                        ActionButton {
                            objectName: "beginEarly"
                            anchors.left: parent.left
                            visible: root.tooEarly !== ""
                            theme: look
                            enabled: root.operating.mayBegin
                            primary: false
                            danger: true
                            holdMs: 900
                            text: texts.text("operator.hold_early")
                            onActivated: early.open("")
                        }
                        FactTable {
                            width: parent.width
                            theme: look
                            heading: texts.text("operator.the_session")
                            facts: root.operating.facts
                            labelWidth: 0.32 * width
                        }
                        Column {
                            visible: root.operating.cues.length > 0
                            width: parent.width
                            spacing: 0.35 * look.unit
                            PlainText {
                                width: parent.width
                                text: texts.text("operator.cues")
                                color: look.action
                                font { pixelSize: look.textBody; weight: Font.Bold }
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
                                        height: 1.1 * look.textSmall
                                        name: "alert"
                                        color: look.wrong
                                    }
                                    PlainText {
                                        id: named
                                        anchors { left: parent.left; leftMargin: 1.8 * look.textSmall; right: parent.right }
                                        horizontalAlignment: Text.AlignLeft
                                        text: cue.modelData.name + ": " + cue.modelData.says
                                        color: cue.modelData.leaks ? look.wrong : look.quiet
                                        font { pixelSize: look.textSmall; weight: cue.modelData.leaks ? Font.DemiBold : Font.Normal }
                                        wrapMode: Text.Wrap
                                    }
                                }
                            }
                        }
                        Repeater {
                            model: root.operating.warnings
                            PlainText {
                                required property string modelData
                                width: sheet.width
                                text: modelData
                                color: look.ink
                                font.pixelSize: look.textSmall
                                wrapMode: Text.Wrap
                            }
                        }
                    }
                }
                ScrollCue { theme: look; place: scroll }
            }

            Item {
                id: footer
                anchors { left: parent.left; right: parent.right; bottom: parent.bottom; margins: look.margin }
                height: choices.height
                // The software renderer does not clip symbols that scroll out of the form above, so this strip covers
                // them.
                Rectangle {
                    anchors { fill: parent; topMargin: 1 - root.gap }
                    color: look.paper
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
                            leftPadding: texts.mirrored ? 2 * root.gap : 0
                            rightPadding: texts.mirrored ? 0 : 2 * root.gap
                            Caption { text: texts.text("operator.participant") }
                            Choice {
                                objectName: "askCode"
                                chosen: root.operating.participant === ""
                                text: texts.text("operator.types_code")
                                onActivated: root.operating.enterParticipant("")
                            }
                            Choice {
                                objectName: "enterCode"
                                chosen: root.operating.participant !== ""
                                text: root.operating.participant === "" ? texts.text("operator.enter_now") : texts.text(root.operating.participantKnown ? "operator.known" : "operator.new").arg(root.operating.participant)
                                onActivated: root.typing = true
                            }
                        }
                        Row {
                            spacing: root.gap
                            visible: root.operating.languages.length > 1
                            Caption { text: texts.text("operator.language") }
                            Choice {
                                objectName: "languageAsked"
                                chosen: root.operating.language < 0
                                text: texts.text("operator.asked")
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
                        height: wide ? look.controlHeight : ready.height + root.gap + begin.height
                        Flow {
                            id: ready
                            anchors.left: parent.left
                            width: last.wide ? parent.width - begin.width - root.gap : parent.width
                            spacing: root.gap
                            Row {
                                id: mode
                                spacing: root.gap
                                leftPadding: texts.mirrored ? root.gap : 0
                                rightPadding: texts.mirrored ? 0 : root.gap
                                Choice {
                                    objectName: "pilot"
                                    chosen: !root.operating.live
                                    text: texts.text("operator.pilot_run")
                                    onActivated: root.operating.setLive(false)
                                }
                                Choice {
                                    objectName: "live"
                                    chosen: root.operating.live
                                    text: texts.text("operator.live_run")
                                    onActivated: root.operating.setLive(true)
                                }
                            }
                            ActionButton {
                                id: arm
                                objectName: "arm"
                                theme: look
                                primary: root.operating.armed
                                quiet: !root.operating.armed
                                holdMs: root.operating.armed ? 0 : 900
                                glyph: root.operating.armed ? "tick" : ""
                                text: root.operating.armed ? texts.text("operator.armed") : texts.text("hold_to_arm")
                                onActivated: root.operating.setArmed(!root.operating.armed)
                            }
                        }
                        ActionButton {
                            id: begin
                            objectName: "begin"
                            anchors { right: parent.right; bottom: parent.bottom }
                            width: Math.max(implicitWidth, 18 * look.unit)
                            theme: look
                            enabled: root.operating.mayBegin
                            text: texts.text(root.operating.preparing ? "operator.preparing" : root.operating.live ? "operator.begin_live" : "operator.begin_pilot")
                            onActivated: root.operating.begin()
                        }
                    }
                }
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

    Rectangle {
        visible: root.typing
        anchors.fill: parent
        color: look.paper
        MouseArea { anchors.fill: parent }
        CodePage {
            id: codePage
            objectName: "operatorCode"
            anchors { fill: parent; margins: largeTheme.margin; bottomMargin: largeTheme.margin + (known.visible ? known.height + look.unit : 0) }
            theme: largeTheme
            texts: texts
            confirms: false
            title: texts.text("operator.code_title")
            help: texts.text("operator.code_help")
            onBack: root.typing = false
            onAccepted: code => {
                root.operating.enterParticipant(code)
                root.typing = false
            }
        }
        Flow {
            id: known
            visible: root.operating.participants.length > 0
            anchors { left: parent.left; right: parent.right; bottom: parent.bottom; margins: largeTheme.margin }
            height: look.controlHeight
            clip: true
            spacing: root.gap
            Repeater {
                model: root.operating.participants
                Choice {
                    required property string modelData
                    text: modelData
                    onActivated: {
                        root.operating.enterParticipant(modelData)
                        root.typing = false
                    }
                }
            }
        }
    }
}
