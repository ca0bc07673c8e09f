import QtQuick
import Turnpoint

// Shows any scene of a protocol without a session: sliders for the scene's factors; figures of surface,
// profile, friction and spectrum; and, in words, the model, its error and the cues.
Rectangle {
    id: root
    required property PreviewController controller
    required property real pixelsPerMm

    color: look.paper
    Theme {
        id: look
        width: root.width
        height: root.height
        pixelsPerMm: root.pixelsPerMm
        dense: true
    }
    LayoutMirroring.enabled: texts.mirrored
    LayoutMirroring.childrenInherit: true
    Texts { id: texts; language: OperatorScreen.language }
    Binding {
        target: root.controller
        property: "language"
        value: OperatorScreen.language
    }

    Row {
        id: tabs
        anchors { left: parent.left; top: parent.top; margins: look.margin }
        spacing: Math.round(0.6 * look.unit)
        Repeater {
            model: root.controller.scenes
            ActionButton {
                required property int index
                required property string modelData
                objectName: "scene" + index
                theme: look
                primary: root.controller.scene === index
                quiet: root.controller.scene !== index
                text: modelData
                onActivated: root.controller.choose(index)
            }
        }
    }
    PlainText {
        anchors { left: tabs.right; right: parent.right; verticalCenter: tabs.verticalCenter; leftMargin: 2 * look.unit; rightMargin: look.margin }
        text: root.controller.title + "   ·   " + root.controller.rig
        color: look.quiet
        font.pixelSize: look.textSmall
        horizontalAlignment: Text.AlignRight
        elide: Text.ElideRight
    }

    component Knob: Item {
        id: knob
        required property var modelData
        property real value: modelData.value
        readonly property real span: modelData.high - modelData.low
        objectName: "knob-" + modelData.name
        height: look.controlHeight

        function nearest(wanted: real) : real {
            const levels = modelData.levels
            if (levels.length === 0) return Math.round(wanted / (span / 200)) * (span / 200)
            return levels.reduce((best, level) => Math.abs(level - wanted) < Math.abs(best - wanted) ? level : best, levels[0])
        }
        function follow(x: real) {
            const share = Math.max(0, Math.min(1, (x - handle.width / 2) / Math.max(1, track.width - handle.width)))
            const next = nearest(modelData.low + share * span)
            if (next === value) return
            value = next
            root.controller.set(modelData.name, next)
        }
        PlainText {
            id: name
            anchors { left: parent.left; verticalCenter: parent.verticalCenter }
            width: 0.36 * parent.width
            text: knob.modelData.name + " = " + Number(knob.value.toPrecision(5))
            color: look.ink
            font { pixelSize: look.textBody; weight: Font.DemiBold }
            elide: Text.ElideRight
        }
        // The track runs from left to right in every language, as the figures do.
        Item {
            id: track
            LayoutMirroring.enabled: false
            LayoutMirroring.childrenInherit: true
            Accessible.role: Accessible.Slider
            Accessible.name: name.text
            x: texts.mirrored ? 0 : name.width + look.unit
            width: parent.width - name.width - look.unit
            anchors.verticalCenter: parent.verticalCenter
            height: parent.height
            Rectangle {
                anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter }
                height: Math.round(0.5 * look.unit)
                radius: height / 2
                color: look.line
            }
            Repeater {
                model: knob.modelData.levels.length <= 40 ? knob.modelData.levels : []
                Rectangle {
                    required property real modelData
                    x: handle.width / 2 + (knob.span > 0 ? (modelData - knob.modelData.low) / knob.span : 0) * (track.width - handle.width) - width / 2
                    anchors.verticalCenter: parent.verticalCenter
                    width: 2
                    height: Math.round(1.4 * look.unit)
                    color: look.quiet
                }
            }
            Rectangle {
                id: handle
                width: Math.round(2.6 * look.unit)
                height: width
                radius: width / 2
                anchors.verticalCenter: parent.verticalCenter
                x: knob.span > 0 ? (knob.value - knob.modelData.low) / knob.span * (track.width - width) : 0
                color: look.action
                border { color: look.raised; width: look.stroke }
            }
            MouseArea {
                anchors.fill: parent
                onPressed: mouse => knob.follow(mouse.x)
                onPositionChanged: mouse => knob.follow(mouse.x)
            }
        }
    }
    Grid {
        id: knobs
        anchors { left: parent.left; right: parent.right; top: tabs.bottom; margins: look.margin; topMargin: Math.round(0.6 * look.unit) }
        columns: root.controller.knobs.length > 1 ? 2 : 1
        columnSpacing: 3 * look.unit
        rowSpacing: Math.round(0.4 * look.unit)
        Repeater {
            model: root.controller.knobs
            Knob { width: (knobs.width - (knobs.columns - 1) * knobs.columnSpacing) / knobs.columns }
        }
    }
    PlainText {
        visible: root.controller.knobs.length === 0
        anchors { left: parent.left; top: tabs.bottom; margins: look.margin; topMargin: Math.round(0.8 * look.unit) }
        text: texts.text("preview.no_factor")
        color: look.quiet
        font.pixelSize: look.textSmall
    }

    Item {
        id: pictures
        anchors { left: parent.left; right: side.left; top: knobs.bottom; bottom: parent.bottom; leftMargin: look.margin; rightMargin: look.unit; topMargin: Math.round(1.6 * look.unit); bottomMargin: look.margin }
        opacity: root.controller.busy ? 0.6 : 1
        FigureView {
            id: surface
            anchors { left: parent.left; right: parent.right; top: parent.top }
            height: 0.27 * parent.height
            textPixels: Math.max(0.8 * look.textSmall, 2 * root.pixelsPerMm)
            dark: look.dark
            paper: look.raised
            picture: root.controller.surface
        }
        FigureView {
            id: profile
            anchors { left: parent.left; right: parent.right; top: surface.bottom; topMargin: Math.round(0.6 * look.unit) }
            height: 0.36 * parent.height
            textPixels: Math.max(0.8 * look.textSmall, 2 * root.pixelsPerMm)
            dark: look.dark
            paper: look.raised
            picture: root.controller.profile
        }
        FigureView {
            anchors { left: parent.left; right: parent.right; top: profile.bottom; bottom: parent.bottom; topMargin: Math.round(0.6 * look.unit) }
            textPixels: Math.max(0.8 * look.textSmall, 2 * root.pixelsPerMm)
            dark: look.dark
            paper: look.raised
            picture: root.controller.spectrum
        }
        Row {
            visible: root.controller.problem !== ""
            anchors.centerIn: parent
            width: 0.8 * parent.width
            spacing: look.unit
            Glyph {
                id: sign
                height: 3 * look.unit
                name: "alert"
                color: look.wrong
            }
            PlainText {
                width: parent.width - sign.width - parent.spacing
                text: root.controller.problem
                color: look.wrong
                font { pixelSize: look.textBody; weight: Font.DemiBold }
                wrapMode: Text.Wrap
            }
        }
    }
    Rectangle {
        id: side
        anchors { right: parent.right; top: pictures.top; bottom: parent.bottom; rightMargin: look.margin; bottomMargin: look.margin }
        width: 0.36 * parent.width
        radius: look.radius
        color: look.raised
        border { color: look.line; width: 1 }
        Flickable {
            id: scroll
            anchors { fill: parent; margins: Math.round(1.2 * look.unit) }
            contentHeight: sheet.height
            boundsBehavior: Flickable.StopAtBounds
            clip: true
            Column {
                id: sheet
                width: scroll.width
                spacing: look.unit
                FactTable { width: parent.width; theme: look; texts: texts; heading: texts.text("preview.plan"); facts: root.controller.facts; labelShare: 0.32 }
                FactTable { width: parent.width; theme: look; texts: texts; heading: texts.text("preview.cues"); facts: root.controller.cues; labelShare: 0.5 }
            }
        }
        ScrollCue { theme: look; place: scroll }
    }
}
