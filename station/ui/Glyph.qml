import QtQuick
import QtQuick.Shapes

// A sign drawn in strokes: tick, cross, clock, chevrons (speed), rings (accuracy), bars (pause), alert, backspace.
Item {
    id: root
    required property string name
    required property color color
    property real weight: 0.1

    implicitWidth: height

    component Stroke: ShapePath {
        strokeColor: root.color
        strokeWidth: root.weight * root.height
        fillColor: "transparent"
        capStyle: ShapePath.RoundCap
        joinStyle: ShapePath.RoundJoin
        scale: Qt.size(root.height / 24, root.height / 24)
    }

    Shape {
        anchors.fill: parent
        antialiasing: true
        layer.enabled: GraphicsInfo.api !== GraphicsInfo.Software
        layer.samples: 4

        Stroke { PathSvg { path: root.outline(root.name) } }
    }

    function outline(name: string) : string {
        switch (name) {
        case "tick": return "M4 13 L10 19 L20 6"
        case "cross": return "M6 6 L18 18 M18 6 L6 18"
        case "clock": return "M12 3 A9 9 0 1 1 11.99 3 M12 7 L12 12.5 L15.5 14.5"
        case "chevrons": return "M4 5 L10.5 12 L4 19 M13 5 L19.5 12 L13 19"
        case "rings": return "M12 2.5 A9.5 9.5 0 1 1 11.99 2.5 M12 7.5 A4.5 4.5 0 1 1 11.99 7.5 M12 11.9 L12 12.1"
        case "bars": return "M8.5 5 L8.5 19 M15.5 5 L15.5 19"
        case "alert": return "M12 3 L22 20.5 L2 20.5 Z M12 9.5 L12 14 M12 17.1 L12 17.2"
        case "backspace": return "M9 5 L21 5 L21 19 L9 19 L3 12 Z M12 9.5 L17 14.5 M17 9.5 L12 14.5"
        case "shield": return "M12 2.5 L20 5.5 L20 11.5 C20 16 16.5 19.5 12 21.5 C7.5 19.5 4 16 4 11.5 L4 5.5 Z M8 12 L11 15 L16 9"
        case "tool": return "M3 12 L19 12 M13 6 L19 12 L13 18"
        case "dots": return "M6 12 L6 12.1 M12 12 L12 12.1 M18 12 L18 12.1"
        case "minus": return "M5 12 L19 12"
        case "plus": return "M5 12 L19 12 M12 5 L12 19"
        }
        return ""
    }
}
