#pragma once
#include <QColor>
#include <QQuickPaintedItem>

#include "station/report/figure_files.hpp"
#include "station/view/scene_figures.hpp"

namespace turnpoint::ui {

/// A drawing in a form that can be a QML property.
struct Picture {
  Q_GADGET

 public:
  view::Drawing draw;
};

/// Converts a drawing to the value of a QML property.
QVariant to_variant(const view::Drawing& drawing);

/// Writes the files of a figure (see report::figure_files) to a folder, which it makes if there is none. The PDF is made
/// by Qt, which joins the letters of all scripts. Throws std::runtime_error or std::system_error if a file cannot be
/// written.
void save_figure(const report::NamedFigure& figure, const QString& folder);

/// Shows one figure, laid out for the size of this item with text of `textPixels`. Each new picture is drawn
/// only once.
class FigureView : public QQuickPaintedItem {
  Q_OBJECT
  QML_ELEMENT
  Q_PROPERTY(QVariant picture READ picture WRITE set_picture NOTIFY pictureChanged)
  Q_PROPERTY(double textPixels MEMBER text_pixels_)
  /// The colour of the card, and whether the figure is drawn for the dark theme.
  Q_PROPERTY(QColor paper MEMBER paper_ WRITE set_paper)
  Q_PROPERTY(bool dark MEMBER dark_ WRITE set_dark)

 public:
  explicit FigureView(QQuickItem* parent = nullptr);
  QVariant picture() const { return QVariant::fromValue(picture_); }
  void set_picture(const QVariant& picture);  // the setter of a QML property must have this name (NOLINT)
  void set_paper(const QColor& paper);        // NOLINT
  void set_dark(bool dark);                   // NOLINT
  void paint(QPainter* painter) override;

 Q_SIGNALS:
  void pictureChanged();

 private:
  Picture picture_;
  double text_pixels_ = 12;
  QColor paper_ = Qt::white;
  bool dark_ = false;
};

}  // namespace turnpoint::ui
