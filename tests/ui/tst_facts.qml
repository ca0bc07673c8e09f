import QtQuick
import QtTest
import Turnpoint

// Tests that a table of facts has its heading whenever something stands below it: facts, or only remarks.
Item {
    id: stage
    width: 400
    height: 300

    Theme { id: look; width: 800; height: 480; pixelsPerMm: 5.2; dense: true }
    Texts { id: words; language: "en" }
    FactTable {
        id: table
        width: parent.width
        theme: look
        texts: words
        heading: "Settings"
        facts: []
    }

    TestCase {
        name: "Facts"
        when: windowShown

        function shown() {
            const found = []
            for (let i = 0; i < table.children.length; ++i)
                if (table.children[i].visible && table.children[i].text !== undefined) found.push(table.children[i].text)
            return found
        }

        function test_a_heading_stands_above_remarks_without_facts() {
            compare(shown(), [])
            table.remarks = ["There are none."]
            compare(shown(), ["Settings", "\u2022 There are none."])
            table.remarks = []
            table.facts = [{ label: "Trials", value: "8" }]
            compare(shown(), ["Settings"])
        }
    }
}
