import QtQuick
import Turnpoint

// The list of stored sessions with a search field, and buttons for what can be done with the chosen session.
Rectangle {
    id: root
    required property SessionsController sessions
    required property real pixelsPerMm
    readonly property bool tall: height > width
    readonly property bool some: (sessions.chosen.id ?? "") !== ""
    signal resumeWanted(id: string)

    color: look.paper
    Component.onCompleted: sessions.open()

    Theme {
        id: look
        width: root.width
        height: root.height
        pixelsPerMm: root.pixelsPerMm
        dense: true
    }
    Texts { id: texts; language: OperatorScreen.language }

    Connections {
        target: root.sessions
        function onPlanned() { withdrawing.open() }
    }

    Item {
        id: left
        anchors { left: parent.left; top: parent.top; margins: look.margin }
        width: root.tall ? root.width - 2 * look.margin : 0.42 * root.width
        height: root.tall ? 0.42 * root.height : root.height - 2 * look.margin
        ActionButton {
            id: find
            objectName: "search"
            anchors { left: parent.left; right: clear.visible ? clear.left : parent.right; top: parent.top; rightMargin: clear.visible ? look.unit : 0 }
            theme: look
            primary: false
            text: root.sessions.search === "" ? texts.text("operator.search") : "“" + root.sessions.search + "”"
            onActivated: searching.open(root.sessions.search)
        }
        ActionButton {
            id: clear
            objectName: "clearSearch"
            visible: root.sessions.search !== ""
            anchors { right: parent.right; top: parent.top }
            theme: look
            primary: false
            quiet: true
            glyph: "cross"
            label: texts.text("operator.show_all")
            onActivated: root.sessions.search = ""
        }
        Flow {
            id: orders
            anchors { left: parent.left; right: parent.right; top: find.bottom; topMargin: look.unit }
            spacing: Math.round(0.6 * look.unit)
            ChoiceButton { objectName: "byDate"; theme: look; chosen: root.sessions.order === "newest"; text: texts.text("operator.by_date"); onActivated: root.sessions.order = "newest" }
            ChoiceButton { objectName: "byStudy"; theme: look; chosen: root.sessions.order === "study"; text: texts.text("operator.by_study"); onActivated: root.sessions.order = "study" }
            ChoiceButton { objectName: "byParticipant"; theme: look; chosen: root.sessions.order === "participant"; text: texts.text("operator.by_participant"); onActivated: root.sessions.order = "participant" }
        }
        Rectangle {
            anchors { left: parent.left; right: parent.right; top: orders.bottom; bottom: parent.bottom; topMargin: look.unit }
            radius: look.radius
            color: look.raised
            border { color: look.line; width: 1 }
            PlainText {
                objectName: "noSessions"
                visible: list.count === 0
                anchors { fill: parent; margins: Math.round(1.4 * look.unit) }
                text: root.sessions.unreadable ? texts.text("operator.sessions_unread") : root.sessions.total === 0 ? texts.text("operator.no_sessions") : texts.text("operator.none_found")
                color: look.ink
                font.pixelSize: look.textBody
                wrapMode: Text.Wrap
            }
            ListView {
                id: list
                objectName: "sessions"
                anchors { fill: parent; margins: Math.round(0.5 * look.unit) }
                clip: true
                boundsBehavior: Flickable.StopAtBounds
                spacing: Math.round(0.3 * look.unit)
                model: root.sessions.sessions
                delegate: Column {
                    id: line
                    required property var modelData
                    required property int index
                    width: list.width
                    PlainText {
                        visible: line.modelData.heading !== ""
                        width: parent.width
                        topPadding: line.index > 0 ? look.unit : 0
                        leftPadding: Math.round(0.9 * look.unit)
                        text: line.modelData.heading
                        color: look.action
                        font { pixelSize: look.textSmall; weight: Font.Bold }
                        elide: Text.ElideRight
                    }
                    Rectangle {
                        id: row
                        readonly property var modelData: line.modelData
                        readonly property int index: line.index
                        readonly property bool chosen: index === root.sessions.selected
                        objectName: "session" + index
                        width: parent.width
                        height: Math.max(look.controlHeight, words.implicitHeight + look.unit)
                        radius: look.radius
                        color: chosen ? look.action : look.raised
                        Accessible.role: Accessible.ListItem
                        Accessible.name: modelData.person + ", " + modelData.protocol + ", " + modelData.started
                        Accessible.selected: chosen
                        Accessible.onPressAction: root.sessions.select(index)
                        activeFocusOnTab: true
                        Keys.onSpacePressed: root.sessions.select(index)
                        Keys.onReturnPressed: root.sessions.select(index)
                        border { color: look.ink; width: activeFocus ? look.stroke : 0 }
                        Column {
                            id: words
                            anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter; margins: Math.round(0.9 * look.unit) }
                            PlainText {
                                readAloud: false
                                width: parent.width
                                text: row.modelData.person + "   ·   " + row.modelData.protocol
                                color: row.chosen ? look.actionText : look.ink
                                font { pixelSize: look.textBody; weight: Font.DemiBold }
                                elide: Text.ElideRight
                            }
                            PlainText {
                                readAloud: false
                                width: parent.width
                                text: row.modelData.started + "   ·   " + texts.named(row.modelData.mode) + "   ·   " + texts.named(row.modelData.status)
                                color: row.chosen ? look.actionText : look.quiet
                                font.pixelSize: look.textSmall
                                elide: Text.ElideRight
                            }
                        }
                        TapHandler { onTapped: root.sessions.select(row.index) }
                    }
                }
            }
            ScrollCue { theme: look; place: list }
        }
    }
    OperatorCard {
        id: card
        anchors { left: root.tall ? parent.left : left.right; right: parent.right; top: root.tall ? left.bottom : parent.top; bottom: footer.top; margins: look.margin; topMargin: root.tall ? look.unit : look.margin; bottomMargin: look.unit; leftMargin: root.tall ? look.margin : look.unit }
        theme: look
        heading: root.some ? root.sessions.chosen.person : ""
        PlainText {
            objectName: "said"
            visible: text !== ""
            width: card.inner
            text: root.sessions.busy ? texts.text("operator.working") : texts.say(root.sessions.said)
            color: root.sessions.failed ? look.wrong : look.ink
            font { pixelSize: look.textBody; weight: Font.DemiBold }
            wrapMode: Text.Wrap
        }
        Flow {
            visible: !root.sessions.busy
            width: card.inner
            spacing: look.unit
            Repeater {
                model: root.sessions.places
                ActionButton {
                    required property var modelData
                    required property int index
                    objectName: "eject" + index
                    visible: modelData.disk && modelData.mounted
                    theme: look
                    primary: false
                    text: texts.fill("operator.eject", modelData.name)
                    onActivated: root.sessions.eject(index)
                }
            }
        }
        FactTable {
            visible: root.some
            width: card.inner
            theme: look
            texts: texts
            labelShare: 0.34
            facts: root.some ? [{ label: texts.text("operator.protocol"), value: root.sessions.chosen.protocol },
                                { label: texts.text("operator.started"), value: root.sessions.chosen.started },
                                { label: texts.text("operator.mode"), value: texts.named(root.sessions.chosen.mode) },
                                { label: texts.text("operator.status"), value: texts.named(root.sessions.chosen.status) + (texts.say(root.sessions.chosen.reason) === "" ? "" : ": " + texts.say(root.sessions.chosen.reason)) },
                                { label: texts.text("operator.trials"), value: String(root.sessions.chosen.trials) },
                                { label: "ID", value: root.sessions.chosen.id }] : []
        }
        Repeater {
            model: root.sessions.notes
            PlainText {
                required property string modelData
                width: card.inner
                text: "• " + modelData
                color: look.ink
                font.pixelSize: look.textBody
                wrapMode: Text.Wrap
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
                objectName: "resumeThis"
                visible: root.sessions.chosen.resumable ?? false
                enabled: !root.sessions.busy
                theme: look
                text: texts.text("operator.resume")
                onActivated: root.resumeWanted(root.sessions.chosen.id)
            }
            ActionButton {
                objectName: "makeReport"
                enabled: root.some && !root.sessions.busy && root.sessions.chosen.trials > 0
                theme: look
                primary: false
                text: texts.text("operator.report")
                onActivated: {
                    root.sessions.makeReport(OperatorScreen.language)
                    reporting.wanted = true
                }
            }
            ActionButton {
                objectName: "addNote"
                enabled: root.some && !root.sessions.busy
                theme: look
                primary: false
                text: texts.text("operator.note")
                onActivated: noting.open("")
            }
            ActionButton {
                objectName: "export"
                enabled: root.some && !root.sessions.busy
                theme: look
                primary: false
                text: texts.text("operator.export")
                onActivated: exporting.open()
            }
            ActionButton {
                objectName: "backUp"
                enabled: root.sessions.total > 0 && !root.sessions.busy
                theme: look
                primary: false
                text: texts.text("operator.back_up")
                onActivated: backing.open()
            }
            ActionButton {
                objectName: "withdraw"
                enabled: root.some && !root.sessions.busy
                theme: look
                primary: false
                danger: true
                text: texts.text("operator.withdraw")
                onActivated: root.sessions.planWithdrawal()
            }
        }
    }

    EntryDialog {
        id: searching
        objectName: "searching"
        anchors.fill: parent
        theme: look
        emptyAllowed: true
        title: texts.text("operator.search_title")
        keepText: texts.text("operator.search")
        cancelText: texts.text("operator.show_all")
        help: texts.fill("operator.found", list.count, root.sessions.total)
        onTyped: text => root.sessions.search = text
        onCancelled: root.sessions.search = ""
        onAccepted: text => root.sessions.search = text
    }
    EntryDialog {
        id: noting
        objectName: "noting"
        anchors.fill: parent
        theme: look
        title: texts.text("operator.note_title")
        keepText: texts.text("operator.keep_note")
        cancelText: texts.text("operator.cancel")
        onAccepted: text => root.sessions.annotate(text)
    }
    PlaceDialog {
        id: exporting
        objectName: "exporting"
        anchors.fill: parent
        theme: look
        texts: texts
        sessions: root.sessions
        exporting: true
        title: texts.text("operator.export_where")
        onChosen: place => root.sessions.exportTo(place, what, format)
    }
    PlaceDialog {
        id: backing
        objectName: "backing"
        anchors.fill: parent
        theme: look
        texts: texts
        sessions: root.sessions
        title: texts.text("operator.back_up_where")
        onChosen: place => root.sessions.backUpTo(place)
    }
    ConfirmDialog {
        id: withdrawing
        objectName: "withdrawing"
        anchors.fill: parent
        theme: look
        texts: texts
        holdMs: 1500
        title: texts.fill("operator.withdraw_title", root.sessions.chosen.person ?? "")
        text: texts.say(root.sessions.consequence) + "\n" + texts.text("operator.withdraw_text")
        keepText: texts.text("operator.withdraw_keep")
        confirmText: texts.text("operator.withdraw_do")
        onConfirmed: root.sessions.withdraw()
    }
    Loader {
        id: reporting
        property bool wanted: false
        anchors.fill: parent
        active: wanted && (root.sessions.report.ready || root.sessions.busy)
        sourceComponent: ReportPage {
            objectName: "storedReport"
            report: root.sessions.report
            runMode: root.sessions.chosen.mode ?? ""
            pixelsPerMm: root.pixelsPerMm
            onClosed: reporting.wanted = false
        }
    }
}
