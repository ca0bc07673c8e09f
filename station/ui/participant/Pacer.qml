import QtQuick
import Turnpoint

// A block that slides to and fro at the speed at which the finger is to slide: so many millimetres of the screen in
// a second. Where it is depends on nothing but the time since it began to move, so it tells nothing about a stimulus.
// It moves with the frames of the screen.
Item {
    id: root
    required property Theme theme
    required property double speedMmPerS
    property bool running: false
    /// time for which the block has been moving (s)
    readonly property double seconds: frames.elapsedTime
    readonly property double travel: Math.max(1, width - block.width)
    implicitHeight: Math.round(Math.max(3 * theme.pixelsPerMm, 2 * theme.unit))
    onRunningChanged: frames.reset()

    /// The distance of the block from the left end, in pixels, after this time.
    function placeAfter(seconds) {
        const way = (seconds * speedMmPerS * theme.pixelsPerMm) % (2 * travel)
        return way <= travel ? way : 2 * travel - way
    }

    Rectangle {
        anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter }
        height: root.theme.stroke
        color: root.theme.quiet
    }
    Rectangle {
        id: block
        objectName: "pacerBlock"
        visible: root.running
        x: root.placeAfter(root.seconds)
        width: 3 * root.theme.unit
        height: parent.height
        radius: Math.round(0.4 * root.theme.unit)
        color: root.theme.ink
    }
    FrameAnimation {
        id: frames
        running: root.running
    }
}
