import QtQuick
import Turnpoint

// The report of the finished session, for the operator: first the speed-accuracy trade-off, then fits, levels
// and times, with the numbers and remarks beside them.
Rectangle {
    id: root
    required property ReportModel report
    required property real pixelsPerMm
    property string runMode
    property int shown: 0
    /// On a tall screen, the numbers stand below the figure.
    readonly property bool tall: height > width
    readonly property string title: report.title + (report.status === "" ? "" : " (" + texts.named(report.runMode) + ", " + texts.named(report.status) + ")")
    readonly property Texts words: texts
    signal closed()

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
    RunModeFrame {
        id: frame
        anchors.fill: parent
        theme: look
        texts: texts
        runMode: root.runMode
    }
    Item {
        id: header
        anchors { left: parent.left; right: parent.right; top: parent.top; margins: look.margin; topMargin: frame.band + look.unit }
        height: look.controlHeight
        PlainText {
            anchors { left: parent.left; right: save.visible ? save.left : close.left; verticalCenter: parent.verticalCenter; rightMargin: look.unit }
            text: root.report.saved !== "" ? texts.say(root.report.saved) : root.report.ready ? root.title : texts.text("report.making")
            color: look.ink
            font { pixelSize: 1.15 * look.textBody; weight: Font.Bold }
            elide: Text.ElideRight
        }
        ActionButton {
            id: save
            objectName: "saveFigure"
            visible: root.report.maySave && root.report.pictures.length > 0
            anchors { right: close.left; rightMargin: look.unit; verticalCenter: parent.verticalCenter }
            theme: look
            primary: false
            text: texts.text("operator.save_figure")
            onActivated: root.report.save(Math.min(root.shown, root.report.pictures.length - 1))
        }
        ActionButton {
            id: close
            objectName: "closeReport"
            anchors { right: parent.right; verticalCenter: parent.verticalCenter }
            theme: look
            primary: false
            text: texts.close
            onActivated: root.closed()
        }
    }
    Item {
        id: body
        anchors { left: parent.left; right: parent.right; top: header.bottom; bottom: parent.bottom; margins: look.margin; topMargin: look.unit; bottomMargin: frame.edge + look.unit }
    }
    Item {
        id: pane
        anchors { left: body.left; top: body.top }
        width: (root.tall ? 1 : 0.6) * body.width
        height: (root.tall ? 0.55 : 1) * body.height
        Flickable {
            id: view
            width: pane.width - look.unit
            height: pane.height
            contentHeight: figure.y + figure.height
            boundsBehavior: Flickable.StopAtBounds
            clip: true
            Flow {
                id: tabs
                width: view.width
                spacing: Math.round(0.6 * look.unit)
                Repeater {
                    model: root.report.pictureNames
                    ActionButton {
                        required property int index
                        required property string modelData
                        objectName: "picture" + index
                        theme: look
                        primary: root.shown === index
                        quiet: root.shown !== index
                        size: look.textSmall
                        text: texts.text(modelData)
                        onActivated: root.shown = index
                    }
                }
            }
            FigureView {
                id: figure
                objectName: "picture"
                y: tabs.height + look.unit
                width: view.width
                height: neededHeight
                // on a small panel the buttons are scrolled away to see the figure
                seenHeight: view.height - (y < 0.3 * view.height ? y : 0)
                textPixels: Math.max(0.85 * look.textSmall, 2 * root.pixelsPerMm)
                dark: look.dark
                paper: look.raised
                picture: root.report.pictures[Math.min(root.shown, root.report.pictures.length - 1)] ?? ""
                onPictureChanged: view.contentY = 0
            }
        }
        ScrollCue { theme: look; place: view }
    }
    Rectangle {
        id: side
        anchors { right: body.right; top: root.tall ? pane.bottom : body.top; topMargin: root.tall ? look.unit : 0; bottom: body.bottom }
        width: root.tall ? body.width : 0.4 * body.width
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
                Repeater {
                    model: root.report.sections
                    FactTable {
                        required property var modelData
                        width: sheet.width
                        theme: look
                        texts: root.words
                        heading: root.words.say(modelData.heading)
                        facts: modelData.facts
                        remarks: modelData.statements
                        labelShare: 0.5
                    }
                }
            }
        }
        ScrollCue { theme: look; place: scroll }
    }
}
