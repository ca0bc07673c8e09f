import QtQuick
import Turnpoint

// Thanks for the participant; below, kept small, the session's numbers for the operator.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property SessionBridge bridge
    readonly property PageModel page: bridge.page
    readonly property bool hasNumbers: page.summaryLabels.length > 0
    signal closed()

    Column {
        id: thanks
        anchors { left: parent.left; right: parent.right; top: parent.top }
        topPadding: root.hasNumbers ? 0 : Math.max(0, (close.y - 24 * root.theme.unit) / 2)
        spacing: 1.2 * root.theme.unit
        Glyph {
            anchors.horizontalCenter: parent.horizontalCenter
            height: (root.hasNumbers ? 6 : 12) * root.theme.unit
            name: "tick"
            color: root.theme.right
        }
        Text {
            width: parent.width
            text: root.page.title !== "" ? root.page.title : root.texts.thanks
            color: root.theme.ink
            font { pixelSize: root.theme.textTitle; weight: Font.Bold }
            horizontalAlignment: Text.AlignHCenter
            wrapMode: Text.Wrap
        }
        Text {
            width: parent.width
            text: root.page.text !== "" ? root.page.text : root.texts.thanksText
            color: root.theme.quiet
            font.pixelSize: root.theme.textBody
            horizontalAlignment: Text.AlignHCenter
            wrapMode: Text.Wrap
        }
    }
    Rectangle {
        visible: root.hasNumbers
        anchors {
            left: parent.left; right: parent.right
            top: thanks.bottom; topMargin: 1.5 * root.theme.unit
            bottom: close.top; bottomMargin: 1.5 * root.theme.unit
        }
        radius: root.theme.radius
        color: root.theme.raised
        border { color: root.theme.line; width: Math.max(1, 0.5 * root.theme.stroke) }
        Text {
            id: heading
            anchors { left: parent.left; top: parent.top; margins: 1.4 * root.theme.unit }
            text: root.texts.forOperator
            color: root.theme.quiet
            font { pixelSize: root.theme.textSmall; weight: Font.DemiBold }
        }
        Flickable {
            id: scroll
            anchors { left: parent.left; right: parent.right; top: heading.bottom; bottom: parent.bottom; margins: 1.4 * root.theme.unit; topMargin: 0.6 * root.theme.unit }
            contentHeight: numbers.height
            clip: true
            Grid {
                id: numbers
                width: parent.width
                columns: 2
                columnSpacing: 4 * root.theme.unit
                rowSpacing: 0.5 * root.theme.unit
                Repeater {
                    model: root.page.summaryLabels
                    Item {
                        id: entry
                        required property int index
                        required property string modelData
                        width: (numbers.width - numbers.columnSpacing) / 2
                        height: label.implicitHeight
                        Text {
                            id: label
                            text: entry.modelData
                            color: root.theme.quiet
                            font.pixelSize: root.theme.textSmall
                        }
                        Text {
                            anchors.right: parent.right
                            text: root.page.summaryValues[entry.index] ?? ""
                            color: root.theme.ink
                            font { pixelSize: root.theme.textSmall; weight: Font.DemiBold }
                        }
                    }
                }
            }
        }
    }
    ActionButton {
        id: close
        objectName: "close"
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
        theme: root.theme
        primary: false
        text: root.texts.close
        onActivated: root.closed()
    }
}
