import QtQuick

// The only text of these pages: what a file or a person wrote is shown as it was written. Qt's own guess would take
// a title with tags for rich text, and open the images that it names.
Text {
    textFormat: Text.PlainText
}
