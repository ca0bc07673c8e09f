import QtQuick
import Turnpoint

// The progress of the session: a bar and two numbers. It changes only between trials, because the session
// counts finished trials.
Item {
    id: root
    required property Theme theme
    required property int done
    required property int total
    /// about how many minutes are left; below 0 if that is not known
    property int minutes: -1
    required property Texts texts

    visible: total > 0
    implicitHeight: label.implicitHeight

    PlainText {
        id: label
        anchors { right: parent.right; verticalCenter: parent.verticalCenter }
        text: (root.minutes >= 0 ? root.texts.fill("minutes_left", "\u2068" + root.minutes + "\u2069") + "  ·  " : "") + "\u2066" + root.done + " / " + root.total + "\u2069"
        color: root.theme.quiet
        font.pixelSize: root.theme.textSmall
    }
    Rectangle {
        id: track
        anchors { left: parent.left; right: label.left; rightMargin: root.theme.unit; verticalCenter: parent.verticalCenter }
        height: Math.max(6, root.theme.unit)
        radius: height / 2
        // pale, so that an empty bar looks empty
        color: root.theme.raised
        border { color: root.theme.line; width: 1 }
        Rectangle {
            objectName: "progressDone"
            anchors.left: parent.left
            width: track.width * Math.min(1, root.done / Math.max(1, root.total))
            height: parent.height
            radius: height / 2
            color: root.theme.quiet
        }
    }
}
