import QtQuick
import Turnpoint

// The participant's pages of the draft: the same pages as in a session, in each of the study's languages and as they
// look on screens of common sizes.
Rectangle {
    id: root
    required property Theme theme
    required property Texts texts
    required property PagesPreview pages
    // Diagonal in inches, size in pixels, and pixels per millimetre. The first one is this screen.
    required property size here
    readonly property var screens: [
        { inches: 0, width: here.width, height: here.height, density: theme.pixelsPerMm },
        { inches: 5, width: 800, height: 480, density: 7.36 },
        { inches: 7, width: 800, height: 480, density: 5.2 },
        { inches: 10, width: 1280, height: 800, density: 5.9 },
        { inches: 10, width: 800, height: 1280, density: 5.9 },
        { inches: 16, width: 1920, height: 1080, density: 5.6 }]
    property int size: 3
    readonly property var screen: screens[size]

    radius: theme.radius
    color: theme.raised
    border { color: theme.line; width: 1 }

    component Stepper: Item {
        id: stepper
        property string says
        property string what
        property int at
        property int count
        signal chosen(index: int)
        height: root.theme.controlHeight
        ActionButton {
            id: earlier
            objectName: stepper.objectName + "-previous"
            anchors.left: parent.left
            theme: root.theme
            primary: false
            enabled: stepper.at > 0
            glyph: root.texts.mirrored ? "next" : "previous"
            label: root.texts.fill("design.previous", stepper.what)
            onActivated: stepper.chosen(stepper.at - 1)
        }
        PlainText {
            objectName: stepper.objectName + "-says"
            anchors { left: earlier.right; right: later.left; verticalCenter: parent.verticalCenter; leftMargin: Math.round(0.5 * root.theme.unit); rightMargin: Math.round(0.5 * root.theme.unit) }
            height: parent.height
            text: stepper.says
            color: root.theme.ink
            font { pixelSize: root.theme.textBody; weight: Font.DemiBold }
            horizontalAlignment: Text.AlignHCenter
            verticalAlignment: Text.AlignVCenter
            wrapMode: Text.Wrap
            fontSizeMode: Text.Fit
            minimumPixelSize: 0.7 * root.theme.textSmall
        }
        ActionButton {
            id: later
            objectName: stepper.objectName + "-next"
            anchors.right: parent.right
            theme: root.theme
            primary: false
            enabled: stepper.at < stepper.count - 1
            glyph: root.texts.mirrored ? "previous" : "next"
            label: root.texts.fill("design.next", stepper.what)
            onActivated: stepper.chosen(stepper.at + 1)
        }
    }

    Column {
        id: choices
        anchors { left: parent.left; right: parent.right; top: parent.top; margins: root.theme.unit }
        spacing: Math.round(0.5 * root.theme.unit)
        Flow {
            width: parent.width
            spacing: Math.round(0.5 * root.theme.unit)
            Repeater {
                model: root.pages.languages
                ChoiceButton {
                    required property string modelData
                    objectName: "pageLanguage-" + modelData
                    theme: root.theme
                    chosen: root.pages.language === modelData
                    text: modelData
                    onActivated: root.pages.choose(modelData)
                }
            }
        }
        Stepper {
            objectName: "pageSize"
            width: parent.width
            what: root.texts.text("design.screen_size")
            at: root.size
            count: root.screens.length
            says: (root.screen.inches === 0 ? root.texts.text("operator.screen") : root.screen.inches + "″") + " · " + root.screen.width + " × " + root.screen.height
            onChosen: index => root.size = index
        }
        Stepper {
            objectName: "page"
            width: parent.width
            what: root.texts.text("design.pages")
            at: root.pages.shown
            count: root.pages.names.length
            says: count === 0 ? "" : root.texts.text(root.pages.names[at]) + " · " + root.texts.fill("design.page_of", at + 1, count)
            onChosen: index => root.pages.show(index)
        }
        PlainText {
            objectName: "pagesProblem"
            visible: text !== ""
            width: parent.width
            text: root.pages.problem !== "" ? root.texts.say(root.pages.problem) : root.stale ? root.texts.text("design.pages_stale") : ""
            color: root.theme.quiet
            font.pixelSize: root.theme.textSmall
            wrapMode: Text.Wrap
        }
    }
    /// True while the text cannot be read, so that the pages are those of an earlier text.
    property bool stale: false

    Item {
        id: room
        anchors { left: parent.left; right: parent.right; top: choices.bottom; bottom: parent.bottom; margins: root.theme.unit }
        readonly property real share: Math.min(width / root.screen.width, height / root.screen.height, 1)
        Rectangle {
            anchors.centerIn: parent
            width: root.screen.width * room.share + 2 * border.width
            height: root.screen.height * room.share + 2 * border.width
            color: "transparent"
            border { color: root.theme.ink; width: root.theme.stroke }
            visible: view.visible
        }
        Item {
            anchors.centerIn: parent
            width: root.screen.width * room.share
            height: root.screen.height * room.share
            clip: true
            ParticipantView {
                id: view
                objectName: "previewView"
                visible: root.pages.names.length > 0
                width: root.screen.width
                height: root.screen.height
                transformOrigin: Item.TopLeft
                scale: room.share
                bridge: root.pages.bridge
                pixelsPerMm: root.screen.density
                preview: true
            }
            // A tap on the page leads to the next one; its own buttons do nothing here.
            MouseArea {
                objectName: "previewShield"
                anchors.fill: parent
                Accessible.role: Accessible.Button
                Accessible.name: root.texts.fill("design.next", root.texts.text("design.pages"))
                onClicked: root.pages.show((root.pages.shown + 1) % root.pages.names.length)
            }
        }
    }
}
