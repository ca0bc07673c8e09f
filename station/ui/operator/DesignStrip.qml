import QtQuick
import Turnpoint

// A drawing of the surface with two marks that can be dragged: the boundary, and the start of the smooth zone. Below
// the drawing is the scene's profile on this rig.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property var surface
    /// Positions (mm) of the marks for the boundary and for the start of the smooth zone; negative if the scene has no
    /// such mark.
    property real boundaryMm: -1
    property real zoneMm: -1
    property var profile
    signal moved(which: string, mm: real)

    height: strip.height + (picture.visible ? picture.height + Math.round(0.5 * theme.unit) : 0) + hint.height

    PlainText {
        id: hint
        width: parent.width
        text: root.texts.text("design.drag")
        color: root.theme.quiet
        font.pixelSize: root.theme.textSmall
        wrapMode: Text.Wrap
    }
    SurfaceDrawing {
        id: strip
        anchors { left: parent.left; right: parent.right; top: hint.bottom }
        height: Math.max(2.2 * root.theme.controlHeight, 12 * root.theme.unit)
        surface: root.surface
        textPixels: root.theme.textSmall
        ink: root.theme.ink
        paper: root.theme.raised
        accent: root.theme.action
        Accessible.role: Accessible.Slider
        Accessible.name: hint.text

        component Mark: Rectangle {
            id: mark
            property real mm
            property string text
            readonly property real at: strip.width > 0 && mm >= 0 ? strip.xOf(mm) : 0
            visible: mm >= 0
            x: at - width / 2
            y: 0.1 * strip.height
            width: Math.max(3, Math.round(0.4 * root.theme.unit))
            height: 0.62 * strip.height
            color: root.theme.action
            Rectangle {
                anchors { horizontalCenter: parent.horizontalCenter; top: parent.top }
                width: flag.implicitWidth + root.theme.unit
                height: flag.implicitHeight + Math.round(0.5 * root.theme.unit)
                radius: root.theme.radius
                color: root.theme.action
                PlainText {
                    id: flag
                    readAloud: false
                    anchors.centerIn: parent
                    text: mark.text + " " + mark.mm + " mm"
                    color: root.theme.actionText
                    font { pixelSize: root.theme.textSmall; weight: Font.DemiBold }
                }
            }
        }
        Rectangle {
            // the smooth part of the surface
            visible: boundary.visible
            readonly property real from: zone.visible ? zone.at : strip.width > 0 ? strip.xOf(0) : 0
            x: Math.min(from, boundary.at)
            width: Math.abs(boundary.at - from)
            y: boundary.y + 0.55 * boundary.height
            height: 0.28 * boundary.height
            color: root.theme.action
            opacity: 0.25
        }
        Mark { id: zone; objectName: "zoneMark"; mm: root.zoneMm; text: "⊢" }
        Mark { id: boundary; objectName: "boundaryMark"; mm: root.boundaryMm; text: "⊣" }
        MouseArea {
            id: drag
            objectName: "dragArea"
            anchors.fill: parent
            preventStealing: true
            property var held: null
            function follow(x: real) { held.mm = Math.round(strip.mmAt(x)) }
            onPressed: mouse => {
                const nearer = zone.visible && (!boundary.visible || Math.abs(mouse.x - zone.at) < Math.abs(mouse.x - boundary.at))
                held = nearer ? zone : boundary
                follow(mouse.x)
            }
            onPositionChanged: mouse => { if (held) follow(mouse.x) }
            onReleased: {
                const which = held === zone ? "zone" : "boundary", mm = held.mm
                held = null
                root.moved(which, mm)
            }
            onCanceled: held = null
        }
    }
    FigureView {
        id: picture
        visible: root.profile !== undefined
        anchors { left: parent.left; right: parent.right; top: strip.bottom; topMargin: Math.round(0.5 * root.theme.unit) }
        height: Math.max(18 * root.theme.unit, 13 * root.theme.textSmall)
        textPixels: 0.8 * root.theme.textSmall
        dark: root.theme.dark
        paper: root.theme.raised
        picture: root.profile
    }
}
