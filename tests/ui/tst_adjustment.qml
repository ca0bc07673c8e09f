import QtQuick
import QtTest
import Turnpoint

// A whole adjustment session by touch: what the slider shows is what the surface does and what the row keeps.
Item {
    id: stage
    width: 800
    height: 480

    ParticipantView {
        id: view
        anchors.fill: parent
        bridge: sitting.bridge
        pixelsPerMm: 5.2
    }

    TestCase {
        name: "Adjustment"
        when: windowShown

        readonly property PageModel page: sitting.bridge.page

        function find(parent, name) {
            for (let i = 0; i < parent.children.length; ++i) {
                const child = parent.children[i]
                if (!child.visible) continue
                const found = child.objectName === name ? child : find(child, name)
                if (found) return found
            }
            return null
        }
        function tap(name) {
            tryVerify(() => find(view, name) !== null, 20000, name)
            wait(400)                                                // a page takes taps once it has been up a while,
            tryVerify(() => find(view, name)?.armed, 20000, name)    // however long its first frame took
            mouseClick(find(view, name))
        }
        /// Where on the slider a value stands.
        function place(slider, value) {
            const knob = slider.knob
            return knob / 2 + (value - page.sliderMin) / (page.sliderMax - page.sliderMin) * (slider.width - knob)
        }
        function adjusting() {
            tryVerify(() => page.kind === PageModel.Adjust && !page.answersOpen, 20000)
            wait(400)
            return find(view, "slider")
        }

        function test_settings_by_slider_and_steps_reach_the_rows() {
            sitting.bridge.watch(stage.Window.window)
            sitting.start("adjust.toml")
            tap("proceed")

            // Dragged with a finger from where it stands to -8, then two steps up.
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

            // The second one is left alone until the surface falls silent; moving it then would be felt by nobody.
            slider = adjusting()
            fuzzyCompare(page.slider, -20, 1e-9)
            tap("stepDown")
            tryCompare(page, "answersOpen", true, 10000)
            mouseClick(slider, slider.width - 1, y)
            tap("proceed")

            tryCompare(sitting, "over", true, 20000)
            compare(sitting.failure, "")
            compare(sitting.column("response"), "-7 -20.5")
            compare(sitting.column("outcome"), "answered answered")
            const boundaries = sitting.column("boundary_mm").split(" ")
            fuzzyCompare(Number(boundaries[0]), 153, 0.01)
            fuzzyCompare(Number(boundaries[1]), 139.5, 0.01)
            verify(sitting.events("slider").split(" ").length >= 4)
        }
    }
}
