import QtQuick
import Turnpoint

// The list of protocols in the station's folder. The operator chooses one of them.
Rectangle {
    id: root
    required property Theme theme
    required property var protocols
    required property int selected
    required property string emptyText
    required property string unusableText
    signal chosen(index: int)

    radius: theme.radius
    color: theme.raised
    border { color: theme.line; width: 1 }
    PlainText {
        objectName: "noProtocols"
        visible: root.protocols.length === 0
        anchors { fill: parent; margins: Math.round(1.4 * root.theme.unit) }
        text: root.emptyText
        color: root.theme.ink
        font.pixelSize: root.theme.textBody
        wrapMode: Text.Wrap
    }
    ListView {
        id: list
        objectName: "protocols"
        anchors { fill: parent; margins: Math.round(0.5 * root.theme.unit) }
        clip: true
        boundsBehavior: Flickable.StopAtBounds
        spacing: Math.round(0.3 * root.theme.unit)
        // The number of protocols, not the list itself: the list is a new one whenever the page changes, and with a new
        // model the view would forget how far it was scrolled.
        model: root.protocols.length
        currentIndex: root.selected
        keyNavigationEnabled: true
        function showChosen() { if (root.selected >= 0 && root.selected < count) positionViewAtIndex(root.selected, ListView.Contain) }
        onCurrentIndexChanged: showChosen()
        onCountChanged: showChosen()
        onHeightChanged: showChosen()
        delegate: Rectangle {
            id: card
            required property int index
            readonly property var entry: root.protocols[index] ?? { id: "", title: "", usable: true }
            readonly property bool chosen: index === root.selected
            objectName: "protocol" + index
            Accessible.role: Accessible.ListItem
            Accessible.name: entry.id + ", " + (entry.usable ? entry.title : root.unusableText)
            Accessible.selected: chosen
            Accessible.onPressAction: root.chosen(index)
            activeFocusOnTab: true
            Keys.onSpacePressed: root.chosen(index)
            Keys.onReturnPressed: root.chosen(index)
            border { color: root.theme.ink; width: activeFocus ? root.theme.stroke : 0 }
            width: list.width
            height: Math.max(root.theme.controlHeight, words.implicitHeight + root.theme.unit)
            radius: root.theme.radius
            color: chosen ? root.theme.action : root.theme.raised
            Column {
                id: words
                anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter; margins: Math.round(0.9 * root.theme.unit) }
                PlainText {
                    readAloud: false
                    width: parent.width
                    text: card.entry.id
                    color: card.chosen ? root.theme.actionText : root.theme.ink
                    font { pixelSize: root.theme.textBody; weight: Font.DemiBold }
                    elide: Text.ElideRight
                }
                PlainText {
                    readAloud: false
                    width: parent.width
                    text: card.entry.usable ? card.entry.title : root.unusableText
                    color: card.chosen ? root.theme.actionText : card.entry.usable ? root.theme.quiet : root.theme.wrong
                    font.pixelSize: root.theme.textSmall
                    wrapMode: Text.Wrap
                    maximumLineCount: 3
                    elide: Text.ElideRight
                }
            }
            TapHandler { onTapped: root.chosen(card.index) }
        }
    }
    ScrollCue { theme: root.theme; place: list }
}
