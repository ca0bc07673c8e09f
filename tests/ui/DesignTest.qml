import QtQuick
import QtTest

// A test of the designer of studies in the whole program, operated by taps. `taps` counts the taps. Its parent is the window.
PageTest {
    when: windowShown
    property int taps: 0
    readonly property var everySection: ["study", "question", "scenes", "levels", "blocks", "timing", "other"]

    function init() {
        failOnWarning(/Error/)
        taps = 0
        room.open("1234")
    }
    function cleanup() { room.close() }

    function shown(name) { return find(room.screen, name) !== null }
    function ready(name) {
        const item = find(room.screen, name)
        return item !== null && item.enabled && item.armed !== false
    }
    function appears(name) {
        tryVerify(() => ready(name), 20000, name)
        return find(room.screen, name)
    }
    /// Brings a control into view, as a person does with a finger, and returns it. Waits until it stands still
    /// there, because new fields get their positions a moment after they appear.
    function inView(name) {
        let last = Qt.point(-1, -1)
        tryVerify(() => {
            if (!ready(name)) return false
            const item = find(room.screen, name), scroll = find(room.screen, "formScroll")
            let inside = item
            while (inside && inside !== scroll) inside = inside.parent
            const y = inside ? item.mapToItem(scroll.contentItem, 0, 0).y : 0
            if (inside) scroll.contentY = Math.max(0, Math.min(y - 100, scroll.contentHeight - scroll.height))
            const at = item.mapToItem(null, 0, 0), still = at.x === last.x && at.y === last.y && item.height > 0
            last = at
            return still && at.y < parent.height
        }, 20000, name)
        return find(room.screen, name)
    }
    function tap(name, across = 0.5) {
        const item = inView(name)
        mouseClick(item, across * item.width, Math.min(item.height / 2, 15))
        ++taps
    }
    /// Returns the name of the item that shows a key, such as "stop.trials", of a table on the shown
    /// page.
    function field(key, table = 0) { return "field" + table + "-" + theField(key, table).index }
    function theField(key, table = 0) { return groupsNow()[table].fields.find(one => one.path.join(".") === key) }
    function valueOf(key, table = 0) { return theField(key, table).value }
    /// A copy of the tables of the page, because each look at the property itself makes all of them again.
    function groupsNow() { return JSON.parse(JSON.stringify(designPage().design.groups)) }
    function designPage() { return appears("designPage") }
    function tapField(key, table = 0) { tap(field(key, table), 0.8) }
    function keys(text) { for (const letter of text) tap("letter" + letter) }
    function type(text) {
        keys(text)
        tap("keepEntry")
    }
    function erase(count) { for (let i = 0; i < count; ++i) tap("erase") }
    function begin(goal, name) {
        tap("bar-studies")
        tap("newStudy")
        const goals = appears("goals")
        tryVerify(() => {
            goals.positionViewAtIndex(goals.model.findIndex(one => one.word === goal), GridView.Contain)
            return ready("goal-" + goal)
        }, 20000, goal)
        tap("goal-" + goal)
        type(name)
        appears("section-timing")
    }
    function saved(name) { return room.startOf("protocols", name + ".toml", 100000) }
}
