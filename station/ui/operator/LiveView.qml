import QtQuick
import Turnpoint

// Shows a running session to the operator: the current scenes, the progress of the procedure, how much of
// each limit is used up, and the available actions.
// The model delays updates while a stimulus runs; during an adjustment it updates only the texts.
Rectangle {
    id: root
    required property LiveModel live
    required property SessionBridge bridge
    required property real pixelsPerMm
    property bool closable: false
    property bool noting: false
    property int shown: 0
    readonly property bool tall: height > width
    /// Text size in the figures.
    readonly property real small: Math.max(0.8 * look.textSmall, 2 * pixelsPerMm)
    readonly property bool waiting: bridge.page.kind === PageModel.Paused || bridge.page.kind === PageModel.Fault
    onOverChanged: stopping.visible = false
    readonly property bool over: bridge.page.kind === PageModel.End || bridge.page.kind === PageModel.Failed
    readonly property var notes: [texts.text("live.note_one"), texts.text("live.note_two"), texts.text("live.note_three"), texts.text("live.note_four")]
    signal closed()

    color: look.paper
    LayoutMirroring.enabled: texts.mirrored
    LayoutMirroring.childrenInherit: true

    function keep(text: string) {
        root.live.annotate(text)
        note.text = ""
        root.noting = false
    }

    Theme {
        id: look
        width: root.width
        height: root.height
        pixelsPerMm: root.pixelsPerMm
        dense: true
    }
    Texts { id: texts; language: OperatorScreen.language }
    RunModeFrame {
        id: frame
        anchors.fill: parent
        theme: look
        texts: texts
        runMode: root.bridge.page.runMode
    }

    Item {
        id: header
        anchors { left: parent.left; right: parent.right; top: parent.top; margins: look.margin; topMargin: frame.band + look.unit }
        height: root.tall ? buttons.height + heading.implicitHeight + look.unit : Math.max(buttons.height, heading.height)
        PlainText {
            id: heading
            anchors { left: parent.left; top: parent.top; topMargin: root.tall ? 0 : (parent.height - height) / 2 }
            width: root.tall ? parent.width : parent.width - buttons.width - look.unit
            // Only this page shows the word "LIVE"; the participant's pages of a live session leave it out.
            text: (root.bridge.page.runMode === "live" ? "LIVE   " : "") + (root.live.heading !== "" ? root.live.heading : texts.text("live.none"))
            color: look.ink
            font { pixelSize: look.textBody; weight: Font.Bold }
            maximumLineCount: 2
            wrapMode: Text.Wrap
            elide: Text.ElideRight
        }
        Flow {
            id: buttons
            anchors { right: parent.right; bottom: parent.bottom }
            width: root.tall ? parent.width : Math.min(0.8 * parent.width, row)
            /// Width of the visible buttons in one row.
            readonly property real row: {
                let sum = -spacing
                for (let i = 0; i < children.length; ++i) if (children[i].visible) sum += children[i].width + spacing
                return sum
            }
            spacing: look.unit
            ActionButton {
                objectName: "livePause"
                visible: !root.over
                theme: look
                primary: root.waiting
                glyph: root.waiting ? "" : "bars"
                text: root.waiting ? texts.text("live.go_on") : texts.pause
                onActivated: root.waiting ? root.live.proceed() : root.live.pause()
            }
            ActionButton {
                objectName: "liveRepeat"
                visible: !root.over
                theme: look
                primary: false
                enabled: root.live.held
                holdMs: 600
                text: texts.text("live.repeat")
                onActivated: root.live.repeat()
            }
            ActionButton {
                objectName: "liveNote"
                theme: look
                primary: false
                visible: !root.over
                text: texts.text("operator.note")
                onActivated: root.noting = true
            }
            ActionButton {
                objectName: "liveArm"
                visible: root.waiting
                theme: look
                primary: false
                holdMs: 900
                text: texts.text("live.arm")
                onActivated: root.live.arm()
            }
            ActionButton {
                objectName: "liveStop"
                visible: !root.over
                theme: look
                primary: false
                danger: true
                text: texts.text("live.stop")
                onActivated: stopping.open()
            }
            ActionButton {
                objectName: "liveClose"
                label: texts.close
                visible: root.closable
                theme: look
                primary: false
                glyph: "cross"
                text: ""
                onActivated: root.closed()
            }
        }
    }

    Column {
        id: surfaces
        anchors { left: parent.left; top: header.bottom; leftMargin: look.margin; topMargin: look.unit }
        width: root.tall ? root.width - 2 * look.margin : root.width - side.width - look.unit - 2 * look.margin
        height: (root.live.surfaces.length > 1 ? 0.4 : 0.24) * (root.tall ? 0.62 : 1) * (root.height - header.height - frame.band)
        spacing: Math.round(0.4 * look.unit)
        Repeater {
            model: root.live.surfaces
            FigureView {
                required property var modelData
                width: surfaces.width
                height: (surfaces.height - (root.live.surfaces.length - 1) * surfaces.spacing) / Math.max(1, root.live.surfaces.length)
                textPixels: root.small
                dark: look.dark
                paper: look.raised
                picture: modelData
            }
        }
    }
    Item {
        id: pictures
        objectName: "figures"
        anchors { left: surfaces.left; right: surfaces.right; top: surfaces.bottom; bottom: root.tall ? side.top : parent.bottom; topMargin: Math.round(0.6 * look.unit); bottomMargin: root.tall ? look.unit : frame.edge + look.unit }
        // Show three figures if there is enough room for each. Otherwise show one, with buttons to choose it.
        // The figures in the lower row need room for legends.
        readonly property real cell: 0.45 * (height - Math.round(0.6 * look.unit))
        readonly property bool single: cell < 12.5 * root.small
        readonly property real half: (width - Math.round(0.6 * look.unit)) / 2
        Row {
            id: choices
            visible: pictures.single
            height: visible ? look.controlHeight : 0
            spacing: Math.round(0.6 * look.unit)
            Repeater {
                model: root.live.hasStrip ? [texts.text("live.profile"), texts.text("live.levels"), texts.text("live.times"), texts.text("live.friction")]
                    : [texts.text("live.profile"), texts.text("live.levels"), texts.text("live.times")]
                ActionButton {
                    required property int index
                    required property string modelData
                    objectName: "livePicture" + index
                    theme: look
                    primary: root.shown === index
                    quiet: root.shown !== index
                    size: look.textSmall
                    text: modelData
                    onActivated: root.shown = index
                }
            }
        }
        Item {
            id: place
            anchors { fill: parent; topMargin: pictures.single ? choices.height + Math.round(0.6 * look.unit) : 0 }
        }
        FigureView {
            visible: !pictures.single || root.shown === 0
            anchors { left: place.left; top: place.top }
            width: pictures.single || !root.live.hasStrip ? place.width : pictures.half
            height: pictures.single ? place.height : pictures.cell
            textPixels: root.small
            dark: look.dark
            paper: look.raised
            picture: root.live.profile
        }
        FigureView {
            objectName: "strip"
            visible: root.live.hasStrip && (!pictures.single || root.shown === 3)
            anchors { right: place.right; top: place.top }
            width: pictures.single ? place.width : pictures.half
            height: pictures.single ? place.height : pictures.cell
            textPixels: root.small
            dark: look.dark
            paper: look.raised
            picture: root.live.strip
        }
        FigureView {
            visible: !pictures.single || root.shown === 1
            anchors { left: place.left; bottom: place.bottom }
            width: pictures.single ? place.width : pictures.half
            height: pictures.single ? place.height : place.height - pictures.cell - Math.round(0.6 * look.unit)
            textPixels: root.small
            dark: look.dark
            paper: look.raised
            picture: root.live.trace
        }
        FigureView {
            visible: !pictures.single || root.shown === 2
            anchors { right: place.right; bottom: place.bottom }
            width: pictures.single ? place.width : pictures.half
            height: pictures.single ? place.height : place.height - pictures.cell - Math.round(0.6 * look.unit)
            textPixels: root.small
            dark: look.dark
            paper: look.raised
            picture: root.live.times
        }
    }
    Rectangle {
        id: side
        objectName: "facts"
        anchors { right: parent.right; bottom: parent.bottom; rightMargin: look.margin; bottomMargin: frame.edge + look.unit }
        width: root.tall ? parent.width - 2 * look.margin : 0.36 * parent.width
        height: (parent.height - header.y - header.height - look.unit - anchors.bottomMargin) * (root.tall ? 0.4 : 1)
        radius: look.radius
        color: look.raised
        border { color: look.line; width: 1 }
        Flickable {
            id: scroll
            anchors { fill: parent; margins: look.unit }
            contentHeight: facts.height
            boundsBehavior: Flickable.StopAtBounds
            clip: true
            Column {
                id: facts
                width: scroll.width
                spacing: Math.round(0.9 * look.unit)
                PlainText {
                    objectName: "picturesLater"
                    visible: root.bridge.page.kind === PageModel.Adjust
                    width: parent.width
                    text: texts.text("live.texts_only")
                    color: look.ink
                    font.pixelSize: look.textSmall
                    wrapMode: Text.Wrap
                }
                PlainText {
                    objectName: "ended"
                    visible: root.over
                    width: parent.width
                    text: root.bridge.page.kind === PageModel.Failed
                        ? texts.fill("live.had_to_stop", root.bridge.page.detail)
                        : root.bridge.page.resumable
                        ? texts.text("live.stopped")
                        : texts.text("live.ended")
                    color: look.ink
                    font { pixelSize: look.textBody; weight: Font.DemiBold }
                    wrapMode: Text.Wrap
                }
                // what a device or the system reports; the participant's page does not show it
                PlainText {
                    objectName: "detail"
                    visible: text !== ""
                    width: parent.width
                    text: root.bridge.page.kind === PageModel.Fault ? root.bridge.page.detail : ""
                    color: look.wrong
                    font.pixelSize: look.textSmall
                    wrapMode: Text.Wrap
                }
                FactTable { width: parent.width; theme: look; texts: texts; heading: texts.text("live.course"); facts: root.live.course }
                // What the force cells say of the finger at this moment, also if the participant sees no bars.
                Column {
                    objectName: "gauges"
                    visible: root.live.gauged && !root.over
                    width: parent.width
                    spacing: Math.round(0.6 * look.unit)
                    Row {
                        width: parent.width
                        spacing: look.unit
                        GuidanceBar {
                            objectName: "forceGauge"
                            width: (parent.width - look.unit) / 2
                            theme: look
                            label: texts.text("live.force") + " " + root.live.gaugeFigures[0]
                            bar: root.live.forceGauge
                        }
                        GuidanceBar {
                            objectName: "speedGauge"
                            width: (parent.width - look.unit) / 2
                            theme: look
                            label: texts.text("live.speed") + " " + root.live.gaugeFigures[1]
                            bar: root.live.speedGauge
                        }
                    }
                    GuidanceBar {
                        objectName: "positionGauge"
                        width: parent.width
                        theme: look
                        label: texts.text("live.position") + " " + root.live.gaugeFigures[2]
                        bar: root.live.positionGauge
                    }
                }
                FactTable { visible: root.live.sensors.length > 0; width: parent.width; theme: look; texts: texts; heading: texts.text("live.sensors"); facts: root.live.sensors }
                FactTable { width: parent.width; theme: look; texts: texts; heading: texts.text("live.limits"); facts: root.live.limits }
                FactTable { width: parent.width; theme: look; texts: texts; heading: texts.text("live.surface"); facts: root.live.scene; labelShare: 0.3 }
            }
        }
        ScrollCue { theme: look; place: scroll }
    }

    Rectangle {
        visible: root.noting
        anchors.fill: parent
        color: look.paper
        Shield {}
        Column {
            anchors { fill: parent; margins: 2 * look.unit }
            spacing: look.unit
            PlainText {
                text: texts.text("operator.note_title")
                color: look.ink
                font { pixelSize: look.textTitle; weight: Font.Bold }
            }
            Rectangle {
                width: parent.width
                height: look.controlHeight
                radius: look.radius
                color: look.raised
                border { color: look.action; width: look.stroke }
                TextInput {
                    id: note
                    objectName: "note"
                    anchors { fill: parent; leftMargin: look.unit; rightMargin: look.unit }
                    verticalAlignment: TextInput.AlignVCenter
                    color: look.ink
                    font.pixelSize: look.textBody
                    focus: root.noting
                    clip: true
                    onAccepted: root.keep(text)
                }
            }
            Flow {
                width: parent.width
                spacing: Math.round(0.6 * look.unit)
                Repeater {
                    model: root.notes
                    ActionButton {
                        required property string modelData
                        required property int index
                        objectName: "quickNote" + index
                        theme: look
                        primary: false
                        quiet: true
                        text: modelData
                        onActivated: note.text = modelData
                    }
                }
            }
            ScreenKeyboard {
                width: parent.width
                theme: look
                onTyped: character => note.insert(note.cursorPosition, character)
                onErased: if (note.cursorPosition > 0) note.remove(note.cursorPosition - 1, note.cursorPosition)
                onMoved: by => note.cursorPosition = Math.max(0, Math.min(note.length, note.cursorPosition + by))
            }
            Row {
                spacing: look.unit
                ActionButton {
                    objectName: "keepNote"
                    theme: look
                    enabled: note.text !== ""
                    text: texts.text("live.save_note")
                    onActivated: root.keep(note.text)
                }
                ActionButton {
                    theme: look
                    primary: false
                    text: texts.text("operator.cancel")
                    onActivated: root.noting = false
                }
            }
        }
    }
    ConfirmDialog {
        id: stopping
        objectName: "stopping"
        anchors.fill: parent
        theme: look
        texts: texts
        title: texts.text("live.stop_title")
        text: texts.text("live.stop_text")
        keepText: texts.text("live.stop_keep")
        confirmText: texts.text("live.stop_do")
        onConfirmed: root.live.stop()
    }
}
