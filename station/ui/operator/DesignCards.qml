import QtQuick
import Turnpoint

// The parts of a session in their order, as cards. A card is dragged by its grip, with a finger or a mouse: a line
// marks where it would come, and near an edge of the view the page scrolls. A tap on a card shows its form. Whoever
// cannot drag has the buttons in the form of each part.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property DesignController design
    /// the tables of the page, in the order of the session
    required property var parts
    required property Flickable view
    signal chosen(group: int)

    readonly property real cardHeight: Math.max(theme.controlHeight, Math.ceil(1.4 * (theme.textBody + theme.textSmall) + theme.unit))
    readonly property real step: cardHeight + Math.round(0.5 * theme.unit)
    /// The card that is dragged, and the place between two cards where it would come, from 0; -1 if none is dragged.
    property int held: -1
    property int place: -1
    /// Where the finger is in the view, and on the card.
    property real finger: 0
    property real grabbed: 0
    property real lifted: 0

    implicitHeight: parts.length * step
    height: implicitHeight
    z: held >= 0 ? 1 : 0  // the lifted card is above the forms that follow
    onPartsChanged: letGo()

    function follow() {
        lifted = mapFromItem(view, 0, finger).y - grabbed
        place = Math.max(0, Math.min(parts.length, Math.round((lifted + 0.5 * cardHeight) / step)))
    }
    /// What a card says below its name. The figures are those of the last check; none are shown while it runs.
    function lengthOf(index: int) : string {
        if (design.verdict === "checking") return texts.text("operator.checking")
        if (design.verdict === "bad") return texts.text("design.length_unknown")
        return texts.say(design.lengths[index] ?? "")
    }
    /// Ends the dragging and changes nothing.
    function letGo() {
        held = -1
        place = -1
    }
    function drop() {
        const from = held, to = place > held ? place - 1 : place
        letGo()
        if (to !== from) design.place(from, to)
    }

    Repeater {
        model: root.parts
        Rectangle {
            id: card
            required property var modelData
            required property int index
            readonly property bool dragged: root.held === index
            readonly property bool filled: dragged || tap.pressed
            objectName: "card" + index
            width: root.width
            height: root.cardHeight
            y: dragged ? root.lifted : index * root.step
            z: dragged ? 1 : 0
            radius: root.theme.radius
            color: filled ? root.theme.action : root.theme.paper
            border { color: body.activeFocus || dragged ? root.theme.ink : root.theme.line; width: body.activeFocus || dragged ? root.theme.stroke : root.theme.stroke / 2 }
            Item {
                id: body
                anchors.fill: parent
                activeFocusOnTab: true
                Accessible.role: Accessible.Button
                Accessible.name: name.text + (length.text === "" ? "" : ", " + length.text)
                Accessible.onPressAction: root.chosen(card.index)
                Keys.onReturnPressed: root.chosen(card.index)
                Keys.onSpacePressed: root.chosen(card.index)
                Column {
                    anchors { left: grip.visible ? grip.right : parent.left; right: parent.right; verticalCenter: parent.verticalCenter; leftMargin: grip.visible ? 0 : root.theme.unit; rightMargin: root.theme.unit }
                    PlainText {
                        id: name
                        readAloud: false
                        width: parent.width
                        horizontalAlignment: Text.AlignLeft
                        text: root.design.label([card.modelData.kind], root.texts.language) + (card.modelData.name === "" ? "" : "  “" + card.modelData.name + "”")
                        color: card.filled ? root.theme.actionText : root.theme.ink
                        font { pixelSize: root.theme.textBody; weight: Font.DemiBold }
                        elide: Text.ElideRight
                    }
                    PlainText {
                        id: length
                        objectName: "length" + card.index
                        readAloud: false
                        width: parent.width
                        horizontalAlignment: Text.AlignLeft
                        visible: text !== ""
                        text: root.lengthOf(card.index)
                        color: card.filled ? root.theme.actionText : root.theme.quiet
                        font.pixelSize: root.theme.textSmall
                        elide: Text.ElideRight
                    }
                }
                MouseArea {
                    id: grip
                    objectName: "grip" + card.index
                    anchors { left: parent.left; top: parent.top; bottom: parent.bottom }
                    width: height
                    visible: card.modelData.copied
                    preventStealing: true
                    property real from
                    function move(y: real) {
                        root.finger = mapToItem(root.view, 0, y).y
                        root.follow()
                    }
                    onPressed: mouse => {
                        from = mapToItem(root.view, 0, mouse.y).y
                        root.grabbed = mouse.y
                    }
                    onPositionChanged: mouse => {
                        // a finger that only taps moves a little, too
                        const far = Math.abs(mapToItem(root.view, 0, mouse.y).y - from) > Application.styleHints.startDragDistance
                        if (root.held < 0 && far) root.held = card.index
                        if (root.held >= 0) move(mouse.y)
                    }
                    onReleased: mouse => {
                        if (root.held < 0) return
                        const at = mapToItem(root, mouse.x, mouse.y)
                        const beside = at.x < -root.step || at.x > root.width + root.step || at.y < -2 * root.step || at.y > root.height + 2 * root.step
                        if (beside) root.letGo()
                        else root.drop()
                    }
                    onCanceled: root.letGo()
                    Column {
                        anchors.centerIn: parent
                        spacing: Math.max(2, Math.round(0.4 * root.theme.unit))
                        Repeater {
                            model: 3
                            Rectangle {
                                width: Math.round(0.4 * grip.width)
                                height: root.theme.stroke
                                color: card.filled ? root.theme.actionText : root.theme.quiet
                            }
                        }
                    }
                }
                TapHandler {
                    id: tap
                    gesturePolicy: TapHandler.ReleaseWithinBounds
                    onTapped: root.chosen(card.index)
                }
            }
        }
    }
    Rectangle {
        objectName: "placeMark"
        visible: root.place >= 0
        z: 2
        width: root.width
        height: 2 * root.theme.stroke
        y: root.place * root.step - Math.round(0.25 * root.theme.unit) - root.theme.stroke
        color: root.theme.warning
    }
    Timer {
        // pixels of a frame: the nearer to the edge, the faster
        readonly property real edge: 1.2 * root.theme.controlHeight
        readonly property real speed: root.finger < edge ? root.finger - edge : root.finger > root.view.height - edge ? root.finger - root.view.height + edge : 0
        running: root.held >= 0 && speed !== 0
        interval: 16
        repeat: true
        onTriggered: {
            // no further than to the first and the last card
            const now = root.view.contentY, top = root.mapToItem(root.view.contentItem, 0, 0).y
            const least = Math.max(0, Math.min(now, top - root.step))
            const most = Math.max(now, Math.min(root.view.contentHeight - root.view.height, top + root.height + root.step - root.view.height))
            root.view.contentY = Math.max(least, Math.min(most, now + Math.max(-24, Math.min(24, 0.25 * speed))))
            root.follow()
        }
    }
}
