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
QVariant to_variant(const report::Figure& figure) {
  return QVariant::fromValue(Picture{view::drawing_of(figure), figure});
}

FigureView::FigureView(QQuickItem* parent) : QQuickPaintedItem(parent) { setAntialiasing(true); }

void FigureView::set_picture(const QVariant& picture) {
  picture_ = picture.value<Picture>();
  Q_EMIT pictureChanged();
  lay_out();
}

void FigureView::set_text_pixels(double pixels) {
  text_pixels_ = pixels;
  lay_out();
}

void FigureView::set_seen_height(double height) {
  seen_height_ = height;
  lay_out();
}

void FigureView::geometryChange(const QRectF& now, const QRectF& before) {
  QQuickPaintedItem::geometryChange(now, before);
  if (now.width() != before.width()) lay_out();
}

void FigureView::lay_out() {
  update();
  scrolled_.reset();
  const double width_px = width() - 2 * kMargin, seen_px = seen_height_ - 2 * kMargin;
  double needed = seen_height_;
  if (picture_.figure && width_px >= 1 && seen_px >= 1) {
    const double scale = text_pixels_ / kDrawnText_px;
    scrolled_ = report::laid_out_to_scroll(*picture_.figure, width_px / scale, seen_px / scale);
    const auto [drawn_width, drawn_height] = report::size_px(*scrolled_);
    needed = 2 * kMargin + drawn_height * width_px / drawn_width;
  }
  if (needed == needed_height_) return;
  needed_height_ = needed;
  Q_EMIT neededHeightChanged();
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
  if (scrolled_)
    report::draw(canvas, *scrolled_);
  else
    picture_.draw(canvas, inside.width() / scale, inside.height() / scale);
}

}  // namespace turnpoint::ui

#include "moc_figure_view.cpp"
