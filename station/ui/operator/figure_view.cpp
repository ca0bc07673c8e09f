#include "station/ui/operator/figure_view.hpp"

#include <QDir>
#include <QPainter>
#include <QPdfWriter>
#include <stdexcept>

#include "station/core/texts.hpp"
#include "station/report/svg.hpp"
#include "station/system/write_file.hpp"
#include "station/ui/operator/painter_canvas.hpp"

namespace turnpoint::ui {

namespace {

constexpr double kMargin = 6;
// text size that figures are laid out for; they are then scaled to the item's text size
constexpr double kDrawnText_px = 12;

// size of a saved figure; at 96 px per inch it is 180 mm wide, as two columns of a journal
constexpr double kSavedWidth_px = 680, kSavedHeight_px = 450;
constexpr double kFigureInch_mm = 25.4, kPixelsPerInch = 96;

void save_pdf(const view::Drawing& drawing, const QString& path) {
  QPdfWriter writer(path);
  writer.setPageMargins(QMarginsF());
  writer.setPageSize(QPageSize(QSizeF(kSavedWidth_px, kSavedHeight_px) * kFigureInch_mm / kPixelsPerInch,
                               QPageSize::Millimeter, {}, QPageSize::ExactMatch));
  QPainter painter;
  if (!painter.begin(&writer))
    throw core::Failure(core::phrase("operator.not_written", {core::plain(path.toStdString())}));
  PainterCanvas canvas(painter, QRectF(0, 0, writer.width(), writer.height()));
  drawing(canvas, kSavedWidth_px, kSavedHeight_px);
}

}  // namespace

void save_drawing(const view::Drawing& drawing, const QString& folder, const QString& name) {
  if (!QDir().mkpath(folder))
    throw core::Failure(core::phrase("operator.not_made", {core::plain(folder.toStdString())}));
  const QString path = folder + "/" + name;
  report::Svg svg;
  drawing(svg, kSavedWidth_px, kSavedHeight_px);
  system::write_file((path + ".svg").toStdString(), svg.finish());
  save_pdf(drawing, path + ".pdf");
}

QVariant to_variant(const view::Drawing& drawing) { return QVariant::fromValue(Picture{drawing}); }

FigureView::FigureView(QQuickItem* parent) : QQuickPaintedItem(parent) { setAntialiasing(true); }

void FigureView::set_picture(const QVariant& picture) {
  picture_ = picture.value<Picture>();
  Q_EMIT pictureChanged();
  update();
}

void FigureView::set_paper(const QColor& paper) {
  paper_ = paper;
  update();
}

void FigureView::set_dark(bool dark) {
  dark_ = dark;
  update();
}

void FigureView::paint(QPainter* painter) {
  const QRectF card(0, 0, width(), height()), inside = card.adjusted(kMargin, kMargin, -kMargin, -kMargin);
  if (!picture_.draw || inside.width() < 1 || inside.height() < 1) return;
  // Fills the item with a card in the figures' background, because a figure may have other proportions than
  // the item.
  painter->setPen(Qt::NoPen);
  painter->setBrush(dark_ ? paper_ : QColor(Qt::white));
  painter->drawRoundedRect(card, kMargin, kMargin);
  const double scale = text_pixels_ / kDrawnText_px;
  PainterCanvas canvas(*painter, inside, dark_ ? PainterCanvas::Tone::dark : PainterCanvas::Tone::paper);
  picture_.draw(canvas, inside.width() / scale, inside.height() / scale);
}

}  // namespace turnpoint::ui

#include "moc_figure_view.cpp"
