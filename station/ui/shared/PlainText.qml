import QtQuick

// The only text item of these pages: it shows what a file or a person wrote literally. By default Qt would
// interpret a title with tags as rich text and open the images that it names.
Text {
    textFormat: Text.PlainText
}
