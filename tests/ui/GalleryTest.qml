import QtQuick
import QtTest
import Turnpoint

// A test that shows single pages of the gallery (scripted_session.hpp) on panels of different sizes.
PageTest {
    required property ParticipantView view

    SignalSpy { id: spy; target: script.bridge; signalName: "shown" }

    /// Shows a page of the gallery, and waits until it is on the screen.
    function show(page, language = "en") {
        const before = spy.count
        script.show(page, language)
        tryCompare(spy, "count", before + 1)
    }
    /// Gives the window the size of this panel.
    function resize(panel) {
        const stage = view.parent
        stage.width = panel.width
        stage.height = panel.height
        tryCompare(stage.Window.window, "width", panel.width)
        view.pixelsPerMm = panel.mm
    }
}
