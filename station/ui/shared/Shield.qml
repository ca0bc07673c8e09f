import QtQuick

// Keeps touches from reaching what lies below a dialog or a page. It is no control, so a screen reader need not find it.
MouseArea {
    readonly property bool shield: true
    anchors.fill: parent
}
