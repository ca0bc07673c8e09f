import QtTest

// A test that looks at a page as a person would: it finds only what is visible.
TestCase {
    /// Returns the first visible item below `parent` with this objectName, or null.
    function find(parent, name) {
        for (let i = 0; parent && i < parent.children.length; ++i) {
            const child = parent.children[i]
            if (!child.visible) continue
            const found = child.objectName === name ? child : find(child, name)
            if (found) return found
        }
        return null
    }
    /// Returns the texts of all visible items below `parent`, without the invisible characters that keep words together.
    function texts(parent) {
        let all = []
        for (let i = 0; parent && i < parent.children.length; ++i) {
            const child = parent.children[i]
            if (!child.visible) continue
            if (typeof child.text === "string") all.push(child.text.replace(/\u2060/g, "").trim())
            all = all.concat(texts(child))
        }
        return all
    }
    /// True if a visible text below `parent` contains the wanted words.
    function says(parent, wanted) {
        for (let i = 0; parent && i < parent.children.length; ++i) {
            const child = parent.children[i]
            if (!child.visible) continue
            if ((child.text ?? "").toString().includes(wanted) || says(child, wanted)) return true
        }
        return false
    }
}
