import QtQuick
import Turnpoint

// A bar beside a scrolling area. It shows that there is more content than fits, and which part is visible. It
// takes no touches.
Rectangle {
    id: root
    required property Theme theme
    required property Flickable place
    objectName: "scrollCue"

    visible: place.visible && place.contentHeight > place.height + 1
    x: place.x + place.width + Math.max(0, (parent.width - place.x - place.width - width) / 2)
    y: place.y + place.visibleArea.yPosition * place.height
    width: Math.round(0.5 * theme.unit)
    height: place.visibleArea.heightRatio * place.height
    radius: width / 2
    color: theme.quiet
}
