import QtQuick
import Turnpoint

// The only text item that these pages use. It shows a text from a file or a person literally. A standard text
// item would interpret tags in it as rich text, and open the images that the tags name.
Text {
    textFormat: Text.PlainText
    font.family: Catalogue.family
}
