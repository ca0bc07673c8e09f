import QtQuick
import Turnpoint

// Explains the next block: the instruction, its text, and the surface with the place to slide.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property SessionBridge bridge
    property bool armed: true
    readonly property PageModel page: bridge.page

    InstructionBadge {
        id: badge
        anchors { horizontalCenter: parent.horizontalCenter; top: parent.top }
        theme: root.theme
        texts: root.texts
        instruction: root.page.instruction
        size: Math.round(0.8 * root.theme.textTitle)
    }
    PlainText {
        id: title
        visible: text !== "" && !badge.visible
        anchors { left: parent.left; right: parent.right; top: parent.top }
        text: root.texts.phrased(root.page.title)
        color: root.theme.ink
        font { pixelSize: root.theme.textTitle; weight: Font.Bold }
        wrapMode: Text.Wrap
        horizontalAlignment: Text.AlignHCenter
    }
    PagedText {
        id: words
        theme: root.theme
        texts: root.texts
        armed: root.armed
        anchors {
            left: parent.left; right: parent.right
            top: badge.visible ? badge.bottom : title.bottom; topMargin: root.theme.unit
            bottom: surface.visible ? surface.top : go.top; bottomMargin: root.theme.unit
        }
        text: root.texts.phrased(root.page.text)
    }
    SurfaceDrawing {
        id: surface
        visible: root.page.surface.lengthMm > 0
        anchors { left: parent.left; right: parent.right; bottom: go.top; bottomMargin: root.theme.unit }
        // gives way to a text that does not fit beside it
        height: Math.round(Math.max(7 * root.theme.unit, Math.min(0.32 * parent.height, parent.height - go.height - heading - words.natural - 4 * root.theme.unit)))
        readonly property real heading: badge.visible ? badge.height : title.visible ? title.height : 0
        surface: root.page.surface
        hasMark: root.page.hasMark
        markMm: root.page.markMm
        showFinger: true
        textPixels: root.theme.textSmall
        ink: root.theme.ink
        paper: root.theme.paper
        accent: root.theme.action
    }
    ActionButton {
        id: go
        objectName: "proceed"
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
        width: Math.min(Math.max(implicitWidth, 26 * root.theme.unit), root.width - 2 * root.theme.targetMin - 4 * root.theme.unit)
        theme: root.theme
        armed: root.armed
        text: root.texts.proceed
        onActivated: if (!words.turn()) root.bridge.next()
    }
    TextTurner {
        theme: root.theme
        texts: root.texts
        of: words
        armed: root.armed
        between: go.width
        anchors { left: parent.left; right: parent.right; verticalCenter: go.verticalCenter }
    }
}
