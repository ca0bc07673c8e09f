import QtQuick
import Turnpoint

// The only text item that these pages use. It shows a text from a file or a person literally. A standard text
// item would interpret tags in it as rich text, and open the images that the tags name.
Text {
    /// Whether a screen reader reads the text. False for the text of a control, which the control has as its name.
    property bool readAloud: true
    textFormat: Text.PlainText
    font.family: Catalogue.family
    Accessible.role: Accessible.StaticText
    Accessible.name: text
    Accessible.ignored: !readAloud
}
