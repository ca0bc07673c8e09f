import QtQuick
import Turnpoint

// The progress of the session: a bar and two numbers. It changes only between trials, because the session
// counts finished trials.
Item {
    id: root
    required property Theme theme
    required property int done
    required property int total

    visible: total > 0
    implicitHeight: label.implicitHeight

    PlainText {
        id: label
        anchors { right: parent.right; verticalCenter: parent.verticalCenter }
        text: root.done + " / " + root.total
        color: root.theme.quiet
        font.pixelSize: root.theme.textSmall
    }
    Rectangle {
        id: track
        anchors { left: parent.left; right: label.left; rightMargin: root.theme.unit; verticalCenter: parent.verticalCenter }
        height: 0.7 * root.theme.unit
        radius: height / 2
        color: root.theme.line
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
