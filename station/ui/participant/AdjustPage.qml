import QtQuick
import Turnpoint

// Page of an adjustment task: a slider with steps, and a Done button. It shows neither a number nor the
// boundary, because the participant should judge by touch alone. The slider's length has no relation to the
// drawing of the surface above it.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property SessionBridge bridge
    property bool armed: true
    property bool leftHanded: false
    readonly property PageModel page: bridge.page
    /// The height of the buttons: as large as a finger needs, if the question and the surface keep their room.
    readonly property real target: Math.max(root.theme.targetLeast, Math.min(root.theme.targetMin, Math.round(0.3 * height)))
    readonly property real stepWidth: Math.min(target, Math.floor((width - 2 * root.theme.targetGap) / 3))
    readonly property real span: page.sliderMax - page.sliderMin
    /// True if the tones have ended, so that a setting made now could not be felt.
    readonly property bool silent: page.answersOpen
    readonly property real step: page.sliderStep > 0 ? page.sliderStep : span / 100
    property real value: page.slider
    /// True once the participant has touched the slider or a button of it. There is nothing to confirm before.
    property bool touched: false
    onVisibleChanged: touched = false
    readonly property int trial: page.trialsDone
    onTrialChanged: touched = false

    function moveTo(wanted: real) {
        touched = true
        const steps = Math.round((wanted - page.sliderMin) / step)
        const next = Math.max(page.sliderMin, Math.min(page.sliderMax, page.sliderMin + steps * step))
        if (next === value) return
        value = next
        bridge.moveSlider(next)
    }

    Connections {
        target: root.page
        function onChanged() { root.value = root.page.slider }
    }

    SurfaceDrawing {
        id: surface
        anchors { left: parent.left; right: parent.right; top: parent.top }
        // gives way to the question
        height: Math.round(Math.max(7 * root.theme.unit, Math.min(0.3 * parent.height, slider.y - Math.ceil(asked.height) - 2 * root.theme.unit)))
        surface: root.page.surface
        hasMark: root.page.hasMark
        markMm: root.page.markMm
        textPixels: root.theme.textSmall
        ink: root.theme.ink
        paper: root.theme.paper
        accent: root.theme.action
    }
    // the question at the smallest size, which tells how much room it needs
    PlainText {
        id: asked
        visible: false
        width: parent.width
        text: question.text
        font { pixelSize: root.theme.textLeast; weight: Font.Medium }
        wrapMode: Text.Wrap
    }
    PlainText {
        id: question
        anchors { left: parent.left; right: parent.right; top: surface.bottom; bottom: slider.top; bottomMargin: root.theme.unit }
        text: root.silent ? root.texts.pressDone : root.texts.phrased(root.page.text)
        color: root.theme.ink
        font { pixelSize: 1.1 * root.theme.textBody; weight: Font.Medium }
        fontSizeMode: Text.Fit
        minimumPixelSize: root.theme.textLeast
        wrapMode: Text.Wrap
        horizontalAlignment: Text.AlignHCenter
        verticalAlignment: Text.AlignVCenter
    }
    Item {
        id: slider
        objectName: "slider"
        Accessible.role: Accessible.Slider
        Accessible.name: root.page.text
        readonly property real knob: Math.max(root.theme.targetMin, 9 * root.theme.unit)
        anchors { left: parent.left; right: parent.right; bottom: controls.top; bottomMargin: root.theme.unit }
        opacity: root.silent ? 0.35 : 1
        height: Math.round(Math.max(0.6 * root.target, 6 * root.theme.unit))
        Rectangle {
            anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter }
            height: Math.round(1.4 * root.theme.unit)
            radius: height / 2
            color: root.theme.line
        }
        Rectangle {
            width: slider.knob
            height: parent.height
            radius: height / 2
            x: root.span > 0 ? (root.value - root.page.sliderMin) / root.span * (slider.width - width) : 0
            color: root.theme.action
            border { color: root.theme.raised; width: root.theme.stroke }
        }
        MouseArea {
            anchors.fill: parent
            enabled: root.armed && !root.silent
            function follow(x: real) {
                root.moveTo(root.page.sliderMin + (x - slider.knob / 2) / (slider.width - slider.knob) * root.span)
            }
            onPressed: mouse => follow(mouse.x)
            onPositionChanged: mouse => follow(mouse.x)
        }
    }
    Row {
        id: controls
        anchors { horizontalCenter: parent.horizontalCenter; bottom: parent.bottom }
        spacing: root.theme.targetGap
        LayoutMirroring.enabled: false
        LayoutMirroring.childrenInherit: true
        layoutDirection: root.leftHanded ? Qt.RightToLeft : Qt.LeftToRight
        Row {
            spacing: root.theme.targetGap
            ActionButton {
                objectName: "stepDown"
                label: root.texts.text("step_down")
                height: root.target
                width: root.stepWidth
                enabled: !root.silent
                theme: root.theme
                primary: false
                armed: root.armed
                glyph: "minus"
                onActivated: root.moveTo(root.value - root.step)
            }
            ActionButton {
                objectName: "stepUp"
                label: root.texts.text("step_up")
                height: root.target
                width: root.stepWidth
                enabled: !root.silent
                theme: root.theme
                primary: false
                armed: root.armed
                glyph: "plus"
                onActivated: root.moveTo(root.value + root.step)
            }
        }
        ActionButton {
            objectName: "proceed"
            height: root.target
            width: Math.min(Math.max(implicitWidth, 22 * root.theme.unit), root.width - 2 * (root.stepWidth + root.theme.targetGap))
            theme: root.theme
            enabled: root.touched || root.page.sliderMoved || root.silent
            armed: root.armed
            text: root.texts.done
            onActivated: root.bridge.next()
        }
    }
}
