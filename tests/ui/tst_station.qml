import QtQuick
import QtTest
import Turnpoint

// Tests the whole program in its own window, as on a day in the laboratory: the operator's page, the
// participant's pages, real sessions, and the rows that they store.
Item {
    id: stage
    width: 800
    height: 480

    LatencyPage {
        id: latencyPage
        anchors.fill: parent
        visible: false
        controller: room.latency
        pixelsPerMm: 5.2
    }

    Texts { id: words; language: "en" }
    RoomTest {
        name: "Station"
        when: windowShown

        function cleanup() { room.close() }

        function hold(name, ms, parent = room.screen) {
            const button = appears(name, parent)
            mousePress(button, button.width / 2, button.height / 2)
            wait(ms)
            mouseRelease(button, button.width / 2, button.height / 2)
        }
        function type(code) {
            for (const digit of code) tap("digit" + digit)
            const lock = find(room.screen, "gate").lock
            tap("digitOK")
            // wait until another thread has compared the code
            tryCompare(lock, "checking", false, 20000)
        }
        /// Arms the amplifier as an operator does at the participant's screen.
        function arm() {
            tryCompare(page, "awaitsArming", true, 20000)
            tap("operatorArms")
            type("7391")
            hold("holdToArm", 1200)
            tryCompare(page, "awaitsArming", false, 5000)
        }

        function measurePanel() {
            latencyPage.visible = true
            const field = findChild(latencyPage, "latencyField")
            for (let k = 0; k < 10; ++k) {
                room.pressed(50)
                mousePress(field)
                mouseRelease(field)
                wait(410)  // a tap is matched only with an edge of the last 400 ms
            }
            tryCompare(room.latency, "pairs", 10)
            const offset = room.keepLatency()
            latencyPage.visible = false
            return offset
        }

        function test_a_live_session_runs_on_the_screen_from_calibration_to_report() {
            room.open("7391")
            tryVerify(() => operating.mayBegin, 20000)
            tap("live")
            tryVerify(() => operating.notLive.length > 0, 20000)
            compare(operating.notLive[0].key, "refusal.friction")
            // the illustrative curve is allowed in a pilot session
            tap("pilot")
            compare(operating.notLive, [])
            compare(operating.mayBegin, true)

            const offset = measurePanel()
            verify(offset >= 0.05 && offset < 0.15, offset)
            room.calibrate()
            tap("live")
            begin("T7")

            // Before the operator has armed, the participant can neither continue nor arm.
            tryCompare(page, "kind", PageModel.Fault, 20000)
            compare(page.runMode, "live")
            verify(!shown("proceed") && !shown("holdToArm"))
            tap("operatorArms")
            type("1111")
            verify(shown("gate") && !shown("holdToArm"))
            tap("gateLeave")
            verify(!shown("holdToArm"))
            arm()

            tryCompare(page, "kind", PageModel.Instructions, 20000)
            tap("proceed")
            answer(0)
            answer(1)
            rest()
            answer(1)
            answer(0)
            ends()
            tap("results")
            type("7391")
            appears("reportPage")
            tap("closeReport")
            tap("close")
            type("7391")
            appears("operatorPage")
            compare(operating.participants, ["T7"])
            compare(operating.armed, false)

            compare(room.column("trials.csv", "run_mode"), ["live", "live", "live", "live"])
            compare(room.column("trials.csv", "response"), ["left", "right", "right", "left"])
            compare(room.column("trials.csv", "outcome"), ["answered", "answered", "answered", "answered"])
            compare(room.column("trials.csv", "response_time_quality"), ["toolkit", "toolkit", "toolkit", "toolkit"])
            compare(room.column("events.csv", "value", "kind", "arm"), ["armed"])
            compare(room.column("sessions.csv", "status"), ["completed"])
            // The panel's latency is stored with each answer to which it applies. It is not subtracted from
            // response times.
            for (const stored of room.column("trials.csv", "response_offset_s"))
                fuzzyCompare(Number(stored), offset, 1e-6)
            const hashes = room.column("trials.csv", "calibration_id")
            verify(/^[0-9a-f]{64}$/.test(hashes[0]), hashes[0])
        }

        /// Runs four trials, and blocks the pages' thread for `blocked_ms` in the second one. Returns {trial:
        /// lost frames}. `seen` is the count by the test's own timer, which may miss a delay that is split
        /// between two of its ticks.
        function framesLost(blocked_ms) {
            room.open("7391")
            begin("T2")
            tap("proceed")
            room.lookOn()
            answer(0)
            tryVerify(() => page.kind === PageModel.Stimulus && page.answersOpen, 20000)
            room.block(blocked_ms)
            answer(0)
            rest()
            answer(1)
            answer(1)
            ends()
            const lost = { seen: room.stallsSeen(), total: 0 }
            const trials = room.column("events.csv", "trial_index", "kind", "frames_lost")
            const frames = room.column("events.csv", "value", "kind", "frames_lost")
            for (let k = 0; k < trials.length; ++k) {
                lost[trials[k]] = Number(frames[k])
                lost.total += lost[trials[k]]
            }
            return lost
        }

        function test_frames_that_are_late_in_a_trial_are_counted_in_its_events() {
            const lost = framesLost(100)
            // 100 ms are six refreshes at 60 Hz, of which one or two may not be counted
            verify(lost["1"] >= 4, JSON.stringify(lost))
            verify(lost.total <= lost.seen + 1, JSON.stringify(lost))
            tap("results")
            type("7391")
            appears("reportPage")
            tryVerify(() => says(room.screen, lost.total + " in "), 20000)
        }

        function test_a_session_whose_pages_are_in_time_counts_no_late_frame() {
            const lost = framesLost(0)
            // The session may count at most one frame more than this machine missed.
            verify(lost.total <= lost.seen + 1, JSON.stringify(lost))
        }

        function test_a_session_that_was_cut_off_continues_at_the_same_trial() {
            room.open("7391")
            room.calibrate()
            compare(room.cutOffSession("live"), -9)
            room.reopen("7391")
            tryVerify(() => operating.interrupted.trials === 2, 20000)
            compare(operating.interrupted.participant, "T1")
            compare(operating.interrupted.protocol, "short")
            tap("resume")
            // a resumed live session must be armed, too
            arm()
            tap("proceed")
            compare(page.trialsDone, 2)
            compare(page.runMode, "live")
            answer(0)
            answer(0)
            ends()
            tap("close")
            type("7391")
            appears("operatorPage")
            compare(operating.interrupted, {})
            compare(room.column("trials.csv", "trial_index"), ["0", "1", "2", "3"])
            compare(room.column("trials.csv", "response"), ["right", "right", "left", "left"])
            compare(room.column("trials.csv", "run_mode"), ["live", "live", "live", "live"])
            compare(room.column("trials.csv", "level"), room.plannedLevels())
            // The interrupted trial was presented before the interruption, and again after it.
            const presented = room.column("events.csv", "trial_index", "kind", "presented")
            compare(presented, ["0", "1", "2", "2", "3"])
            compare(room.column("sessions.csv", "status"), ["completed"])
        }

        function test_the_second_screen_belongs_only_to_the_operator() {
            room.open("7391")
            room.addSecondScreen()
            room.calibrate()
            tryVerify(() => operating.mayBegin, 20000)
            tap("live")
            begin("T3")
            tryCompare(page, "awaitsArming", true, 20000)
            hold("liveArm", 1200, room.second)
            tryCompare(page, "kind", PageModel.Instructions, 5000)
            tap("proceed")
            tryVerify(() => page.answersOpen, 20000)
            verify(says(room.second, "LIVE") && !says(room.screen, "LIVE"))
            tap("livePause", room.second)
            tryCompare(page, "kind", PageModel.Paused, 5000)
            verify(!shown("liveView"))
            tap("livePause", room.second)                            // a second tap continues the session
            tryVerify(() => page.answersOpen, 20000)
            compare(page.trialsDone, 0)
            answer(1)
            tap("liveNote", room.second)
            tap("quickNote0", room.second)
            tap("keepNote", room.second)
            tap("liveStop", room.second)
            compare(page.kind === PageModel.End, false)
            tap("confirm", room.second)
            ends()
            verify(says(room.second, "It can be continued"))
            compare(room.column("trials.csv", "outcome")[1], "answered")
            compare(room.column("sessions.csv", "status"), ["interrupted"])
            compare(inspector.cutTexts(room.second), [])
        }

        function test_no_participant_can_open_the_operators_pages() {
            room.open("7391")
            begin("T4")
            hold("operatorCorner", 300)
            verify(!shown("gate"))                                   // a short press does not open the keypad
            hold("operatorCorner", 2300)
            appears("gate")
            type("2469")
            type("8642")
            verify(shown("gate") && !shown("liveView"))
            tap("gateLeave")
            verify(!shown("gate") && !shown("liveView"))
            // leaving the keypad does not affect the session
            compare(page.kind, PageModel.Instructions)
            tap("proceed")
            tryVerify(() => page.kind === PageModel.Stimulus, 20000)
            compare(find(room.screen, "operatorCorner").enabled, false)
            answer(0)
            tap("pause")
            tryCompare(page, "kind", PageModel.Paused, 5000)
            hold("operatorCorner", 2300)
            type("7391")
            // the right code opens the operator's page
            appears("liveView")
            tap("liveClose")
            verify(!shown("liveView"))
            tap("end")
            tap("confirm")
            ends()
            verify(says(room.screen, "call the experimenter"))

            // The pages that can be opened from the end page are also for the operator only.
            for (const way of ["results", "close"]) {
                tap(way)
                type("1234")
                verify(!shown("reportPage") && !shown("operatorPage"))
                tap("gateLeave")
                compare(page.kind, PageModel.End)
            }
            tap("close")
            type("7391")
            appears("operatorPage")
        }

        function test_a_locked_station_starts_with_the_page_for_the_code() {
            room.open("7391")
            room.reopenLocked("7391")
            appears("gate")
            verify(!shown("operatorPage"))
            // at the start there is no page to go back to
            compare(find(room.screen, "gateLeave").enabled, false)
            type("1357")
            verify(shown("gate") && !shown("operatorPage"))
            type("7391")
            appears("operatorPage")
            verify(!shown("gate"))
            // after unlocking, a session can begin as usual
            begin("T8")
            tryCompare(page, "kind", PageModel.Instructions, 20000)
        }

        function test_every_question_before_the_session_can_be_taken_back() {
            room.open("7391")
            tryVerify(() => operating.mayBegin, 20000)
            tap("begin")
            appears("languagePage")
            tap("language1")
            appears("codePage")
            for (const key of "T9") tap("key" + key)
            tap("hand")
            tap("back")
            appears("languagePage")
            tap("language0")
            appears("codePage")
            verify(says(room.screen, "Your participant code"))
            compare(find(room.screen, "accept").enabled, false)
            tap("back")
            // Leaving the first question needs the operator's code.
            tap("back")
            appears("gate")
            tap("gateLeave")
            verify(!shown("operatorPage"))
            tap("back")
            type("7391")
            appears("operatorPage")
            compare(find(room.screen, "operatorPage").Window.window.leftHanded, false)
            verify(operating.mayBegin)
        }

        function test_a_wrong_code_is_named_until_the_next_digit() {
            room.open("7391")
            room.reopenLocked("7391")
            appears("gate")
            type("1357")
            tryVerify(() => says(room.screen, "Wrong code. Try again."))
            verify(says(room.screen, "Operator's code"))
            tap("digit7")
            verify(!says(room.screen, "Wrong code") && says(room.screen, "Operator's code"))
        }

        function test_the_built_in_code_is_shown_and_a_keyboard_chooses_another() {
            room.open("7391")
            room.reopenBuiltIn()
            appears("gate")
            verify(says(room.screen, "2468"))
            const keys = digits => { for (const digit of digits) { room.pressKey(Qt.Key_0 + Number(digit)); room.releaseKey(Qt.Key_0 + Number(digit)) } }
            keys("1")
            room.pressKey(Qt.Key_Backspace)
            room.releaseKey(Qt.Key_Backspace)
            keys("2468")
            room.pressKey(Qt.Key_Return)
            room.releaseKey(Qt.Key_Return)
            appears("codeOffer")
            verify(says(room.screen, "2468"))
            tap("chooseCode")
            appears("codeChoice")
            room.pressKey(Qt.Key_Escape)
            room.releaseKey(Qt.Key_Escape)
            tryVerify(() => !shown("codeChoice"), 5000)
            tap("chooseCode")
            appears("codeChoice")
            keys("2468")
            room.pressKey(Qt.Key_Return)
            tryVerify(() => says(room.screen, "Not possible"), 20000)
            keys("7391")
            room.pressKey(Qt.Key_Enter)
            tryVerify(() => !shown("codeChoice") && !shown("codeOffer"), 20000)
            verify(!says(room.screen, "2468"))
        }

        // A new machine: no code was chosen, nothing was recorded, and no rig was described. Somebody who taps once a second
        // chooses a code and a language, takes part in the demo, and reads its report.
        function test_from_an_empty_machine_to_the_report_of_the_demo_in_three_minutes() {
            room.openNew()
            const begun = Date.now()
            let taps = 0
            const touch = name => { ++taps; tap(name) }
            const typeCode = code => { for (const digit of code) touch("digit" + digit); touch("digitOK") }
            appears("operatorPage")
            verify(!shown("gate"))
            verify(says(find(room.screen, "codeOffer"), "2468"))
            touch("chooseCode")
            appears("codeChoice")
            typeCode("7391")
            tryVerify(() => !shown("codeChoice") && !shown("codeOffer"), 20000)

            touch("bar-rig")
            appears("rigPage")
            touch("screen-de")
            verify(says(room.screen, "Sitzungen"))
            touch("screen-en")
            verify(says(room.screen, "Sessions"))
            verify(says(find(room.screen, "rigPage"), "simulated"))

            touch("bar-run")
            appears("operatorPage")
            touch("protocol" + operating.protocols.findIndex(protocol => protocol.id === "demo"))
            tryVerify(() => operating.mayBegin, 20000)
            compare(operating.problems, [])
            touch("begin")
            appears("languagePage")
            touch("language0")
            appears("codePage")
            for (const key of "P1") touch("key" + key)
            touch("accept")
            tryCompare(page, "kind", PageModel.Instructions, 20000)
            touch("proceed")
            while (page.trialsDone < page.trialsTotal) {
                ++taps
                const done = page.trialsDone
                answer(done % 2)
                tryVerify(() => page.trialsDone > done, 20000)
            }
            ends()
            touch("results")
            verify(!says(room.screen, "2468"))
            typeCode("7391")
            appears("reportPage")
            tryVerify(() => says(find(room.screen, "reportPage"), "P1"), 20000)
            const seconds = (Date.now() - begun) / 1000 + taps
            console.log("first hour: " + taps + " taps, " + seconds.toFixed(0) + " s")
            verify(seconds < 180, seconds)
            verify(taps <= 40, taps)
            compare(room.column("sessions.csv", "status"), ["completed"])
        }

        function test_a_larger_screen_shows_more_protocols_and_not_larger_ones() {
            room.openNew()
            const rows = (width, height) => {
                room.resize(width, height)
                tryCompare(find(room.screen, "operatorPage"), "height", find(room.screen, "operatorPage").parent.height)
                wait(100)
                const list = find(room.screen, "protocols")
                return all(list, item => /^protocol\d+$/.test(item.objectName)).filter(card => {
                    const y = card.mapToItem(list, 0, 0).y
                    return y >= 0 && y + card.height <= list.height
                })
            }
            const small = rows(1280, 800), height = small[0].height, count = small.length
            const large = rows(1920, 1080)
            verify(count >= 5, count)
            verify(large.length >= count + 2, large.length + " rows instead of " + count)
            verify(large[0].height <= height, large[0].height + " instead of " + height)
        }

        // The database is damaged after the operator has pressed Begin, so the participant is there when it is found.
        function test_a_damaged_database_is_for_the_operator_and_not_for_the_participant() {
            room.open("7391")
            tryVerify(() => operating.mayBegin, 20000)
            tap("begin")
            appears("languagePage")
            tap("language0")
            appears("codePage")
            room.damageDatabase()
            for (const key of "T1") tap("key" + key)
            tap("accept")
            tryCompare(page, "kind", PageModel.Failed, 20000)
            const said = texts(room.screen).join("\n")
            verify(said.length > 20 && !/sqlite|database|\/|code \d/i.test(said), said)
            tap("proceed")
            type("7391")
            appears("operatorPage")
            tryVerify(() => says(find(room.screen, "stationLine"), "Database: damaged"), 20000)
            compare(find(room.screen, "begin").enabled, false)
            verify(operating.problems.length > 0)
            for (const problem of operating.problems) verify(says(room.screen, words.say(problem)), words.say(problem))
        }

        function test_an_empty_folder_says_what_to_do() {
            room.open("7391")
            room.reopenEmpty("7391")
            appears("noProtocols")
            verify(says(room.screen, "There are no protocols in"))
            compare(operating.mayBegin, false)
        }

        function test_nothing_of_the_last_participant_is_shown_to_the_next_one() {
            room.open("7391")
            tryVerify(() => operating.mayBegin, 20000)
            tap("language0")
            tap("begin")
            for (const key of "T1") tap("key" + key)
            tap("hand")
            tap("accept")
            tap("pause")
            tap("end")
            tap("confirm")
            ends()
            tap("close")
            type("7391")
            tryVerify(() => operating.mayBegin, 20000)
            tap("begin")
            appears("codePage")
            // The keypad must be empty again, and the layout must be the one for right-handed people.
            compare(find(room.screen, "accept").enabled, false)
            verify(says(room.screen, "right hand"))
            for (const key of "T2") tap("key" + key)
            const seen = []
            const look = () => { seen.push(page.kind) }
            page.changed.connect(look)
            tap("accept")
            tryCompare(page, "kind", PageModel.Instructions, 20000)
            page.changed.disconnect(look)
            compare(seen[0], PageModel.Interval)
        }
    }
}
