#include "station/ui/operator/figure_view.hpp"

#include <QPainter>

#include "station/ui/operator/painter_canvas.hpp"

namespace turnpoint::ui {

namespace {

constexpr double kMargin = 6;
// text size that figures are laid out for; they are then scaled to the item's text size
constexpr double kDrawnText_px = 12;

}  // namespace

QVariant to_variant(const desk::Drawing& drawing) { return QVariant::fromValue(Picture{drawing}); }

FigureView::FigureView(QQuickItem* parent) : QQuickPaintedItem(parent) { setAntialiasing(true); }

void FigureView::set_picture(const QVariant& picture) {
  picture_ = picture.value<Picture>();
  Q_EMIT pictureChanged();
  update();
}

void FigureView::paint(QPainter* painter) {
  const QRectF card(0, 0, width(), height()), inside = card.adjusted(kMargin, kMargin, -kMargin, -kMargin);
  if (!picture_.draw || inside.width() < 1 || inside.height() < 1) return;
  // Fills the item with a card in the figures' white background, because a figure may have other proportions
  // than the item.
  painter->setPen(Qt::NoPen);
  painter->setBrush(Qt::white);
  painter->drawRoundedRect(card, kMargin, kMargin);
  const double scale = text_pixels_ / kDrawnText_px;
  PainterCanvas canvas(*painter, inside);
  picture_.draw(canvas, inside.width() / scale, inside.height() / scale);
}

}  // namespace turnpoint::ui

#include "moc_figure_view.cpp"
