import QtQuick
import Turnpoint

// The operator's pages with the bar that leads to them: Run, Studies, Sessions and Rig. The bar is at the side of a
// wide screen and below the pages of a tall one.
Rectangle {
    id: root
    required property OperatorController operating
    required property StudiesController studies
    required property SessionsController sessions
    required property RigController rig
    required property DesignController design
    required property real pixelsPerMm
    /// The lock of these pages; null if they have none.
    property OperatorLock lock: null
    /// True once the operator has put off the choice of a code.
    property bool later: false
    /// name of the page that is shown: run, studies, sessions or rig
    property string shown: "run"
    readonly property bool tall: height > width
    readonly property bool busy: rig.busy !== "" || rig.guide.playing || design.feeling.playing !== "" || sessions.busy || operating.preparing
    readonly property var places: [{ name: "run", glyph: "run" }, { name: "studies", glyph: "sheet" }, { name: "sessions", glyph: "list" }, { name: "rig", glyph: "gauge" }]

    color: look.paper
    LayoutMirroring.enabled: texts.mirrored
    LayoutMirroring.childrenInherit: true

    Theme {
        id: look
        width: root.width
        height: root.height
        pixelsPerMm: root.pixelsPerMm
        dense: true
    }
    Texts { id: texts; language: OperatorScreen.language }
    Binding {
        target: Catalogue
        property: "shown"
        value: OperatorScreen.language
    }

    Rectangle {
        id: bar
        objectName: "bar"
        anchors { left: parent.left; bottom: parent.bottom }
        width: root.tall ? root.width : Math.max(9 * look.unit, 13 * root.pixelsPerMm)
        height: root.tall ? Math.max(6 * look.unit, 10 * root.pixelsPerMm) : root.height
        color: look.raised
        Grid {
            anchors { left: parent.left; right: parent.right; top: parent.top; topMargin: root.tall ? 0 : look.unit }
            columns: root.tall ? 4 : 1
            Repeater {
                model: root.places
                BarButton {
                    required property var modelData
                    objectName: "bar-" + modelData.name
                    width: root.tall ? bar.width / 4 : bar.width
                    height: root.tall ? bar.height : Math.min((bar.height - 2 * look.unit) / 4, 1.1 * bar.width)
                    theme: look
                    glyph: modelData.glyph
                    chosen: root.shown === modelData.name
                    enabled: !root.busy
                    text: modelData.name === "run" ? texts.text("operator.run") : modelData.name === "studies" ? texts.text("operator.studies")
                        : modelData.name === "sessions" ? texts.text("operator.sessions") : texts.text("operator.rig")
                    onActivated: root.shown = modelData.name
                }
            }
        }
        Rectangle {
            anchors { right: parent.right; top: parent.top }
            width: root.tall ? parent.width : 1
            height: root.tall ? 1 : parent.height
            color: look.line
        }
    }
    // The code that opens these pages is printed in the manual until somebody chooses one.
    Rectangle {
        id: offer
        objectName: "codeOffer"
        visible: root.lock !== null && root.lock.builtIn && !root.later
        anchors { left: root.tall ? parent.left : bar.right; right: parent.right; top: parent.top }
        height: visible ? offered.height + look.unit : 0
        color: look.raised
        Flow {
            id: offered
            anchors { left: parent.left; right: parent.right; top: parent.top; margins: Math.round(look.unit / 2); leftMargin: look.margin; rightMargin: look.margin }
            spacing: look.unit
            PlainText {
                width: Math.min(implicitWidth, parent.width)
                height: Math.max(contentHeight, chooseCode.height)
                text: root.lock === null ? "" : texts.fill("operator.code_built_in", root.lock.shownCode)
                color: look.ink
                font { pixelSize: look.textBody; weight: Font.DemiBold }
                wrapMode: Text.Wrap
                verticalAlignment: Text.AlignVCenter
            }
            ActionButton {
                id: chooseCode
                objectName: "chooseCode"
                theme: look
                text: texts.text("operator.code_choose")
                onActivated: codeChooser.wanted = true
            }
            ActionButton {
                objectName: "codeLater"
                theme: look
                primary: false
                quiet: true
                text: texts.text("operator.code_later")
                onActivated: root.later = true
            }
        }
    }
    StationLine {
        id: line
        objectName: "stationLine"
        anchors { left: root.tall ? parent.left : bar.right; right: parent.right; bottom: root.tall ? bar.top : parent.bottom }
        theme: look
        texts: texts
        operating: root.operating
    }
    Item {
        id: place
        anchors { left: root.tall ? parent.left : bar.right; right: parent.right; top: offer.bottom; bottom: line.top }
        Loader {
            anchors.fill: parent
            active: root.shown === "run"
            sourceComponent: OperatorPage {
                objectName: "operatorPage"
                operating: root.operating
                pixelsPerMm: root.pixelsPerMm
            }
        }
        Loader {
            anchors.fill: parent
            active: root.shown === "studies" && root.design.stage !== ""
            sourceComponent: DesignPage {
                objectName: "designPage"
                design: root.design
                pixelsPerMm: root.pixelsPerMm
                onClosed: root.design.close()
            }
        }
        Connections {
            target: root.design
            function onSaved() { root.studies.selectFile(root.design.savedAs) }
        }
        Loader {
            anchors.fill: parent
            active: root.shown === "studies" && root.design.stage === ""
            sourceComponent: StudiesPage {
                objectName: "studiesPage"
                studies: root.studies
                pixelsPerMm: root.pixelsPerMm
                kept: root.design.kept
                onContinueWanted: root.design.continueKept()
                onDiscardWanted: root.design.discardKept()
                onNewWanted: root.design.startNew()
                onChangeWanted: path => root.design.open(path)
                onRunWanted: index => {
                    root.operating.refresh()
                    root.operating.select(index)
                    root.shown = "run"
                }
            }
        }
        Loader {
            anchors.fill: parent
            active: root.shown === "sessions"
            sourceComponent: SessionsPage {
                objectName: "sessionsPage"
                sessions: root.sessions
                pixelsPerMm: root.pixelsPerMm
                onResumeWanted: id => {
                    root.shown = "run"
                    root.operating.resumeSession(id)
                }
            }
        }
        Loader {
            anchors.fill: parent
            active: root.shown === "rig"
            sourceComponent: RigPage {
                objectName: "rigPage"
                rig: root.rig
                pixelsPerMm: root.pixelsPerMm
            }
        }
    }
    Loader {
        id: codeChooser
        property bool wanted: false
        anchors.fill: parent
        active: wanted
        focus: wanted
        onLoaded: (item as Item).forceActiveFocus()
        sourceComponent: OperatorGate {
            objectName: "codeChoice"
            pixelsPerMm: root.pixelsPerMm
            lock: root.lock
            choosing: true
            onAbandoned: codeChooser.wanted = false
            onPassed: codeChooser.wanted = false
        }
    }
}
