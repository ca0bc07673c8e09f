#include "station/ui/operator/figure_view.hpp"

#include <QBuffer>
#include <QPainter>
#include <QPdfWriter>
#include <stdexcept>
#include <string>

#include "station/system/write_file.hpp"
#include "station/ui/operator/painter_canvas.hpp"

namespace turnpoint::ui {

namespace {

constexpr double kMargin = 6;
// text size that figures are laid out for; they are then scaled to the item's text size
constexpr double kDrawnText_px = 12;

constexpr double kFigureInch_mm = 25.4, kPixelsPerInch = 96;

std::string pdf_of(const report::Figure& figure) {
  const auto [width_px, height_px] = report::size_px(figure);
  const QSizeF size_px(width_px, height_px);
  QByteArray bytes;
  QBuffer buffer(&bytes);
  buffer.open(QIODevice::WriteOnly);
  QPdfWriter writer(&buffer);
  writer.setPageMargins(QMarginsF());
  writer.setPageSize(
      QPageSize(size_px * kFigureInch_mm / kPixelsPerInch, QPageSize::Millimeter, {}, QPageSize::ExactMatch));
  QPainter painter;
  if (!painter.begin(&writer)) throw std::logic_error("Qt cannot make a PDF");
  {
    PainterCanvas canvas(painter, QRectF(0, 0, writer.width(), writer.height()));
    report::draw(canvas, figure);
  }
  painter.end();
  return bytes.toStdString();
}

}  // namespace

void save_figure(const report::NamedFigure& figure, const QString& folder) {
  system::make_folder(folder.toStdString());
  for (const auto& file : report::figure_files(figure, pdf_of))
    system::write_file((folder + "/").toStdString() + file.name, file.bytes);
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
