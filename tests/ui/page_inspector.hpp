#pragma once
#include <QObject>
#include <QQuickItem>
#include <QStringList>
#include <QTemporaryDir>

namespace turnpoint::ui {

/// Looks at what has been rendered, as a participant does, and not at what a page was told to draw.
class PageInspector : public QObject {
  Q_OBJECT

 public:
  using QObject::QObject;
  ~PageInspector() override;

  /// Texts below `page` that are visible and enabled, whose letters and background differ by a contrast (as
  /// WCAG 2.1 defines it) below `least` in the pixels on the screen: "text: contrast", one each.
  Q_INVOKABLE QStringList faintTexts(QQuickItem* page, double least) const;
  /// Texts below `page` that were cut off by their place: elided, clipped, or reaching out of the page.
  Q_INVOKABLE QStringList cutTexts(QQuickItem* page) const;
  /// Texts below `page` with a line break inside a word. (Between Chinese or Japanese characters it is none.)
  Q_INVOKABLE QStringList brokenWords(QQuickItem* page) const;
  /// True where anything but the ground that it stands on reaches the left or the right edge of an item.
  Q_INVOKABLE bool reachesEdge(QQuickItem* item) const;
  /// How many texts the others look at.
  Q_INVOKABLE int texts(QQuickItem* page) const;

  /// A picture's file that nobody has opened yet; from now on opened() tells how often somebody did.
  Q_INVOKABLE QString picture();
  Q_INVOKABLE int opened();

 private:
  QTemporaryDir folder_;
  int watch_ = -1, opened_ = 0;
};

}  // namespace turnpoint::ui
