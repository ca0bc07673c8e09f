import QtQuick
import QtTest
import Turnpoint

// Every page as it is rendered: nothing faint, nothing cut off.
Item {
    id: stage
    width: 800
    height: 480

    ParticipantView {
        id: view
        anchors.fill: parent
        bridge: script.bridge
        pixelsPerMm: 5.2
    }
    Rectangle {
        id: control
        anchors.fill: parent
        visible: false
        color: "white"
        Text {
            id: sample
            property real cut: 0
            width: 300 - cut
            text: "faint or cut"
            font.pixelSize: 30
            color: "#777777"
            elide: Text.ElideRight
        }
    }

    TestCase {
        name: "Looks"
        when: windowShown

        SignalSpy { id: shown; target: script.bridge; signalName: "shown" }

        function test_what_is_faint_or_cut_is_found() {
            control.visible = true
            compare(inspector.texts(control), 1)
            compare(inspector.faintTexts(control, 7), ["faint or cut: 4.48"])
            compare(inspector.faintTexts(control, 4.4), [])
            sample.color = "#555555"
            compare(inspector.faintTexts(control, 7), [])
            compare(inspector.cutTexts(control), [])
            sample.cut = 200
            compare(inspector.cutTexts(control), ["faint or cut"])
            control.visible = false
        }

        function test_every_text_stands_out_by_seven_to_one_and_is_whole_data() {
            const rows = []
            for (const language of ["en", "de", "ja"])
                for (const page of script.pages) rows.push({ tag: page + " " + language, page: page, language: language })
            return rows
        }
        function test_every_text_stands_out_by_seven_to_one_and_is_whole(row) {
            const before = shown.count
            script.show(row.page, row.language)
            tryCompare(shown, "count", before + 1)
            compare(inspector.faintTexts(view, 7), [])
            compare(inspector.cutTexts(view), [])
        }
    }
}
