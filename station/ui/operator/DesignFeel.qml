import QtQuick
import Turnpoint

// Plays a scene on the rig. On a real rig the button must be held, because it arms the amplifier; Stop acts at once.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property Feeling feeling
    required property string scene
    readonly property bool playing: feeling.playing === scene
    height: Math.max(button.height, says.implicitHeight)

    ActionButton {
        id: button
        objectName: "feel-" + root.scene
        anchors.left: parent.left
        theme: root.theme
        primary: root.playing
        danger: root.playing
        atOnce: root.playing
        enabled: root.playing || root.feeling.possible
        glyph: root.playing ? "cross" : "run"
        holdMs: !root.playing && root.feeling.real ? 900 : 0
        text: root.texts.text(root.playing ? "design.feel_stop" : root.feeling.real ? "design.feel_hold" : "design.feel")
        onActivated: {
            if (root.playing) root.feeling.stop()
            else root.feeling.play(root.scene)
        }
    }
    PlainText {
        id: says
        objectName: "feltSays-" + root.scene
        anchors { left: button.right; leftMargin: root.theme.unit; right: parent.right; verticalCenter: parent.verticalCenter }
        readonly property bool mine: root.feeling.last === root.scene && !root.playing
        text: mine && root.feeling.problem !== "" ? root.texts.say(root.feeling.problem)
            : mine && root.feeling.tones > 0 ? root.texts.fill(root.feeling.real ? "design.felt" : "design.felt_simulated", Number(root.feeling.seconds.toFixed(2)), root.feeling.tones, root.feeling.peakPercent)
            : root.feeling.real ? root.texts.text("design.feel_text") : ""
        color: mine && root.feeling.problem !== "" ? root.theme.wrong : root.theme.quiet
        font.pixelSize: root.theme.textSmall
        wrapMode: Text.Wrap
    }
}
