import QtQuick
import Turnpoint

// Asks what a new study is to measure, with a list of goals.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property var goals
    signal chosen(word: string)
    signal closed()

    PlainText {
        id: heading
        anchors { left: parent.left; right: leave.left; top: parent.top; margins: root.theme.margin }
        height: root.theme.controlHeight
        text: root.texts.text("design.what_to_measure")
        color: root.theme.ink
        font { pixelSize: root.theme.textTitle; weight: Font.Bold }
        verticalAlignment: Text.AlignVCenter
        fontSizeMode: Text.Fit
        minimumPixelSize: 10
        wrapMode: Text.Wrap
    }
    ActionButton {
        id: leave
        objectName: "closeDesign"
        anchors { right: parent.right; top: parent.top; margins: root.theme.margin }
        theme: root.theme
        primary: false
        text: root.texts.close
        onActivated: root.closed()
    }
    GridView {
        id: list
        objectName: "goals"
        anchors { left: parent.left; right: parent.right; top: heading.bottom; bottom: parent.bottom; margins: root.theme.margin; rightMargin: root.theme.margin - root.theme.unit }
        clip: true
        boundsBehavior: Flickable.StopAtBounds
        readonly property int columns: width > 100 * root.theme.textBody ? 3 : width > 44 * root.theme.textBody ? 2 : 1
        cellWidth: Math.floor(width / columns)
        cellHeight: Math.max(root.theme.controlHeight, 4.6 * root.theme.textBody) + root.theme.unit
        model: root.goals
        delegate: Item {
            id: cell
            required property var modelData
            width: list.cellWidth
            height: list.cellHeight
            Rectangle {
                objectName: "goal-" + cell.modelData.word
                anchors { fill: parent; rightMargin: root.theme.unit; bottomMargin: root.theme.unit }
                radius: root.theme.radius
                color: tap.pressed ? root.theme.action : root.theme.raised
                border { color: activeFocus ? root.theme.ink : root.theme.line; width: activeFocus ? root.theme.stroke : root.theme.stroke / 2 }
                activeFocusOnTab: true
                Accessible.role: Accessible.Button
                Accessible.name: cell.modelData.says
                Accessible.onPressAction: root.chosen(cell.modelData.word)
                Keys.onReturnPressed: root.chosen(cell.modelData.word)
                Keys.onSpacePressed: root.chosen(cell.modelData.word)
                PlainText {
                    readAloud: false
                    anchors { fill: parent; margins: root.theme.unit }
                    text: cell.modelData.says.charAt(0).toUpperCase() + cell.modelData.says.slice(1)
                    color: tap.pressed ? root.theme.actionText : root.theme.ink
                    font.pixelSize: root.theme.textBody
                    verticalAlignment: Text.AlignVCenter
                    wrapMode: Text.Wrap
                    maximumLineCount: 3
                    elide: Text.ElideRight
                }
                TapHandler {
                    id: tap
                    gesturePolicy: TapHandler.ReleaseWithinBounds
                    onTapped: root.chosen(cell.modelData.word)
                }
            }
        }
    }
    ScrollCue { theme: root.theme; place: list }
}
