import QtQuick
import Turnpoint

// A button for everything except answers. It acts only if a press both begins and ends on it while the button
// is armed, so that a tap meant for the previous page never triggers it. It also acts if another finger rests
// elsewhere on the screen.
Rectangle {
    id: root
    required property Theme theme
    property string text
    property string glyph
    property real size: theme.textBody
    property bool armed: true
    property bool primary: true
    property bool quiet: false
    /// True for an action that cannot be undone.
    property bool danger: false
    /// If above 0, the button must be held for this number of milliseconds. It fills up in that time.
    property int holdMs: 0
    /// True if the button acts as soon as the finger comes down, not when it is lifted.
    property bool atOnce: false
    /// What a screen reader says. Needed for a button without a text.
    property string label: text
    readonly property bool down: tap.pressed || keyHeld
    property bool keyHeld: false
    signal activated()

    readonly property color tint: danger ? theme.wrong : theme.action
    readonly property bool filled: holdMs > 0 ? primary && !down : primary !== down
    readonly property color foreground: filled ? theme.actionText : quiet ? theme.quiet : tint

    implicitHeight: theme.controlHeight
    // even, so that a button in the middle of a place is on whole pixels
    implicitWidth: 2 * Math.ceil((theme.dense ? row.implicitWidth + 3 * theme.unit : Math.max(row.implicitWidth + 5 * theme.unit, theme.targetMin)) / 2)
    radius: theme.radius
    color: filled ? tint : quiet ? theme.paper : theme.raised
    border { color: quiet ? theme.line : tint; width: quiet ? theme.stroke / 2 : theme.stroke }
    opacity: enabled ? 1 : 0.35

    Accessible.role: Accessible.Button
    Accessible.name: label
    Accessible.focusable: theme.dense
    Accessible.onPressAction: if (enabled && armed && holdMs === 0) activated()

    // The operator's pages can be used with a keyboard or with switches. A participant answers by touch or with the
    // response buttons of the rig, so a key must do nothing there.
    activeFocusOnTab: theme.dense
    Keys.onPressed: event => {
        if (event.key !== Qt.Key_Space && event.key !== Qt.Key_Return && event.key !== Qt.Key_Enter) return
        event.accepted = true
        if (!theme.dense || !enabled || !armed || event.isAutoRepeat) return
        tap.done = false
        keyHeld = holdMs > 0
        if (holdMs === 0) activated()
    }
    Keys.onReleased: event => { if (!event.isAutoRepeat) keyHeld = false }
    onActiveFocusChanged: if (!activeFocus) keyHeld = false

    Rectangle {
        visible: root.activeFocus && root.theme.dense
        anchors { fill: parent; margins: -2 * root.theme.stroke }
        radius: root.radius + 2 * root.theme.stroke
        color: "transparent"
        border { color: root.theme.ink; width: root.theme.stroke }
    }
    Rectangle {
        visible: root.holdMs > 0 && root.down
        anchors { left: parent.left; top: parent.top; bottom: parent.bottom }
        width: parent.width * root.held
        radius: root.radius
        color: root.theme.warning
    }
    property real held: 0
    NumberAnimation {
        target: root
        property: "held"
        running: root.holdMs > 0 && root.down
        from: 0
        to: 1
        duration: Math.max(1, root.holdMs)
        onFinished: {
            tap.done = true
            root.activated()
        }
    }

    Row {
        id: row
        anchors.centerIn: parent
        spacing: root.theme.unit
        Glyph {
            visible: root.glyph !== ""
            name: root.glyph
            color: root.foreground
            height: root.size * 1.1
            anchors.verticalCenter: parent.verticalCenter
        }
        PlainText {
            readAloud: false
            visible: root.text !== ""
            text: root.text
            color: root.foreground
            font { pixelSize: root.size; weight: Font.DemiBold }
            anchors.verticalCenter: parent.verticalCenter
        }
    }
    TapHandler {
        id: tap
        /// True if this press has already triggered the action, which may have changed the button into one
        /// that need not be held.
        property bool done: false
        enabled: root.enabled && root.armed
        gesturePolicy: TapHandler.ReleaseWithinBounds
        onPressedChanged: {
            if (!pressed) return
            done = root.atOnce
            if (root.atOnce) root.activated()
        }
        onTapped: if (root.holdMs === 0 && !done) root.activated()
    }
}
