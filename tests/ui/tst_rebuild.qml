import QtQuick
import Turnpoint

// Shipped protocols are made again in the designer by taps, from an empty study.
Item {
    width: 1280
    height: 800

    DesignTest {
        name: "Rebuild"

        /// All pages of the form of a text, as {section: groups}.
        function formOf(text) {
            const design = designPage().design, form = {}
            design.setText(text)
            everySection.forEach((name, index) => {
                design.show(index)
                form[name] = JSON.parse(JSON.stringify(design.groups))  // a copy
            })
            design.undo()
            design.show(0)
            return form
        }
        /// Taps what gives a field this value.
        function give(key, table, value) {
            const one = theField(key, table)
            if (find(room.screen, field(key, table)) === null) tap("more" + table)
            if (one.kind === "boolean" || (one.kind === "word" && one.allowed.length <= 4)) return tap(field(key, table) + "-" + (value === "" ? one.value : value))
            tapField(key, table)
            if (one.kind === "word") return tap("suggestion-" + value)
            if (one.kind === "names" && one.allowed.length > 0) {
                const now = one.value === "" ? [] : one.value.split(", ")
                now.forEach(word => tap("suggestion-" + word))
                value.split(", ").forEach(word => tap("suggestion-" + word))
            } else {
                find(appears("fieldEntry"), "entry").text = value  // with a real keyboard
            }
            tap("keepEntry")
        }
        /// Does the first thing on this page that differs from the wanted groups. Returns false if nothing does.
        function oneStep(wanted) {
            const groups = groupsNow()
            for (let table = 0; table < groups.length; ++table) {
                const there = wanted[table].fields, own = groups[table].fields
                for (const one of own) {
                    const key = one.path.join("."), name = "field" + table + "-" + one.index
                    const other = there.find(two => two.path.join(".") === key && (two.kind === "list") === (one.kind === "list") && (two.kind === "table") === (one.kind === "table"))
                    const value = other?.present ? other.value : ""
                    if (one.kind === "entry") continue
                    if (one.kind === "table" && one.present === (other?.present ?? false)) continue
                    if (one.kind === "table" && one.present && !one.removable) continue
                    if (one.kind === "list" && Number(other?.value ?? 0) <= Number(one.value)) continue
                    if (one.kind === "table" || one.kind === "list") {
                        if (find(room.screen, name) === null) tap("more" + table)
                        tap(name + (one.present && one.kind === "table" ? "-remove" : "-add"))
                        return true
                    }
                    if (value === (one.present ? one.value : "") || (value === "" && one.required)) continue
                    give(key, table, value)
                    return true
                }
            }
            return false
        }
        function test_a_shipped_protocol_is_made_again_from_an_empty_study_data() {
            return [{ tag: "friction-2ifc" }, { tag: "magnitude-free" }]
        }
        function test_a_shipped_protocol_is_made_again_from_an_empty_study(data) {
            begin("empty", "again")
            const target = room.shipped(data.tag), wanted = formOf(target)
            tap("section-study")
            taps = 0
            for (let i = 0; i < 10 && oneStep(wanted.study); ++i) { /* the languages, among others */ }
            for (const section of everySection) {
                tap("section-" + section)
                for (const group of wanted[section].filter(one => one.name !== "")) {
                    tap("add-" + group.kind)
                    const groups = groupsNow()
                    give("name", groups.map(one => one.kind).lastIndexOf(group.kind), group.name)
                }
            }
            for (let round = 0; round < 3; ++round)
                for (const section of everySection) {
                    tap("section-" + section)
                    for (let i = 0; i < 300 && oneStep(wanted[section]); ++i) { /* the next one */ }
                }
            console.log(data.tag + ", taps besides keys: " + taps)
            compare(room.canonical(designPage().design.text), room.canonical(target))
            tap("section-blocks")
            compare(groupsNow().map(one => one.kind + " " + one.name), wanted.blocks.map(one => one.kind + " " + one.name))
            tryVerify(() => ["good", "warned"].includes(designPage().design.verdict), 60000)
        }
    }
}
