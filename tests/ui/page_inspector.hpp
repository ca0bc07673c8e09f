#pragma once
#include <QObject>
#include <QQuickItem>
#include <QStringList>
#include <QTemporaryDir>

namespace turnpoint::ui {

/// Inspects the rendered pixels, which a participant sees, instead of the properties of the items on a page.
class PageInspector : public QObject {
  Q_OBJECT

 public:
  using QObject::QObject;
  ~PageInspector() override;

  /// Texts below `page` that are visible and enabled and whose contrast with the background on the screen (as
  /// defined by WCAG 2.1) is below `least`, each as "text: contrast".
  Q_INVOKABLE QStringList faintTexts(QQuickItem* page, double least) const;
  /// Texts below `page` that are cut off: elided, clipped, or extending beyond the page.
  Q_INVOKABLE QStringList cutTexts(QQuickItem* page) const;
  /// Texts below `page` with a line break inside a word. (Breaks between Chinese or Japanese characters do
  /// not count.)
  Q_INVOKABLE QStringList brokenWords(QQuickItem* page) const;
  /// Buttons, keys and answers below `page` whose edges are not on whole pixels, so that their lines are
  /// blurred.
  Q_INVOKABLE QStringList blurredEdges(QQuickItem* page) const;
  /// Texts below `page` whose capitals are lower than this, as "text: capitals of 12.3 pixels".
  Q_INVOKABLE QStringList smallTexts(QQuickItem* page, double capitals_px) const;
  /// Returns pairs of items that touch each other: a text and another text, a text and a button that it is
  /// not part of, or two buttons; or one of them and the edge of the page.
  Q_INVOKABLE QStringList overlaps(QQuickItem* page) const;
  /// True if anything but the background reaches the left or the right edge of an item.
  Q_INVOKABLE bool reachesEdge(QQuickItem* item) const;
  /// Number of texts on the page that the other functions inspect.
  Q_INVOKABLE int texts(QQuickItem* page) const;

  /// What a screen reader finds below `page`: each visible control as "role: name", read through QAccessible.
  Q_INVOKABLE QStringList controls(QQuickItem* page) const;
  /// Items below `page` that react to taps but that a screen reader does not find, or finds without a name.
  Q_INVOKABLE QStringList unnamedControls(QQuickItem* page) const;

  /// Texts below `page` that a screen reader does not read, or reads twice: by themselves and as the name of
  /// a control.
  Q_INVOKABLE QStringList unreadTexts(QQuickItem* page) const;

  /// Makes a picture and returns its path. From then on opened() returns how often the picture was opened.
  Q_INVOKABLE QString picture();
  Q_INVOKABLE int opened();

 private:
  QTemporaryDir folder_;
  int watch_ = -1, opened_ = 0;
};

}  // namespace turnpoint::ui
