import QtQuick
import QtTest
import Turnpoint

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

    GalleryTest {
        name: "Pages"
        view: view
        when: windowShown

        readonly property real settleMs: 40

        function initTestCase() { script.bridge.watch(stage.Window.window) }

        function init() {
            // the page ignores taps that follow each other too fast, so wait after the previous test
            wait(2 * settleMs)
            show("between-trials")
            script.forget()
        }

        function item(name) {
            const found = findChild(view, name)
            verify(found, name)
            return found
        }

        function visibleItem(name) {
            const found = named(view, name)
            compare(found.length, 1, "visible items called " + name)
            return found[0]
        }

        function tap(name) {
            const button = visibleItem(name)
            mouseClick(button, button.width / 2, button.height / 2)
        }

        function untilArmed() { wait(400) }

        function test_the_intervals_of_abx_are_called_a_b_and_x_all_others_are_numbered() {
            for (const page of ["abx-cue", "abx-x", "abx-answers"]) {
                show(page)
                compare(intervalNames(), ["A", "B", "X"], page)
            }
            show("interval-2-of-3")
            compare(intervalNames(), ["1", "2", "3"])
        }

        function test_the_pacer_moves_at_the_speed_that_is_asked_for() {
            show("cue")
            const begun = Date.now()
            show("stroke")
            const pacer = item("pacer"), block = visibleItem("pacerBlock")
            verify(pacer.visible && pacer.running)
            compare(pacer.speedMmPerS, 80)
            for (const seconds of [0, 0.1, 0.7, 1.3, 12.34]) {
                const way = (80 * 5.2 * seconds) % (2 * pacer.travel)
                fuzzyCompare(pacer.placeAfter(seconds), Math.min(way, 2 * pacer.travel - way), 0.01)
            }
            wait(600)
            const moved = pacer.seconds, passed = (Date.now() - begun) / 1000
            verify(moved > 0.3 && moved < passed + 0.02, moved + " s of " + passed + " s")
            fuzzyCompare(block.x, pacer.placeAfter(pacer.seconds), 0.01)
        }

        function test_the_pacer_rests_during_a_stimulus_and_while_an_answer_is_awaited() {
            for (const page of ["explore-guided", "response-guided"]) {
                show(page)
                const pacer = item("pacer")
                compare(named(view, "pacerBlock").length, 0, page)
                const before = pacer.seconds
                wait(100)
                compare(pacer.seconds, before, page)
            }
            show("cue")
            verify(!item("pacer").visible)
        }

        function intervalNames() { return named(view, "intervalName").map(name => name.text) }

        function test_an_answer_goes_out_once_with_the_time_of_the_touch() {
            show("explore")
            const button = item("answer1")
            const touch = touchEvent(stage)
            touch.press(1, button).commit()
            touch.release(1, button).commit()
            tryCompare(script, "inputs", ["answer 1"])
            verify(script.answerAgeMs() >= settleMs)
            mouseClick(item("answer0"))
            // only the second tap is counted here, because the first one became the answer
            tryCompare(script, "touches", 1)
            compare(script.inputs, ["answer 1"])
        }

        function test_an_answer_has_the_kernels_time_if_it_is_known() {
            show("explore")
            mouseClick(item("answer0"))
            tryCompare(script, "inputs", ["answer 0"])
            compare(script.quality(), "toolkit")
            show("between-trials")
            show("explore")
            script.setKernelLead(1000)
            mouseClick(item("answer1"))
            tryCompare(script, "inputs", ["answer 0", "answer 1"])
            compare(script.quality(), "kernel")
            verify(script.answerAgeMs() >= 1000 + settleMs)
            script.forgetKernel()
        }

        function test_the_button_shows_a_press_at_once() {
            show("explore")
            const button = item("answer0")
            compare(button.down, false)
            mousePress(button)
            compare(button.down, true)
            mouseRelease(button)
            compare(item("answer1").down, false)
        }

        function test_a_touch_from_before_the_answers_opened_does_not_count() {
            show("cue")
            const where = view.mapToItem(stage, 200, 400)
            const touch = touchEvent(stage)
            touch.press(1, stage, where.x, where.y).commit()
            show("explore")
            touch.move(1, stage, where.x + 2, where.y).commit()
            touch.release(1, stage, where.x, where.y).commit()
            wait(100)
            compare(script.inputs, [])
        }

        function test_ten_fingers_give_no_answer() {
            show("explore")
            const touch = touchEvent(stage)
            for (let finger = 0; finger < 10; ++finger) touch.press(finger, stage, 60 + 70 * finger, 380)
            touch.commit()
            for (let finger = 0; finger < 10; ++finger) touch.release(finger, stage, 60 + 70 * finger, 380)
            touch.commit()
            wait(100)
            compare(script.inputs, [])
            tryCompare(script, "touches", 10)
            mouseClick(item("answer1"))
            tryCompare(script, "inputs", ["answer 1"])
        }

        function test_the_gap_between_the_answers_belongs_to_neither() {
            show("explore")
            const left = item("answer0"), right = item("answer1")
            const y = left.mapToItem(stage, 0, left.height / 2).y
            mouseClick(stage, (left.mapToItem(stage, left.width, 0).x + right.mapToItem(stage, 0, 0).x) / 2, y)
            wait(100)
            compare(script.inputs, [])
        }

        function test_answers_are_large_and_far_apart_and_symmetric_data() {
            return [{ tag: "two", page: "response" }, { tag: "three", page: "response-3" }]
        }
        function test_answers_are_large_and_far_apart_and_symmetric(row) {
            show(row.page)
            const count = script.bridge.page.answers.length
            const first = item("answer0"), last = item("answer" + (count - 1)), second = item("answer1")
            const mm = view.pixelsPerMm
            verify(first.width >= 20 * mm && first.height >= 20 * mm)
            verify(second.x - first.x - first.width >= 5 * mm)
            compare(first.width, last.width)
            fuzzyCompare(first.mapToItem(stage, 0, 0).x, stage.width - last.mapToItem(stage, last.width, 0).x, 0.5)
            compare(first.color, last.color)
        }

        function test_continue_ignores_late_taps_from_the_previous_page() {
            show("instructions")
            tap("proceed")
            compare(script.inputs, [])
            untilArmed()
            tap("proceed")
            compare(script.inputs, ["next"])
        }

        function test_a_break_ends_when_its_time_is_over() {
            show("rest")
            untilArmed()
            tap("proceed")
            compare(script.inputs, [])
            show("rest-over")
            tap("proceed")
            compare(script.inputs, ["next"])
        }

        function test_the_slider_moves_in_steps() {
            show("adjust")
            untilArmed()
            tap("stepUp")
            tap("stepUp")
            tap("stepDown")
            compare(script.inputs, ["slider 32", "slider 33", "slider 32"])
            script.forget()
            const slider = visibleItem("slider")
            mouseClick(slider, slider.width - 1, slider.height / 2)
            compare(script.inputs, ["slider 100"])
            tap("proceed")
            compare(script.inputs, ["slider 100", "next"])
        }

        function test_a_line_has_no_mark_and_no_done_button_until_it_is_touched() {
            show("line")
            untilArmed()
            verify(!item("mark").visible)
            compare(named(view, "proceed").length, 0)
            const line = visibleItem("line")
            mouseClick(line, line.inset + 0.62 * (line.width - 2 * line.inset), line.height / 2)
            verify(item("mark").visible)
            compare(script.inputs, ["slider 62"])
            mouseClick(line, line.width - 1, line.height / 2)
            tap("proceed")
            compare(script.inputs, ["slider 62", "slider 100", "value 100"])
            show("between-trials")
            show("line")
            verify(!item("mark").visible)
        }

        function test_a_number_is_typed_and_confirmed_only_inside_its_range() {
            show("number")
            untilArmed()
            for (const key of ["1", "2", "3", "4", ".", "5", "6"]) tap("key" + key)
            compare(item("typed").text, "1234.5")
            verify(!visibleItem("proceed").enabled)  // above 1000
            for (let i = 0; i < 4; ++i) tap("key<")
            compare(item("typed").text, "12")
            tap("key.")
            tap("key5")
            tap("proceed")
            compare(script.inputs, ["value 12.5"])
            show("between-trials")
            show("number-standard")
            compare(item("typed").text, "")
            verify(!item("key.").enabled)
        }

        function test_answers_in_several_rows_are_found_where_they_are_drawn_data() {
            return [0, 4, 5, 8].map(index => ({ tag: "answer " + index, index: index }))
        }
        function test_answers_in_several_rows_are_found_where_they_are_drawn(row) {
            show("choices-9")
            mouseClick(visibleItem("answer" + row.index))
            tryCompare(script, "inputs", ["answer " + row.index])
        }

        function test_the_second_tap_of_an_answer_is_no_confidence() {
            show("confidence")
            mouseClick(visibleItem("answer1"))
            wait(2 * settleMs)
            compare(script.inputs, [])
            wait(400)
            mouseClick(visibleItem("answer1"))
            tryCompare(script, "inputs", ["answer 1"])
        }

        // As if the program had been held up: the tap waited for the page for longer than taps are ignored.
        function test_a_tap_that_had_to_wait_is_no_confidence() {
            show("confidence")
            const until = Date.now() + 500
            while (Date.now() < until) continue
            wait(0)
            mouseClick(visibleItem("answer1"))
            wait(2 * settleMs)
            compare(script.inputs, [])
            wait(400)
            mouseClick(visibleItem("answer1"))
            tryCompare(script, "inputs", ["answer 1"])
        }

        function test_a_confidence_that_was_not_accepted_is_asked_again() {
            show("confidence")
            tryCompare(item("touchField"), "open", true)
            mouseClick(visibleItem("answer1"))
            tryCompare(script, "inputs", ["answer 1"])
            wait(2 * settleMs)
            mouseClick(visibleItem("answer2"))
            wait(2 * settleMs)
            compare(script.inputs, ["answer 1"])
            show("confidence")
            mouseClick(visibleItem("answer2"))
            tryCompare(script, "inputs", ["answer 1", "answer 2"])
        }

        function test_every_fault_page_says_what_happened_what_is_safe_and_what_to_do_data() {
            const goOn = ["touch_gone", "disk_full", "limits", "stimulus_missed"]
            return ["converter_gone", "converter_rate", "converter_saturated", "suspended", "amplifier", "enable_line",
                "stop_pressed", ...goOn].map(kind => ({ tag: kind, arms: !goOn.includes(kind) }))
        }
        function test_every_fault_page_says_what_happened_what_is_safe_and_what_to_do(row) {
            show("fault-" + row.tag)
            const page = script.bridge.page
            verify(page.detail === "" || !findText(view, page.detail), "what a device reports is not for participants")
            for (const says of [page.text, page.safe, page.toDo]) {
                verify(says !== "")
                verify(findText(view, says), says)
            }
            untilArmed()
            if (!row.arms) {
                tap("proceed")
                compare(script.inputs, ["next"])
                return
            }
            // Only an operator may arm the amplifier. An accidental touch must not be able to.
            arming.clear()
            tap("operatorArms")
            compare(arming.count, 1)
            compare(script.inputs, [])
            view.armable = true
            tap("holdToArm")
            compare(script.inputs, [])
            const hold = visibleItem("holdToArm")
            mousePress(hold)
            tryCompare(script, "inputs", ["arm"], 3000)
            mouseRelease(hold)
        }

        SignalSpy { id: arming; target: view; signalName: "armingWanted" }

        // What a device, the system or the database reports is for the operator.
        function test_no_notice_shows_a_participant_a_path_or_an_error_code() {
            const raw = /[a-z.]\/|\/[a-z]|sqlite|SQL|errno|no such|input\/output|database|status \d|\b[A-Z]\w*Error\b|0x[0-9a-f]/i
            const raws = () => all(view, item => typeof item.text === "string" && raw.test(item.text)).map(item => item.text)
            const notices = script.pages.filter(name => /^(fault|failed|paused|end)/.test(name))
            verify(notices.length > 25, notices)
            for (const language of ["en", "de", "es", "ja", "zh", "ar"])
                for (const name of notices) {
                    const before = shownPages.count
                    script.show(name, language)
                    tryCompare(shownPages, "count", before + 1)
                    compare(raws(), [], language + " " + name)
                }
            // negative control: the operator, who has typed the code, reads it
            show("fault-program")
            view.armable = true
            verify(raws().length > 0)
            view.armable = false
        }
        SignalSpy { id: shownPages; target: script.bridge; signalName: "shown" }

        function test_an_empty_bar_of_the_progress_looks_empty_and_a_full_one_full() {
            const strip = bar.createObject(stage, { width: 400, y: 20 })
            /// Where the bar is dark, by the pixels on the screen: the share of its length.
            const dark = () => {
                wait(30)
                const picture = grabImage(strip), middle = Math.round(strip.height / 2)
                const track = find(strip, "progressDone").parent
                let count = 0, all = 0
                for (let x = 4; x < track.width - 4; x += 2) {
                    ++all
                    const seen = picture.pixel(x, middle), paper = Qt.color("#f6f4ee")
                    const light = c => 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b
                    if (light(seen) < 0.5) ++count
                    else verify(Math.abs(light(seen) - light(paper)) < 0.1, "the track is as light as the page: " + seen)
                }
                return count / all
            }
            compare(dark(), 0)
            for (const done of [20, 40, 80]) {
                strip.done = done
                fuzzyCompare(dark(), done / 80, 0.04)
            }
            compare(texts(strip).filter(text => /min left/.test(text)), [])
            strip.minutes = 4
            verify(says(strip, "about \u20684\u2069 min left"))
            strip.destroy()
        }
        Component {
            id: bar
            Rectangle {
                id: strip
                property int done: 0
                property int minutes: -1
                height: 40
                color: "#f6f4ee"
                ProgressStrip {
                    anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter }
                    theme: Theme { width: 800; height: 480; pixelsPerMm: 5.2 }
                    texts: Texts { language: "en" }
                    done: strip.done
                    total: 80
                    minutes: strip.minutes
                }
            }
        }

        function test_the_left_handed_layout_moves_the_buttons_of_the_hand_but_no_answer() {
            show("explore")
            const pause = visibleItem("pause")
            const right = pause.mapToItem(stage, 0, 0).x
            view.leftHanded = true
            verify(pause.mapToItem(stage, 0, 0).x < right)
            verify(item("answer0").mapToItem(stage, 0, 0).x < item("answer1").mapToItem(stage, 0, 0).x)
            compare(item("answer0").children[0].text, script.bridge.page.answers[0])
            mouseClick(item("answer0"))
            tryCompare(script, "inputs", ["answer 0"])
            view.leftHanded = false
        }

        function test_a_participant_can_pause_from_every_page_of_a_block_data() {
            return ["cue", "explore", "response", "gap", "between-trials", "instructions", "rest", "adjust"].map(page => ({ tag: page }))
        }
        function test_a_participant_can_pause_from_every_page_of_a_block(row) {
            show(row.tag)
            tap("pause")
            compare(script.inputs, ["pause"])
        }

        function test_every_page_says_if_a_run_is_not_live() {
            show("explore-pilot")
            verify(findText(view, "PILOT RUN"))
            show("explore-simulated")
            verify(findText(view, "SIMULATED"))
            show("explore")
            verify(!findText(view, "SIMULATED") && !findText(view, "PILOT RUN"))
        }

        function findText(parent, wanted) { return all(parent, item => item.text === wanted).length > 0 }

        function test_nothing_is_repainted_during_a_stimulus() {
            show("explore")
            wait(50)
            const before = grabImage(view)
            wait(400)
            verify(grabImage(view).equals(before))
        }
        function test_what_moves_is_detected_as_repainting() {
            show("rest")
            const before = grabImage(view)
            tryVerify(() => !grabImage(view).equals(before), 3000)
        }

        SignalSpy { id: frames; target: stage.Window.window; signalName: "frameSwapped" }
        function test_the_next_frame_shows_that_an_answer_was_pressed() {
            show("explore")
            wait(50)
            const button = item("answer0")
            const edge = button.mapToItem(stage, button.width / 2, 0.1 * button.height)
            const before = grabImage(stage).pixel(edge.x, edge.y)
            frames.clear()
            const touch = touchEvent(stage)
            touch.press(1, button).commit()
            frames.wait()
            compare(frames.count, 1)
            verify(grabImage(stage).pixel(edge.x, edge.y) !== before)
            touch.release(1, button).commit()
        }
    }
}
