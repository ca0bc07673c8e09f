import QtQuick
import QtTest
import Turnpoint

// Tests that a screen reader finds every control of every page with its role and a name: what reacts to a touch is a
// button, a tab, an item of a list, a text to edit or a slider, and has a name in words. Qt gives the same roles and
// names to AT-SPI.
Item {
    id: stage
    width: 1280
    height: 800

    ParticipantView {
        id: view
        anchors.fill: parent
        visible: false
        bridge: script.bridge
        pixelsPerMm: 5.9
    }
    Theme { id: large; width: stage.width; height: stage.height; pixelsPerMm: 5.9 }
    Texts { id: words; language: "de" }
    Item {
        id: control
        visible: false
        width: 100
        height: 100
        Item {
            width: 50
            height: 50
            MouseArea { anchors.fill: parent }
        }
        Shield {}
    }
    Loader {
        id: page
        anchors.fill: parent
    }
    Component {
        id: live
        LiveView { live: desk.live; bridge: script.bridge; pixelsPerMm: 5.9; closable: true }
    }
    Component {
        id: code
        CodePage { theme: large; texts: words; asksHand: true }
    }
    Component {
        id: latency
        LatencyPage { controller: desk.latency; pixelsPerMm: 5.9 }
    }

    RoomTest {
        name: "ScreenReader"
        when: windowShown

        SignalSpy { id: shownPage; target: script.bridge; signalName: "shown" }

        function cleanup() {
            room.close()
            view.visible = false
            control.visible = false
            page.sourceComponent = undefined
        }
        function complete(place) {
            wait(50)
            compare(inspector.unnamedControls(room.screen), [], place)
            compare(inspector.unreadTexts(room.screen), [], place)
        }

        function test_a_control_without_a_role_is_detected_and_a_shield_is_none() {
            control.visible = true
            compare(inspector.unnamedControls(control).length, 1)
        }
        function test_every_control_of_the_participants_pages_has_a_role_and_a_name_data() {
            return script.pages.map(name => ({ tag: name }))
        }
        function test_every_control_of_the_participants_pages_has_a_role_and_a_name(row) {
            view.visible = true
            const before = shownPage.count
            script.show(row.tag, "de")
            tryCompare(shownPage, "count", before + 1)
            compare(inspector.unnamedControls(view), [])
            compare(inspector.unreadTexts(view), [])
        }
        function test_every_control_of_pages_that_stand_alone_has_a_role_and_a_name_data() {
            return [{ tag: "live", component: live }, { tag: "code", component: code }, { tag: "latency", component: latency }]
        }
        function test_every_control_of_pages_that_stand_alone_has_a_role_and_a_name(row) {
            page.sourceComponent = row.component
            wait(20)
            verify(inspector.controls(page.item).length > 0)
            compare(inspector.unnamedControls(page.item), [])
            compare(inspector.unreadTexts(page.item), [])
        }
        function test_every_key_for_the_code_of_a_participant_is_a_button_with_a_name() {
            page.sourceComponent = code
            wait(20)
            const found = inspector.controls(page.item)
            for (const key of ["A", "9", "-", "Weiter", "Letztes Zeichen löschen"]) verify(found.includes("button: " + key), key + " in " + found.join("; "))
        }
        function test_every_control_of_the_start_page_and_its_dialogs_has_a_role_and_a_name() {
            room.open("1234")
            tryVerify(() => room.operating.mayBegin, 20000)
            complete("run")
            const found = inspector.controls(room.screen)
            for (const wanted of ["tab: Sessions", "item: short, Four quick trials", "button: Begin pilot", "button: Hold to arm the amplifier"])
                verify(found.includes(wanted), wanted + " in " + found.join("; "))
            tap("enterCode")
            complete("code of the participant")
        }
        function test_every_control_of_the_sessions_and_their_dialogs_has_a_role_and_a_name() {
            room.open("1234")
            compare(room.cutOffSession("pilot"), -9)
            tap("bar-sessions")
            tryVerify(() => find(room.screen, "session0") !== null, 5000)
            complete("sessions")
            for (const dialog of [["addNote", "cancelEntry"], ["search", "cancelEntry"], ["export", "cancelPlace"], ["withdraw", "keep"]]) {
                tap(dialog[0])
                complete(dialog[0])
                tap(dialog[1])
            }
            tap("makeReport")
            tryVerify(() => find(room.screen, "saveFigure") !== null, 20000)
            complete("report")
        }
        function test_every_control_of_the_rig_and_of_the_operators_code_has_a_role_and_a_name() {
            room.open("1234")
            room.addCells()
            tap("bar-rig")
            for (const tab of ["doctorTab", "selfTestTab", "weightsTab", "guideTab"]) {
                tap(tab)
                complete(tab)
            }
            for (const series of ["boundaries", "friction"]) {
                tap("guide-" + series)
                complete(series)
                room.reopen("1234")
                tap("bar-rig")
                tap("guideTab")
            }
            room.reopenLocked("1234")
            tryVerify(() => find(room.screen, "digit1") !== null, 5000)
            complete("gate")
            verify(inspector.controls(room.screen).includes("button: Delete the last character"))
        }
    }
}
