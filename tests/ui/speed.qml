import QtQuick
import QtTest
import Turnpoint

// A benchmark, not a test: how soon the screen shows that it was pressed, and how many frames are late in a session
// with a person. tests/ui/speed runs it and prints the table.
Item {
    width: 1280
    height: 800

    RoomTest {
        name: "Speed"
        when: windowShown

        function report(what, values) {
            values.sort((a, b) => a - b)
            const share = p => values[Math.min(values.length - 1, Math.floor(p * values.length))].toFixed(1)
            console.info("measured: " + what + ": median " + share(0.5) + ", 95 % " + share(0.95) + ", longest " + share(1) + " ms, n = " + values.length)
        }

        function test_presses_on_the_operators_pages() {
            room.open("7391")
            tryVerify(() => operating.mayBegin, 20000)
            const waits = []
            for (const place of ["studies", "sessions", "rig", "run"]) {
                tap("bar-" + place)
                appears(place === "run" ? "operatorPage" : place + "Page")
                for (let k = 0; k < 5; ++k) for (const other of ["studies", "sessions", "rig", "run"]) {
                    if (other === place) continue
                    const ms = room.pressUntilShown(appears("bar-" + other))
                    verify(ms >= 0, other + " shows nothing")
                    waits.push(ms)
                }
            }
            report("press to picture, operator's bar", waits)
            room.close()
        }

        /// Answers the four trials of a session, and returns how long each press took to show.
        function session(participant, paced) {
            const waits = []
            begin(participant)
            tap("proceed")
            if (paced) tryVerify(() => shown("pacerBlock"), 10000)
            room.lookOn()
            for (let k = 0; k < 4; ++k) {
                tryCompare(page, "answersOpen", true, 20000)
                wait(150)
                const ms = room.pressUntilShown(appears("answer0"))
                verify(ms >= 0, "the answer shows nothing")
                waits.push(ms)
                tryCompare(page, "answersOpen", false, 5000)
                if (k === 1) rest()
            }
            ends()
            return waits
        }

        function test_presses_and_late_frames_data() {
            return [{tag: "answers", paced: false}, {tag: "answers, with bars and the pacer", paced: true}]
        }
        function test_presses_and_late_frames(row) {
            let waits = []
            let lost = 0, seen = 0, trials = 0
            for (const participant of ["T2", "T3", "T4", "T5"]) {
                room.open("7391")
                if (row.paced) {
                    room.addCells()
                    room.addGuidance()
                    room.reopen("7391")
                }
                waits = waits.concat(session(participant, row.paced))
                seen += room.stallsSeen()
                for (const frames of room.column("events.csv", "value", "kind", "frames_lost")) lost += Number(frames)
                trials += room.column("trials.csv", "trial_index").length
                room.close()
            }
            report("press to picture, " + row.tag, waits)
            console.info("measured: late frames: " + lost + " in " + trials + " trials; this machine itself was late " + seen + " times")
        }
    }
}
