import QtQuick
import Turnpoint

// A symbol, a title and a text in the middle of the area that they get, and perhaps something below them. If the area is
// too small, the symbol gives way first; then the text is shown on several pages.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    property string glyph
    property real glyphHeight: 10 * theme.unit
    property color tint: theme.ink
    property string title
    property real titleSize: theme.textTitle
    property alias text: words.text
    property alias size: words.size
    property alias weight: words.weight
    property alias color: words.color
    property alias textName: words.objectName
    property alias armed: words.armed
    property real spacing: Math.round(1.5 * theme.unit)
    default property alias content: below.data

    readonly property real fixed: heading.height + (below.height > 0 ? below.height + spacing : 0) + (title !== "" ? spacing : 0)
    readonly property real room: Math.max(0, height - fixed)
    readonly property bool signed: glyph !== "" && glyphHeight + spacing + fixed + words.natural <= height
    readonly property real used: (signed ? glyphHeight + spacing : 0) + fixed + words.height

    Glyph {
        id: sign
        visible: root.signed
        anchors.horizontalCenter: parent.horizontalCenter
        y: Math.round(Math.max(0, (root.height - root.used) / 2))
        height: root.glyphHeight
        name: root.glyph
        color: root.tint
        weight: 0.08
    }
    PlainText {
        id: heading
        y: root.signed ? sign.y + sign.height + root.spacing : sign.y
        width: parent.width
        height: root.title === "" ? 0 : contentHeight
        text: root.title
        color: root.theme.ink
        font { pixelSize: root.titleSize; weight: Font.Bold }
        horizontalAlignment: Text.AlignHCenter
        wrapMode: Text.Wrap
    }
    PagedText {
        id: words
        theme: root.theme
        texts: root.texts
        turns: true
        y: heading.y + heading.height + (root.title === "" ? 0 : root.spacing)
        width: parent.width
        height: Math.min(Math.ceil(natural), root.room)
    }
    Column {
        id: below
        y: words.y + words.height + root.spacing
        width: parent.width
        spacing: root.spacing
    }
}
