import QtTest

// A test that looks at a page as a person would: it finds only what is visible.
TestCase {
    /// Returns all visible items below `parent` that are wanted, each before those below it.
    function all(parent, wanted) {
        let found = []
        for (let i = 0; parent && i < parent.children.length; ++i) {
            const child = parent.children[i]
            if (!child.visible) continue
            if (wanted(child)) found.push(child)
            found = found.concat(all(child, wanted))
        }
        return found
    }
    /// Returns all visible items below `parent` with this objectName.
    function named(parent, name) { return all(parent, item => item.objectName === name) }
    /// Returns the first visible item below `parent` with this objectName, or null.
    function find(parent, name) { return named(parent, name)[0] ?? null }
    /// Returns the texts of all visible items below `parent`, without the invisible characters that keep words together.
    function texts(parent) {
        return all(parent, item => typeof item.text === "string").map(item => item.text.replace(/\u2060/g, "").trim())
    }
    /// True if a visible text below `parent` contains the wanted words.
    function says(parent, wanted) { return all(parent, item => (item.text ?? "").toString().includes(wanted)).length > 0 }
}
