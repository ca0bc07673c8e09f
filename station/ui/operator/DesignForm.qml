import QtQuick
import Turnpoint

// One page of the form of a study: tables of the protocol file, with their fields.
Rectangle {
    id: root
    required property Theme theme
    required property Texts texts
    required property DesignController design
    /// The tables that show all possible settings, including those that are not in the file.
    property var opened: ({})
    property var pointed: null
    signal editWanted(group: int, field: var)
    signal copyWanted(group: int)

    radius: theme.radius
    color: theme.raised
    border { color: theme.line; width: 1 }

    function toggle(name: string) {
        const next = Object.assign({}, opened)
        next[name] = !next[name]
        opened = next
    }
    function find(parent: Item, name: string) : Item {
        for (let i = 0; i < parent.children.length; ++i) {
            const found = parent.children[i].objectName === name ? parent.children[i] : find(parent.children[i], name)
            if (found) return found
        }
        return null
    }
    /// Scrolls to a field, or to the table if the field is -1.
    function point(group: int, field: int) {
        const groups = design.groups
        if (field >= 0 && !groups[group].fields[field].present) opened = Object.assign({}, opened, { [groups[group].kind + groups[group].name]: true })
        pointed = { group: group, field: field }
        const item = find(sheet, field < 0 ? "group" + group : "field" + group + "-" + field)
        if (item) scrollTo(item.mapToItem(sheet, 0, 0).y - theme.controlHeight)
    }
    /// follow() rebuilds the tables if they have changed. It keeps the scroll position, unless another page was
    /// chosen.
    property string last
    property int section: -1
    function follow() {
        const next = JSON.stringify(design.groups)
        if (next === last) return
        const y = section === design.section ? scroll.contentY : 0
        last = next
        section = design.section
        tables.model = design.groups
        settling.y = y
        settling.place = null
        settling.restart()
    }
    /// Scrolls a moment later, when new fields have their positions. Only the last request counts.
    Timer {
        id: settling
        property real y
        /// {group, field} to scroll to instead of y
        property var place: null
        interval: 1
        onTriggered: {
            if (place) root.point(place.group, place.field)
            else root.scrollTo(y)
        }
    }
    function scrollTo(y: real) { scroll.contentY = Math.max(0, Math.min(y, sheet.height - scroll.height)) }
    Component.onCompleted: follow()
    Connections {
        target: root.design
        function onChanged() { root.follow() }
        function onReached(group: int, field: int) {
            settling.place = { group: group, field: field }
            settling.restart()
        }
    }
    Flickable {
        id: scroll
        objectName: "formScroll"
        anchors { fill: parent; margins: Math.round(1.2 * root.theme.unit) }
        contentHeight: sheet.height
        boundsBehavior: Flickable.StopAtBounds
        clip: true
        Column {
            id: sheet
            width: scroll.width
            spacing: Math.round(1.6 * root.theme.unit)
            DesignTimeline {
                objectName: "timeline"
                visible: root.design.sections[root.design.section]?.name === "timing" && parts.length > 0
                width: sheet.width
                theme: root.theme
                texts: root.texts
                design: root.design
            }
            DesignCards {
                objectName: "cards"
                visible: parts.length > 0
                width: sheet.width
                theme: root.theme
                texts: root.texts
                design: root.design
                parts: root.design.sections[root.design.section]?.name === "blocks" ? tables.model ?? [] : []
                view: scroll
                onChosen: group => root.point(group, -1)
            }
            Repeater {
                id: tables
                Column {
                    id: table
                    required property var modelData
                    required property int index
                    readonly property string key: modelData.kind + modelData.name
                    readonly property bool all: root.opened[key] ?? false
                    readonly property int absent: modelData.fields.filter(field => !field.present && !field.required).length
                    objectName: "group" + index
                    width: sheet.width
                    spacing: Math.round(0.6 * root.theme.unit)
                    // the buttons stand beside the title, or below it if a word of it would be broken there
                    Item {
                        id: head
                        readonly property real natural: {
                            let sum = 0
                            for (let i = 0; i < tools.children.length; ++i) sum += tools.children[i].visible && tools.children[i].width > 0 ? tools.children[i].width + tools.spacing : 0
                            return sum
                        }
                        readonly property bool beside: natural + words.width + root.theme.unit <= width
                        width: parent.width
                        height: beside ? Math.max(title.height, tools.height) : title.height + (natural > 0 ? tools.spacing + tools.height : 0)
                        TextMetrics {
                            id: words
                            font: title.font
                            text: title.text
                        }
                        PlainText {
                            id: title
                            objectName: "title" + table.index
                            anchors.left: parent.left
                            y: head.beside ? Math.round((head.height - height) / 2) : 0
                            width: head.beside ? head.width - head.natural - root.theme.unit : head.width
                            text: root.design.label([table.modelData.kind], root.texts.language) + (table.modelData.name === "" ? "" : "  “" + table.modelData.name + "”")
                            color: root.theme.action
                            font { pixelSize: root.theme.textTitle; weight: Font.Bold }
                            wrapMode: Text.Wrap
                        }
                        Flow {
                            id: tools
                            anchors.right: parent.right
                            y: head.beside ? Math.round((head.height - height) / 2) : head.height - height
                            width: Math.min(head.natural, head.width)
                            spacing: Math.round(0.5 * root.theme.unit)
                            Repeater {
                                model: [{ name: "earlier", word: "design.earlier" }, { name: "later", word: "design.later" }]
                                ActionButton {
                                    required property var modelData
                                    objectName: modelData.name + table.index
                                    visible: table.modelData.earlier || table.modelData.later
                                    enabled: table.modelData[modelData.name]
                                    theme: root.theme
                                    primary: false
                                    quiet: true
                                    text: root.texts.text(modelData.word)
                                    onActivated: root.design.move(table.index, modelData.name === "earlier")
                                }
                            }
                            ActionButton {
                                objectName: "copy" + table.index
                                visible: table.modelData.copied
                                theme: root.theme
                                primary: false
                                quiet: true
                                text: root.texts.text("design.copy")
                                onActivated: root.copyWanted(table.index)
                            }
                            ActionButton {
                                objectName: "remove" + table.index
                                visible: table.modelData.removable
                                theme: root.theme
                                primary: false
                                quiet: true
                                text: root.texts.text("design.remove")
                                onActivated: root.design.remove(table.index)
                            }
                        }
                    }
                    Repeater {
                        model: table.modelData.remarks
                        PlainText {
                            required property var modelData
                            width: table.width
                            text: (modelData.kind === "problem" ? "✗ " : "! ") + root.texts.say(modelData.what) + (modelData.hint === "" ? "" : " " + root.texts.arrow + root.texts.say(modelData.hint))
                            color: modelData.kind === "problem" ? root.theme.wrong : root.theme.quiet
                            font.pixelSize: root.theme.textSmall
                            wrapMode: Text.Wrap
                        }
                    }
                    Loader {
                        width: parent.width
                        active: table.modelData.boundary >= 0 || table.modelData.zone >= 0
                        visible: active
                        sourceComponent: DesignStrip {
                            objectName: "strip" + table.index
                            theme: root.theme
                            texts: root.texts
                            surface: root.design.surface
                            boundaryMm: table.modelData.boundary < 0 ? -1 : Number(table.modelData.fields[table.modelData.boundary].value)
                            zoneMm: table.modelData.zone < 0 ? -1 : Number(table.modelData.fields[table.modelData.zone].value)
                            profile: root.design.profiles[table.modelData.name]
                            onMoved: (which, mm) => root.design.change(table.index, which === "zone" ? table.modelData.zone : table.modelData.boundary, mm.toFixed(1))
                        }
                    }
                    Loader {
                        width: parent.width
                        active: table.modelData.kind === "scene" && table.modelData.present
                        visible: active
                        sourceComponent: DesignFeel {
                            theme: root.theme
                            texts: root.texts
                            feeling: root.design.feeling
                            scene: table.modelData.name
                        }
                    }
                    Repeater {
                        model: table.modelData.fields.filter(field => field.present || field.required || table.all || field.remarks.length > 0)
                        DesignField {
                            required property var modelData
                            objectName: "field" + table.index + "-" + modelData.index
                            x: Math.min(modelData.indent, 4) * root.theme.unit * (root.texts.mirrored ? 0 : 1)
                            width: table.width - Math.min(modelData.indent, 4) * root.theme.unit
                            theme: root.theme
                            texts: root.texts
                            design: root.design
                            field: modelData
                            pointedAt: root.pointed !== null && root.pointed.group === table.index && root.pointed.field === modelData.index
                            onEditWanted: root.editWanted(table.index, modelData)
                            onPicked: word => root.design.change(table.index, modelData.index, word)
                            onExtended: root.design.extend(table.index, modelData.index)
                            onReduced: root.design.reduce(table.index, modelData.index)
                            onMovedUp: root.design.moveUp(table.index, modelData.index)
                        }
                    }
                    ActionButton {
                        objectName: "more" + table.index
                        visible: table.absent > 0
                        theme: root.theme
                        primary: false
                        quiet: true
                        glyph: table.all ? "minus" : "plus"
                        text: root.texts.text(table.all ? "design.fewer" : "design.more")
                        onActivated: root.toggle(table.key)
                    }
                }
            }
            Flow {
                width: sheet.width
                spacing: Math.round(0.5 * root.theme.unit)
                Repeater {
                    model: root.design.sections[root.design.section]?.added ?? []
                    ActionButton {
                        required property string modelData
                        objectName: "add-" + modelData
                        theme: root.theme
                        primary: false
                        glyph: "plus"
                        text: root.design.label([modelData], root.texts.language)
                        label: root.texts.fill("design.add_named", text)
                        onActivated: root.design.add(modelData)
                    }
                }
            }
        }
    }
    ScrollCue { theme: root.theme; place: scroll }
}
