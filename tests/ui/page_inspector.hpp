#pragma once
#include <QObject>
#include <QQuickItem>
#include <QStringList>

namespace turnpoint::ui {

/// Looks at what has been rendered, as a participant does, and not at what a page was told to draw.
class PageInspector : public QObject {
  Q_OBJECT

 public:
  using QObject::QObject;

  /// Texts below `page` that are visible and enabled, whose letters and background differ by a contrast (as
  /// WCAG 2.1 defines it) below `least` in the pixels on the screen: "text: contrast", one each.
  Q_INVOKABLE QStringList faintTexts(QQuickItem* page, double least) const;
  /// Texts below `page` that were cut off by their place: elided, clipped, or reaching out of the page.
  Q_INVOKABLE QStringList cutTexts(QQuickItem* page) const;
  /// How many texts the two above look at.
  Q_INVOKABLE int texts(QQuickItem* page) const;
};

}  // namespace turnpoint::ui
