#pragma once
#include <QColor>
#include <QQuickPaintedItem>
#include <optional>

#include "station/report/figure_files.hpp"
#include "station/view/scene_figures.hpp"

namespace turnpoint::ui {

/// A drawing in a form that can be a QML property.
struct Picture {
  Q_GADGET

 public:
  view::Drawing draw;
  std::optional<report::Figure> figure = {};  ///< what it draws, if it can be laid out to be scrolled
};

/// Converts a drawing to the value of a QML property.
QVariant to_variant(const view::Drawing& drawing);
QVariant to_variant(const report::Figure& figure);

/// Writes the files of a figure (see report::figure_files) to a folder, which it makes if there is none. The
/// PDF is made by Qt, which joins the letters of all scripts. Throws std::runtime_error or std::system_error
/// if a file cannot be written.
void save_figure(const report::NamedFigure& figure, const QString& folder);

/// Shows one figure, laid out for the size of this item with text of `textPixels`. Each new picture is drawn
/// only once. If the item is in a Flickable, `seenHeight` is that one's height, and the item must be as high
/// as `neededHeight`: a figure whose text would have to be smaller is then higher than what is seen at once.
class FigureView : public QQuickPaintedItem {
  Q_OBJECT
  QML_ELEMENT
  Q_PROPERTY(QVariant picture READ picture WRITE set_picture NOTIFY pictureChanged)
  Q_PROPERTY(double textPixels MEMBER text_pixels_ WRITE set_text_pixels)
  Q_PROPERTY(double seenHeight MEMBER seen_height_ WRITE set_seen_height)
  Q_PROPERTY(double neededHeight READ needed_height NOTIFY neededHeightChanged)
  /// The colour of the card, and whether the figure is drawn for the dark theme.
  Q_PROPERTY(QColor paper MEMBER paper_ WRITE set_paper)
  Q_PROPERTY(bool dark MEMBER dark_ WRITE set_dark)

 public:
  explicit FigureView(QQuickItem* parent = nullptr);
  QVariant picture() const { return QVariant::fromValue(picture_); }
  void set_picture(const QVariant& picture);  // the setter of a QML property must have this name (NOLINT)
  void set_text_pixels(double pixels);        // NOLINT
  void set_seen_height(double height);        // NOLINT
  double needed_height() const { return needed_height_; }
  void set_paper(const QColor& paper);  // NOLINT
  void set_dark(bool dark);             // NOLINT
  void paint(QPainter* painter) override;

 Q_SIGNALS:
  void pictureChanged();
  void neededHeightChanged();

 protected:
  void geometryChange(const QRectF& now, const QRectF& before) override;  // NOLINT

 private:
  void lay_out();

  Picture picture_;
  std::optional<report::Figure> scrolled_;  ///< the figure as it is laid out to be scrolled
  double text_pixels_ = 12, seen_height_ = 0, needed_height_ = 0;
  QColor paper_ = Qt::white;
  bool dark_ = false;
};

}  // namespace turnpoint::ui
