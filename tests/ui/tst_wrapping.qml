import QtQuick
import QtTest
import Turnpoint

// Tests on a small panel that the operator's pages break lines between words only, and that a name of a table of a
// study is shown whole.
Item {
    id: stage
    width: 800
    height: 480

    TestCase {
        name: "Wrapping"
        when: windowShown

        function init() {
            room.open("1234")
            room.addCells()
            const window = room.screen.Window.window
            window.width = 800
            window.height = 480
            window.pixelsPerMm = 5.2
        }
        function cleanup() { room.close() }

        function find(parent, name) {
            for (let i = 0; parent && i < parent.children.length; ++i) {
                const child = parent.children[i]
                if (!child.visible) continue
                const found = child.objectName === name ? child : find(child, name)
                if (found) return found
            }
            return null
        }
        function tap(name) {
            let button = null
            tryVerify(() => (button = find(room.screen, name)) !== null && button.enabled && button.armed !== false, 20000, name)
            wait(20)
            mouseClick(button, button.width / 2, button.height / 2)
        }
        /// Words that are broken, without names of files, keys and folders, which may be longer than a line.
        function broken(place) {
            wait(50)
            return inspector.brokenWords(room.screen).filter(word => !/[\/_.]/.test(word)).map(word => place + ": " + word)
        }

        function test_no_word_is_broken_on_the_operators_pages_data() {
            return ["en", "de", "es", "ar"].map(language => ({ tag: language }))
        }
        function test_no_word_is_broken_on_the_operators_pages(row) {
            room.look.language = row.tag
            let faults = []
            tryVerify(() => room.operating.mayBegin, 20000)
            faults = faults.concat(broken("run"))
            for (const place of ["studies", "sessions", "rig"]) {
                tap("bar-" + place)
                if (place === "studies") tryVerify(() => !find(room.screen, "studiesPage").studies.checking, 20000)
                faults = faults.concat(broken(place))
            }
            for (const tab of ["doctorTab", "selfTestTab", "weightsTab", "guideTab"]) {
                tap(tab)
                faults = faults.concat(broken(tab))
            }
            compare(faults.join("\n"), "")
        }
        function test_no_word_is_broken_in_the_form_of_a_study_data() {
            return ["en", "de", "es", "ar"].map(language => ({ tag: language }))
        }
        function test_no_word_is_broken_in_the_form_of_a_study(row) {
            room.look.language = row.tag
            tap("bar-studies")
            tryVerify(() => !find(room.screen, "studiesPage").studies.checking, 20000)
            tap("changeStudy")
            // So wide that the form and the check are just side by side: the form is narrowest then.
            const window = room.screen.Window.window
            for (window.width = 800; !find(room.screen, "designVerdict"); window.width += 10) wait(10)
            const design = find(room.screen, "designPage").design
            design.setText(design.text + "\n[resume]\nwarmup = 2\n")
            const faults = []
            for (let section = 0; section < 7; ++section) {
                design.show(section)
                wait(50)
                for (let i = 0; i < 6; ++i) {
                    if (find(room.screen, "more" + i)) find(room.screen, "more" + i).activated()
                    const title = find(room.screen, "title" + i)
                    if (title && title.truncated) faults.push("cut: " + title.text)
                }
                for (const word of broken(section)) faults.push(word)
            }
            compare(faults.join("\n"), "")
        }
    }
}
