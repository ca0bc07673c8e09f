import QtQuick
import QtTest
import Turnpoint

// Runs a whole adjustment session by touch. The slider, the surface and the stored row must agree.
Item {
    id: stage
    width: 800
    height: 480

    ParticipantView {
        id: view
        anchors.fill: parent
        bridge: session.bridge
        pixelsPerMm: 5.2
    }

    PageTest {
        name: "Adjustment"
        when: windowShown

        readonly property PageModel page: session.bridge.page

        function tap(name) {
            tryVerify(() => find(view, name) !== null, 20000, name)
            // A page accepts taps only after it has been shown for a while, however long its first frame took.
            wait(400)
            tryVerify(() => find(view, name)?.armed, 20000, name)
            mouseClick(find(view, name))
        }
        /// Returns the position on the slider that belongs to a value.
        function place(slider, value) {
            const knob = slider.knob
            return knob / 2 + (value - page.sliderMin) / (page.sliderMax - page.sliderMin) * (slider.width - knob)
        }
        function adjusting() {
            tryVerify(() => page.kind === PageModel.Adjust && !page.answersOpen, 20000)
            wait(400)
            return find(view, "slider")
        }

        function test_the_standard_comes_again_and_then_the_setting_that_was_made() {
            session.bridge.watch(stage.Window.window)
            session.start("match.toml")
            tap("proceed")
            adjusting()
            verify(!find(view, "proceed").enabled)
            tap("stepUp")
            tap("stepUp")
            fuzzyCompare(find(view, "slider").parent.value, -19, 1e-9)
            tap("again")
            tryVerify(() => page.kind === PageModel.Stimulus, 20000)      // the standard
            verify(!page.again)
            adjusting()
            fuzzyCompare(page.slider, -19, 1e-9)
            verify(!page.again)                                           // once is all
            verify(find(view, "proceed").enabled)                         // the setting can be confirmed as it is
            tap("proceed")
            tryCompare(session, "over", true, 20000)
            compare(session.failure, "")
            compare(session.column("again"), "1")
            compare(session.column("response"), "-19")
        }

        function test_settings_by_slider_and_step_buttons_are_stored() {
            session.bridge.watch(stage.Window.window)
            session.start("adjust.toml")
            tap("proceed")

            // Drag the handle with a finger to -8, then tap "up" twice.
            let slider = adjusting()
            fuzzyCompare(page.slider, -20, 1e-9)
            const touch = touchEvent(stage)
            const y = slider.height / 2
            touch.press(1, slider, place(slider, -20), y).commit()
            touch.move(1, slider, place(slider, -14), y).commit()
            touch.move(1, slider, place(slider, -8), y).commit()
            touch.release(1, slider, place(slider, -8), y).commit()
            tap("stepUp")
            tap("stepUp")
            wait(200)
            tap("proceed")

            tryVerify(() => page.kind !== PageModel.Adjust, 5000)

            // Move the second slider down while the surface vibrates. A click on it after the vibration has ended
            // must have no effect, because its effect could not be felt.
            slider = adjusting()
            fuzzyCompare(page.slider, -20, 1e-9)
            tap("stepDown")
            tryCompare(page, "answersOpen", true, 10000)
            mouseClick(slider, slider.width - 1, y)
            tap("proceed")

            tryCompare(session, "over", true, 20000)
            compare(session.failure, "")
            compare(session.column("response"), "-7 -20.5")
            compare(session.column("outcome"), "answered answered")
            const boundaries = session.column("boundary_mm").split(" ")
            fuzzyCompare(Number(boundaries[0]), 153, 0.01)
            fuzzyCompare(Number(boundaries[1]), 139.5, 0.01)
            verify(session.events("slider").split(" ").length >= 4)
        }
    }
}
