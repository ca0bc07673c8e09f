import QtQuick
import Turnpoint

// A column in the middle of the area that it gets. If its content is too high, the whole column shrinks, so
// that nothing is hidden under the items below it.
Item {
    id: root
    required property Theme theme
    default property alias content: column.data
    property alias spacing: column.spacing

    Column {
        id: column
        width: parent.width
        y: Math.max(0, (parent.height - scale * implicitHeight) / 2)
        spacing: 1.4 * root.theme.unit
        scale: implicitHeight > 0 ? Math.min(1, parent.height / implicitHeight) : 1
        transformOrigin: Item.Top
    }
}
