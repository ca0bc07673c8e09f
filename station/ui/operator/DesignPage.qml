import QtQuick
import QtQuick.Window
import Turnpoint

// The designer of studies. It asks what to measure, and then shows a form with several pages. Beside the form it shows
// the result of the check or the text of the protocol file; on a small screen these are two more pages.
Rectangle {
    id: root
    required property DesignController design
    required property real pixelsPerMm
    readonly property bool wide: width > 150 * pixelsPerMm && width > 55 * look.textBody && width > height
    /// What stands beside the form: check, pages, precision or text. On a small screen, "" if the form is shown.
    property string beside: ""
    readonly property var besides: ["check", "pages", "precision", "text"]
    readonly property string other: beside === "" && wide ? "check" : beside
    /// For components, in which the name of the id would mean their own property.
    readonly property Texts phrases: texts
    property string goal
    property var edited: null
    signal closed()

    color: look.paper
    LayoutMirroring.enabled: texts.mirrored
    LayoutMirroring.childrenInherit: true

    Theme {
        id: look
        width: root.width
        height: root.height
        pixelsPerMm: root.pixelsPerMm
        dense: true
    }
    Texts { id: texts; language: OperatorScreen.language }
    Binding {
        target: root.design
        property: "language"
        value: OperatorScreen.language
    }

    function trouble() : string {
        return design.trouble === "taken" ? texts.fill("design.taken", naming.wanted) : design.trouble === "name" ? texts.text("design.name_of_study")
            : design.trouble === "on_disk" ? texts.text("design.on_disk_title") : texts.say(design.trouble)
    }
    function nameIt(wish: string, title: string, text: string) {
        naming.wish = wish
        naming.title = texts.text(title)
        naming.refused = ""
        naming.open(text)
    }
    function leave() {
        if (design.unsaved) leaving.open()
        else closed()
    }

    DesignGoals {
        anchors.fill: parent
        visible: root.design.stage === "goals"
        theme: look
        texts: texts
        goals: visible ? root.design.goals(OperatorScreen.language) : []
        onClosed: root.closed()
        onChosen: word => {
            root.goal = word
            root.nameIt("make", "design.name_of_study", root.design.suggested)
        }
    }
    Item {
        id: page
        anchors { fill: parent; margins: look.margin }
        visible: root.design.stage === "form"
        PlainText {
            id: title
            anchors { left: parent.left; top: parent.top; right: buttons.left; rightMargin: look.unit }
            height: 0.6 * look.controlHeight
            text: root.design.name
            color: look.ink
            font { pixelSize: look.textTitle; weight: Font.Bold }
            horizontalAlignment: Text.AlignLeft   // on the right in a mirrored page, though the name is Latin
            verticalAlignment: Text.AlignVCenter
            elide: Text.ElideRight
        }
        PlainText {
            objectName: "designState"
            anchors { left: title.left; right: title.right; top: title.bottom }
            height: 0.4 * look.controlHeight
            text: root.design.trouble !== "" && !naming.visible && !entry.visible ? root.trouble() : root.design.unsaved ? texts.text("design.unsaved")
                : root.design.savedAs !== "" ? texts.fill("design.saved", root.design.savedAs) : ""
            color: root.design.trouble !== "" ? look.wrong : look.quiet
            font.pixelSize: look.textSmall
            elide: Text.ElideMiddle
        }
        Row {
            id: buttons
            anchors { right: parent.right; top: parent.top }
            spacing: Math.round(0.5 * look.unit)
            ActionButton { objectName: "undo"; theme: look; primary: false; quiet: true; enabled: root.design.canUndo; text: texts.text("design.undo"); onActivated: root.design.undo() }
            ActionButton { objectName: "redo"; theme: look; primary: false; quiet: true; enabled: root.design.canRedo; text: texts.text("design.redo"); onActivated: root.design.redo() }
            ActionButton { objectName: "saveAs"; theme: look; primary: false; text: texts.text("design.save_as"); onActivated: root.nameIt("save", "design.name_of_study", root.design.name) }
            ActionButton { objectName: "save"; theme: look; enabled: root.design.unsaved; text: texts.text("design.save"); onActivated: root.save() }
            ActionButton { objectName: "closeDesign"; theme: look; primary: false; text: texts.close; onActivated: root.leave() }
        }
        Flickable {
            id: tabs
            anchors { left: parent.left; top: buttons.bottom; bottom: parent.bottom; topMargin: look.unit }
            width: Math.max(11 * look.unit, 9 * look.textBody)
            contentHeight: list.height
            boundsBehavior: Flickable.StopAtBounds
            clip: true
            Column {
                id: list
                width: tabs.width
                spacing: Math.round(0.4 * look.unit)
                Repeater {
                    model: root.design.sections
                    ActionButton {
                        required property var modelData
                        required property int index
                        objectName: "section-" + modelData.name
                        width: list.width
                        theme: look
                        readonly property bool shown: root.design.section === index && (root.wide || root.beside === "")
                        primary: shown
                        quiet: !shown
                        danger: modelData.problems > 0
                        text: (modelData.problems > 0 ? "✗ " : "") + root.sectionName(modelData.name)
                        onActivated: {
                            if (!root.wide) root.beside = ""
                            root.design.show(index)
                        }
                    }
                }
                Repeater {
                    model: root.wide ? [] : root.besides
                    ActionButton {
                        required property string modelData
                        objectName: "side-" + modelData
                        width: list.width
                        theme: look
                        primary: root.other === modelData
                        quiet: root.other !== modelData
                        text: root.besideName(modelData)
                        onActivated: root.beside = modelData
                    }
                }
            }
        }
        DesignForm {
            id: form
            anchors { left: tabs.right; top: tabs.top; bottom: parent.bottom; leftMargin: look.unit }
            visible: root.wide || root.beside === ""
            width: (root.wide ? 0.6 : 1) * (page.width - tabs.width - look.unit)
            theme: look
            texts: texts
            design: root.design
            onEditWanted: (group, field) => {
                root.edited = { group: group, field: field }
                entry.refused = ""
                // a word of the file is not typed, but chosen
                entry.open(field.kind === "expression" && field.allowed.includes(field.value) && entry.said(field.value) !== field.value ? "" : field.value)
            }
            onCopyWanted: group => {
                root.edited = { group: group }
                root.nameIt("copy", "design.name_of_copy", "")
            }
        }
        Item {
            id: side
            anchors { left: root.wide ? form.right : tabs.right; right: parent.right; top: tabs.top; bottom: parent.bottom; leftMargin: look.unit }
            visible: root.other !== ""
            Flow {
                id: sides
                anchors { left: parent.left; right: parent.right }
                visible: root.wide
                spacing: Math.round(0.5 * look.unit)
                Repeater {
                    model: root.wide ? root.besides : []
                    ChoiceButton {
                        required property string modelData
                        objectName: "side-" + modelData
                        theme: look
                        chosen: root.other === modelData
                        text: root.besideName(modelData)
                        onActivated: root.beside = modelData
                    }
                }
            }
            DesignChecks {
                anchors { fill: parent; topMargin: sides.visible ? sides.height + Math.round(0.5 * look.unit) : 0 }
                visible: root.other === "check"
                theme: look
                texts: texts
                design: root.design
                onRemarkChosen: index => {
                    const line = root.design.remarks[index].line
                    if (root.design.goTo(index)) {
                        if (!root.wide) root.beside = ""
                    } else if (line > 0) {  // nothing in the form: the text, at this line
                        root.beside = "text"
                        text.item.goTo(line)
                    }
                }
            }
            Loader {
                id: text
                anchors { fill: parent; topMargin: sides.visible ? sides.height + Math.round(0.5 * look.unit) : 0 }
                active: root.other === "text"
                sourceComponent: DesignText { theme: look; texts: root.phrases; design: root.design }
            }
            Loader {
                anchors { fill: parent; topMargin: sides.visible ? sides.height + Math.round(0.5 * look.unit) : 0 }
                active: root.other === "pages"
                sourceComponent: DesignPreview {
                    theme: look
                    texts: root.phrases
                    pages: root.design.pages
                    here: Qt.size(Screen.width, Screen.height)
                    stale: root.design.timeline.length === 0
                }
            }
            DesignPrecision {
                anchors { fill: parent; topMargin: sides.visible ? sides.height + Math.round(0.5 * look.unit) : 0 }
                visible: root.other === "precision"
                theme: look
                texts: texts
                precision: root.design.precision
                Binding {
                    target: root.design.precision
                    property: "watched"
                    value: root.visible && root.other === "precision"
                }
            }
        }
    }
    EntryDialog {
        id: entry
        objectName: "fieldEntry"
        anchors.fill: parent
        theme: look
        readonly property var field: root.edited?.field ?? null
        title: field === null ? "" : field.kind === "entry" ? texts.text("design.add_entry")
            : field.kind === "listName" ? texts.text("design.add_parts") : root.design.label(field.title, texts.language)
        help: texts.say(field?.help ?? "")
        suggestions: field?.allowed ?? []
        sayings: suggestions.reduce((said, word) => Object.assign(said, { [word]: root.design.word(field?.key ?? "", word, texts.language) }), {})
        pick: suggestions.length > 0 && field.kind === "word"
        list: field?.list ?? false
        closed: field?.closed ?? false
        numbers: field?.kind === "number"
        sentences: !numbers
        lines: field?.kind === "text"
        emptyAllowed: root.edited?.field ? !root.edited.field.required : false
        keepText: texts.text("design.use")
        cancelText: texts.text("operator.cancel")
        unsetText: texts.text("design.not_set")
        onAccepted: text => {
            if (root.design.change(root.edited.group, root.edited.field.index, text)) return
            entry.refused = root.trouble()
            entry.open(text)
        }
    }
    EntryDialog {
        id: naming
        property string wish
        property string wanted
        objectName: "naming"
        anchors.fill: parent
        theme: look
        keepText: texts.text("design.use")
        cancelText: texts.text("operator.cancel")
        onAccepted: text => {
            wanted = text
            if (wish === "make" ? root.design.make(root.goal, text) : wish === "save" ? root.design.save(text) : root.design.copy(root.edited.group, text)) return
            refused = root.trouble()
            open(text)
        }
    }
    ConfirmDialog {
        id: leaving
        objectName: "leaving"
        anchors.fill: parent
        theme: look
        texts: texts
        title: texts.text("design.leave_title")
        text: texts.text("design.leave_text")
        keepText: texts.text("design.leave_keep")
        confirmText: texts.text("design.leave_do")
        onConfirmed: root.closed()
    }

    ConfirmDialog {
        id: onDisk
        objectName: "onDisk"
        anchors.fill: parent
        theme: look
        texts: texts
        title: texts.text("design.on_disk_title")
        text: texts.fill("design.on_disk_text", root.design.name)
        keepText: texts.text("design.on_disk_load")
        confirmText: texts.text("design.on_disk_overwrite")
        onKept: root.design.reload()
        onConfirmed: root.design.overwrite()
    }

    // Lies on top and sees every finger on the page, but leaves it to the control below.
    Item {
        anchors.fill: parent
        PointHandler { onActiveChanged: root.design.touched = active }
    }
    Component.onDestruction: {
        design.touched = false
        design.precision.watched = false
    }

    function save() {
        if (!design.save("") && design.trouble === "on_disk") onDisk.open()
    }
    function besideName(name: string) : string {
        return name === "check" ? texts.text("design.check") : name === "pages" ? texts.text("design.pages")
            : name === "precision" ? texts.text("design.precision") : texts.text("design.text")
    }
    function sectionName(name: string) : string {
        return name === "study" ? texts.text("design.study") : name === "question" ? texts.text("design.question") : name === "scenes" ? texts.text("design.scenes")
            : name === "levels" ? texts.text("design.levels") : name === "blocks" ? texts.text("design.blocks") : name === "timing" ? texts.text("design.timing") : texts.text("design.other")
    }
}
