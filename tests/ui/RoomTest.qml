// A test of the whole program in its own window, room.screen (station_room.hpp).
PageTest {
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
}
