import QtQuick
import QtTest
import Turnpoint

// Tests the operator's pages in the whole program, reached through the bar and operated by taps: what they
// show and what they write, and that a stray tap does nothing that cannot be undone.
Item {
    id: stage
    width: 1280
    height: 800

    RoomTest {
        name: "Places"
        when: windowShown

        function init() { room.open("1234") }
        function cleanup() {
            room.close()
        }

        function key(code) {
            room.pressKey(code)
            room.releaseKey(code)
        }
        function goTo(place) {
            tap("bar-" + place)
            appears(place + "Page")
        }
        function type(text) {
            for (const letter of text) tap("letter" + letter)
            tap("keepEntry")
        }
        function interrupt() {
            compare(room.cutOffSession("pilot"), -9)
            goTo("sessions")
            tryVerify(() => shown("session0"), 5000)
        }

        function test_the_bar_leads_to_each_page_and_back() {
            for (const place of ["studies", "sessions", "rig"]) {
                verify(room.pressUntilShown(appears("bar-" + place)) >= 0, "a press shows")
                goTo(place)
                verify(!shown("operatorPage"))
            }
            tap("bar-run")
            appears("operatorPage")
        }

        function test_studies_shows_every_problem_with_its_line_and_hint() {
            room.addMistaken()
            goTo("studies")
            tap("protocol0")
            tryVerify(() => says(find(room.screen, "verdict").parent, "Cannot be used"), 20000)
            verify(says(room.screen, "mistaken.toml   ·   line 2"))
            verify(says(room.screen, "mistaken.toml   ·   line 3"))
            verify(says(room.screen, "protocl"))
            verify(says(room.screen, "titel"))
            verify(says(room.screen, "→ "))
            compare(find(room.screen, "runStudy").enabled, false)
        }

        function test_a_study_with_cues_gives_advice_and_leads_to_run() {
            goTo("studies")
            tryVerify(() => find(room.screen, "runStudy").enabled, 20000)
            verify(says(room.screen, "right with this cue alone"))
            tap("runStudy")
            appears("operatorPage")
            tryVerify(() => room.operating.mayBegin, 20000)
            compare(room.operating.selected, 0)
        }

        function test_sessions_without_a_database_says_so() {
            goTo("sessions")
            verify(says(room.screen, "No session has been recorded yet"))
            compare(find(room.screen, "export").enabled, false)
        }

        function test_a_session_is_found_annotated_reported_and_resumed() {
            interrupt()
            tap("addNote")
            type("cold hands")
            tryVerify(() => says(room.screen, "• cold hands"), 5000)
            tap("search")
            type("cold t1")
            tryVerify(() => says(room.screen, "“cold t1”"), 1000)
            verify(shown("session0"))
            tap("search")
            tap("letterx")
            tryVerify(() => says(room.screen, "Sessions found: 0 of 1"), 1000)   // while it is typed
            tap("keepEntry")
            tryVerify(() => says(room.screen, "No session matches the search."), 1000)
            tap("clearSearch")
            for (const [order, heading] of [["byStudy", "short"], ["byParticipant", "T1"]]) {
                tap(order)
                tryVerify(() => says(room.screen, heading), 1000)
                verify(shown("session0"))
            }
            tap("byDate")
            verify(shown("session0"))
            tap("makeReport")
            appears("storedReport")
            tap("saveFigure")
            const saved = room.filesIn("figures").join(" ")
            for (const name of [/-1-column\.svg( |$)/, /-2-columns\.svg( |$)/, /-1-column\.pdf( |$)/, /-2-columns\.pdf( |$)/, /\.csv( |$)/, /\.txt( |$)/])
                verify(name.test(saved), name + ": " + saved)
            compare(room.startOf("figures", ".pdf", 5), "%PDF-")
            compare(room.startOf("figures", ".svg", 4), "<svg")
            tap("closeReport")
            verify(!shown("storedReport"))
            tap("resumeThis")
            tryVerify(() => !shown("stationPages"), 20000)
        }

        function test_an_export_goes_to_a_usb_stick_which_is_mounted_and_ejected() {
            interrupt()
            tap("export")
            verify(shown("noDisk"))
            room.plugIn()
            tap("lookAgain")
            verify(!shown("noDisk") && says(room.screen, "Test, 16 GB"))
            tap("exportStudy")
            tap("place1")
            tryVerify(() => says(room.screen, "files were written to"), 20000)
            const files = room.filesIn("stick")
            verify(files.some(file => /^turnpoint-export-[-0-9]+\/.*\/trials\.csv$/.test(file)), files.join(" "))
            compare(room.askedUdisks(), "mount")
            tap("eject1")
            tryVerify(() => says(room.screen, "can be unplugged now"), 5000)
            compare(room.askedUdisks(), "mount unmount power-off")
            verify(!shown("eject1"))
        }

        function test_sessions_are_ordered_by_study_and_by_participant_and_a_study_is_exported_alone() {
            room.recordSessions()
            goTo("sessions")
            tryVerify(() => shown("session3"), 5000)
            const lines = () => find(room.screen, "sessionsPage").sessions.sessions.map(line => (line.heading ? "[" + line.heading + "] " : "") + line.person + " " + line.protocol.split(" ")[0])
            compare(lines(), ["P01 bands", "P02 short", "P01 short", "P02 bands"])          // newest first
            tap("byStudy")
            compare(lines(), ["[bands] P01 bands", "P02 bands", "[short] P02 short", "P01 short"])
            tap("byParticipant")
            compare(lines(), ["[P01] P01 bands", "P01 short", "[P02] P02 short", "P02 bands"])
            // each heading stands above the first of its sessions, on the page as well
            const top = name => find(room.screen, name).mapToItem(room.screen, 0, 0).y
            const heading = text => all(find(room.screen, "sessions"), item => item.text === text)[0].mapToItem(room.screen, 0, 0).y
            verify(heading("P01") < top("session0") && top("session1") < heading("P02") && heading("P02") < top("session2"))
            tap("search")
            type("p02")
            compare(lines(), ["[P02] P02 short", "P02 bands"])
            tap("byStudy")
            compare(lines(), ["[bands] P02 bands", "[short] P02 short"])

            tap("session0")                                                                  // of bands, while only P02 is shown
            room.plugIn()
            tap("export")
            tap("exportStudy")
            tap("place1")
            tryVerify(() => says(room.screen, "files were written to"), 20000)
            const files = room.filesIn("stick")
            verify(files.some(file => /\/bands\/sessions\.csv$/.test(file)), files.join(" "))
            verify(!files.some(file => /short/.test(file)), files.join(" "))
            // the study, with the sessions that the search hides
            const rows = room.startOf("stick", "bands/sessions.csv", 100000).trim().split("\n")
            compare(rows.length, 3)
            verify(rows.some(row => row.includes("P01")) && rows.some(row => row.includes("P02")))
        }

        function test_a_backup_is_never_written_to_a_disk_that_is_only_a_folder() {
            interrupt()
            room.plugIn()
            tap("backUp")
            tap("place1")
            // In this test the stick is a folder on the database's own disk, as if somebody had pulled it
            // out. So the backup must be refused.
            tryVerify(() => says(room.screen, "There is no backup disk at this place.") && says(room.screen, "no disk is mounted"), 20000)
            compare(room.filesIn("stick"), [])
            tap("backUp")
            tap("place0")
            tryVerify(() => says(room.screen, "The backup was read back and checked."), 20000)
            verify(room.filesIn("backups").some(file => file.endsWith(".sqlite")))
        }

        function test_a_withdrawal_states_its_consequence_and_happens_only_when_confirmed() {
            interrupt()
            const place = appears("withdraw").mapToItem(room.screen, find(room.screen, "withdraw").width / 2, 10)
            for (let i = 0; i < 4; ++i) mouseClick(room.screen, place.x, place.y)
            tryVerify(() => shown("withdrawing"), 5000)
            for (let i = 0; i < 4; ++i) mouseClick(room.screen, place.x, place.y)
            wait(400)
            for (let i = 0; i < 4; ++i) mouseClick(room.screen, place.x, place.y)
            verify(shown("withdrawing"))
            verify(/^This would be deleted of T1: sessions: 1, trials: 2, /.test(find(room.screen, "withdrawing").text))
            verify(says(room.screen, "This cannot be undone."))
            room.pressKey(Qt.Key_Escape)
            verify(!shown("withdrawing") && shown("session0"))
            tap("withdraw")
            tap("keep")
            verify(!shown("withdrawing") && shown("session0"))
            tap("withdraw")
            // a short press deletes nothing
            tap("confirm")
            verify(shown("withdrawing"))
            const confirm = appears("confirm")
            mousePress(confirm, confirm.width / 2, confirm.height / 2)
            tryVerify(() => says(room.screen, "Deleted of T1"), 20000)
            mouseRelease(confirm)
            verify(!shown("session0"))
            verify(says(room.screen, "No session has been recorded yet"))
        }

        function test_a_study_that_was_not_saved_is_offered_after_the_program_was_killed() {
            goTo("studies")
            const design = find(room.screen, "stationPages").design
            verify(design.open(operating.folder + "/short.toml"))
            design.setText(design.text.replace("Four quick trials", "Changed trials"))
            room.reopen("1234")
            goTo("studies")
            tap("continueKept")
            const again = find(room.screen, "stationPages").design
            verify(again.text.includes("Changed trials") && again.unsaved)
            again.close()
            compare(again.kept, "")
        }

        function test_the_rig_is_examined_and_tested_and_other_pages_wait_meanwhile() {
            room.calibrate()
            goTo("rig")
            verify(says(room.screen, "In use"))
            verify(says(room.screen, "30 more days"))
            tap("examine")
            tryVerify(() => shown("finding0"), 60000)
            verify(says(room.screen, "converter"))
            tap("selfTestTab")
            const test = appears("selfTest")
            mouseClick(test)
            wait(100)
            verify(!shown("finding0"))
            mousePress(test)
            tryVerify(() => !find(room.screen, "bar-run").enabled, 3000)
            mouseRelease(test)
            tryVerify(() => shown("finding0") && find(room.screen, "bar-run").enabled, 60000)
            verify(says(room.screen, "gate"))
            verify(shown("gauge0"))
        }

        function test_the_force_cells_are_calibrated_with_dead_weights() {
            room.addCells()
            goTo("rig")
            tap("weightsTab")
            tap("weigh")
            tryVerify(() => says(room.screen, "Take everything off the surface."), 20000)
            verify(says(room.screen, "thousandths of the excitation"))
            verify(!find(room.screen, "bar-run").enabled)
            for (let step = 0; step < 39; ++step) {
                tryVerify(() => find(room.screen, "weightsRead").enabled, 20000)
                tap("weightsRead")
            }
            tryVerify(() => says(room.screen, "tap the middle of the plate once from above"), 20000)
            tap("weightsRead")
            tryVerify(() => says(room.screen, "tap the narrow end of the plate once along the plate"), 20000)
            tap("weightsRead")
            tryVerify(() => shown("finding0") && find(room.screen, "bar-run").enabled, 20000)
            verify(says(room.screen, "60 Hz; changes of force above 20 Hz are not measured correctly") && says(room.screen, "Uncertainty"))
            verify(says(room.screen, "200 g at 210 mm with a pull of 100 g towards the wide edge") && says(room.screen, "force cells"))
            tap("screen-de")
            verify(says(room.screen, "200 g bei 210 mm mit einem Zug von 100 g zum breiten Rand"))
        }

        function test_the_steps_of_the_weights_and_the_calibration_are_in_the_operators_language() {
            room.addCells()
            room.calibrate()
            goTo("rig")
            tap("screen-de")
            tryVerify(() => says(room.screen, "noch 30 Tage") && says(room.screen, "Übertragung, Reibung, Schallpegel"))
            tap("weightsTab")
            tap("weigh")
            tryVerify(() => says(room.screen, "Nehmen Sie alles von der Oberfläche."), 20000)
            tryVerify(() => says(room.screen, "Tausendstel der Speisung"))
            tap("weightsRead")
            tryVerify(() => says(room.screen, "Stellen Sie 20 g auf 30 mm vom breiten Rand."), 20000)
        }

        function enterReading(text) {
            tap("guideReading")
            for (const letter of text) tap("letter" + letter)
            tap("keepEntry")
        }
        function test_a_guided_calibration_measures_friction_point_by_point() {
            room.calibrate()
            goTo("rig")
            const guide = find(room.screen, "rigPage").rig.guide
            tap("guideTab")
            tap("guide-friction")
            verify(says(room.screen, "Friction · point 1 of 5"))
            verify(!find(room.screen, "guideFinish").enabled)
            tap("guidePlay")
            tryVerify(() => !guide.playing, 20000)
            compare(guide.problem, "")
            enterReading("1.7")                        // relative friction is at most 1.5
            verify(says(room.screen, "0 … 1.5"))
            tap("cancelEntry")
            compare(guide.entered, 0)
            for (const value of ["0.8", "0,7", "0.5", "0.3"]) {
                enterReading(value)
                tap("guideNext")
            }
            compare(guide.entered, 4)
            tap("guideFinish")
            tryVerify(() => says(room.screen, "Written to rig.calibration-"))
            verify(shown("guideFigure"))
            const csv = room.filesIn(".").find(name => name.includes("friction-"))
            verify(csv, room.filesIn("."))
            // the readings as they were entered, at the displacements of the tones, and the surface at rest
            compare(room.startOf(".", csv, 1000).trim().split("\n"), ["displacement_um,relative_friction", "0,1", "0.25,0.8", "0.5,0.7", "1,0.5", "2,0.3"])
            const made = room.filesIn(".").filter(name => name.includes("calibration-")).pop()
            const text = room.startOf(".", made, 100000)
            verify(text.includes("[[transducer]]") && text.includes("sound"), text)  // what was measured before is kept
            verify(says(room.screen, "response, friction, sound level"))
        }
        function test_a_guided_calibration_reads_boundaries_from_the_strip_and_forgets_them_if_left() {
            goTo("rig")
            const guide = find(room.screen, "rigPage").rig.guide
            tap("guideTab")
            tap("guide-boundaries")
            const strip = find(appears("sandStrip"), "dragArea")
            const mark = find(find(room.screen, "sandStrip"), "boundaryMark")
            const x = mark.x + mark.width / 2
            mousePress(strip, x, strip.height / 2)
            mouseMove(strip, x + 40, strip.height / 2)
            mouseRelease(strip, x + 40, strip.height / 2)
            const mm = Number(guide.point.value)
            verify(mm > 150 && mm < 300, mm)
            verify(says(room.screen, "Reading: " + mm + " mm"))
            const leave = appears("guideLeave")
            mouseClick(leave)
            compare(guide.entered, 1)                  // a tap is not enough
            mousePress(leave)
            tryCompare(guide, "chosen", "", 3000)
            mouseRelease(leave)
            tap("guide-boundaries")
            compare(guide.entered, 0)
            compare(room.filesIn(".").filter(name => name.includes("boundaries-")), [])
        }

        function test_while_a_tone_of_a_guided_calibration_plays_the_pick_ups_are_read() {
            room.addCells()
            goTo("rig")
            const guide = find(room.screen, "rigPage").rig.guide
            tap("guideTab")
            tap("guide-response")
            const sign = appears("guideSign"), picture = find(room.screen, "guidePicture")
            verify(picture.surface.wideEndLeft)
            fuzzyCompare(sign.x, picture.xOf(0), 1)   // on the strip, at its wide end
            compare(guide.readings, [])
            tap("guidePlay")
            tryVerify(() => guide.readings.length === 2, 20000)
            verify(guide.playing)
            verify(shown("guideLive"))
            verify(says(room.screen, "Pick-up on channel 5: ") && says(room.screen, "% of full scale"))
            tap("guidePlay")                          // stops the tone
            tryVerify(() => !guide.playing, 20000)
            compare(guide.readings.length, 2)         // the last reading stays until the next point
            tap("guideNext")
            compare(guide.readings, [])
        }
        function test_a_rig_without_real_buttons_says_why_the_panel_cannot_be_measured() {
            goTo("rig")
            tap("guideTab")
            for (const reference of ["panel_button", "panel_photodiode"]) {
                tap("guide-" + reference)
                tryVerify(() => says(room.screen, "they must be gpio:NAME=LINE"))
            }
        }
        function test_the_latency_of_the_panel_is_measured_on_a_page_of_its_own() {
            goTo("rig")
            const guide = find(room.screen, "rigPage").rig.guide
            room.pretendPanel(guide)
            tap("guideTab")
            tap("guide-panel_photodiode")
            appears("latencyField")
            verify(says(room.screen, "Fix the photodiode on the square at the left"))
            tap("latencyLeave")
            compare(guide.latency, null)
            tryVerify(() => find(room.screen, "latencyField") === null)
            tap("guide-panel_button")
            appears("latencyField")
            tap("bar-run")                            // leaving the page frees the button lines
            tryCompare(guide, "latency", null)
        }

        function test_weighing_can_be_stopped_and_writes_nothing_then() {
            room.addCells()
            goTo("rig")
            tap("weightsTab")
            tap("weigh")
            const stop = appears("weightsStop")
            tryVerify(() => stop.enabled, 20000)
            mousePress(stop)
            tryVerify(() => find(room.screen, "bar-run").enabled, 20000)
            mouseRelease(stop)
            verify(!shown("finding0"))
            verify(says(room.screen, "None. Make one"))
        }

        function test_language_theme_and_text_size_are_kept() {
            goTo("rig")
            tap("screen-de")
            verify(says(room.screen, "Kalibrierung") && says(room.screen, "Sitzungen"))
            tap("dark")
            tap("larger")
            compare(room.look.textPercent, 125)
            room.reopen("1234")
            appears("operatorPage")
            compare(room.look.language, "de")
            compare(room.look.dark, true)
            compare(room.look.textPercent, 125)
            verify(says(room.screen, "Studien"))
        }

        function test_the_pages_are_operated_by_keyboard() {
            appears("bar-sessions").forceActiveFocus()
            key(Qt.Key_Return)
            appears("sessionsPage")
            find(room.screen, "bar-rig").forceActiveFocus()
            key(Qt.Key_Space)
            appears("rigPage")
            const reached = []
            for (let i = 0; i < 30; ++i) {
                key(Qt.Key_Tab)
                const name = find(room.screen, "bar").Window.window.activeFocusItem.objectName
                if (!reached.includes(name)) reached.push(name)
            }
            for (const name of ["bar-run", "bar-studies", "dark", "larger", "doctorTab", "selfTestTab", "examine"])
                verify(reached.includes(name), name + " in " + reached.join(" "))
            find(room.screen, "dark").forceActiveFocus()
            key(Qt.Key_Space)
            compare(room.look.dark, true)
        }

        function test_an_amplifier_is_armed_by_keyboard_only_if_the_key_is_held() {
            appears("arm").forceActiveFocus()
            key(Qt.Key_Space)
            wait(50)
            compare(room.operating.armed, false)
            room.pressKey(Qt.Key_Space)
            tryVerify(() => room.operating.armed, 3000)
            room.releaseKey(Qt.Key_Space)
            compare(room.operating.armed, true)
        }

        function test_a_screen_reader_finds_every_control_of_each_page_with_a_name() {
            interrupt()
            for (const place of ["run", "studies", "sessions", "rig"]) {
                tap("bar-" + place)
                wait(50)
                compare(inspector.unnamedControls(room.screen), [], place)
                const found = inspector.controls(room.screen)
                verify(found.includes("tab: Sessions"), found.join("; "))
            }
            tap("bar-run")
            tryVerify(() => inspector.controls(room.screen).includes("button: Begin pilot"), 5000)
            goTo("sessions")
            tap("addNote")
            const found = inspector.controls(find(room.screen, "noting"))
            verify(found.includes("text: A note to be stored with the session"), found.join("; "))
            verify(found.includes("button: q"))
        }
    }
}
