import QtQuick
import Turnpoint

// One page of an explanation: a text, perhaps a picture, and perhaps examples that participants can feel as
// often as they like. While an example is presented, nothing can be pressed.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property SessionBridge bridge
    property bool armed: true
    readonly property PageModel page: bridge.page
    readonly property bool illustrated: page.picture !== ""
    readonly property bool feels: page.answers.length > 0
    /// A picture that would be small above its text stands beside it.
    readonly property real share: feels ? 0.4 : 0.58
    readonly property bool beside: illustrated && width > height && share * upper.height < 20 * theme.pixelsPerMm

    Item {
        id: upper
        anchors {
            left: parent.left; right: parent.right; top: parent.top
            bottom: root.feels ? examples.top : go.top; bottomMargin: root.theme.unit
        }
        Image {
            id: picture
            objectName: "picture"
            visible: root.illustrated
            anchors { left: parent.left; top: parent.top }
            width: Math.round((root.beside ? 0.42 : 1) * parent.width)
            height: root.illustrated ? Math.round((root.beside ? 1 : root.share) * parent.height) : 0
            source: root.page.picture
            fillMode: Image.PreserveAspectFit
            mirror: false
        }
        PagedText {
            id: words
            theme: root.theme
            texts: root.texts
            armed: root.armed
            anchors {
                left: root.beside ? picture.right : parent.left; leftMargin: root.beside ? root.theme.unit : 0; right: parent.right
                top: root.beside ? parent.top : picture.bottom; topMargin: root.illustrated && !root.beside ? root.theme.unit : 0; bottom: parent.bottom
            }
            text: root.page.playing ? root.texts.slideNow : root.texts.phrased(root.page.text)
            size: Math.round((root.page.playing ? 1.5 : 1.1) * root.theme.textBody)
            weight: root.page.playing ? Font.Bold : Font.Normal
        }
    }
    Row {
        id: examples
        visible: root.feels
        anchors { horizontalCenter: parent.horizontalCenter; bottom: go.top; bottomMargin: root.theme.targetGap }
        spacing: root.theme.targetGap
        readonly property real share: Math.floor((root.width - (root.page.answers.length - 1) * spacing) / Math.max(1, root.page.answers.length))
        Repeater {
            model: root.page.answers.length
            ActionButton {
                required property int index
                objectName: "example" + index
                width: Math.min(examples.share, 34 * root.theme.unit)
                height: Math.max(root.theme.targetLeast, Math.min(root.theme.targetMin, Math.round(0.3 * root.height)))
                theme: root.theme
                primary: false
                enabled: !root.page.playing
                armed: root.armed
                text: root.page.answers[index] ?? ""
                onActivated: root.bridge.choose(index)
            }
        }
    }
    ActionButton {
        id: go
        objectName: "proceed"
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
        width: Math.min(Math.max(implicitWidth, 26 * root.theme.unit), root.width - 2 * root.theme.targetMin - 4 * root.theme.unit)
        theme: root.theme
        enabled: !root.page.playing
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
