import Turnpoint

// A test of the whole program in its own window, room.screen (station_room.hpp).
PageTest {
    readonly property PageModel page: room.page
    readonly property OperatorController operating: room.operating

    function shown(name, parent = room.screen) { return find(parent, name) !== null }
    /// Waits until the item is there and reacts to taps, and returns it.
    function appears(name, parent = room.screen) {
        tryVerify(() => shown(name, parent), 20000, name)
        wait(60)
        // A page accepts taps only after it has been shown for a while.
        tryVerify(() => shown(name, parent) && find(parent, name).enabled && find(parent, name).armed !== false, 20000, name + " reacts")
        return find(parent, name)
    }
    function tap(name, parent = room.screen) {
        const button = appears(name, parent)
        mouseClick(button, button.width / 2, button.height / 2)
    }
    /// Touches an answer on the participant's screen with one finger.
    function answer(choice) {
        tryCompare(page, "answersOpen", true, 20000)
        wait(150)
        const button = find(room.screen, "answer" + choice)
        const touch = touchEvent(button)
        touch.press(1, button).commit()
        touch.release(1, button).commit()
        tryCompare(page, "answersOpen", false, 5000)
    }
    function begin(participant) {
        tryVerify(() => operating.mayBegin, 20000)
        tap("language0")
        tap("enterCode")
        for (const key of participant) tap("key" + key)
        tap("accept")
        tap("begin")
    }
    function rest() {
        tryCompare(page, "kind", PageModel.Rest, 20000)
        tryCompare(page, "remainingSeconds", 0, 5000)
        tap("proceed")
    }
    function ends() { tryCompare(page, "kind", PageModel.End, 20000) }
}
