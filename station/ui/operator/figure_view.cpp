#include "station/ui/operator/figure_view.hpp"

#include <QGuiApplication>
#include <QPainter>
#include <QRegularExpression>
#include <QSvgRenderer>

namespace turnpoint::ui {

namespace {

constexpr double kMargin = 6;
constexpr double kDrawnText_px = 12;  // text size of every drawing

/// Drawings name several families for browsers. Qt would take such a list for the name of one family.
QString in_pages_font(QString svg) {
  static const QRegularExpression families("font-family=\"[^\"]*\"");
  return svg.replace(families, "font-family=\"" + QGuiApplication::font().families().value(0) + "\"");
}

/// Qt draws the content of a clip path instead of clipping by it, so remove clip paths.
QString without_clips(QString svg) {
  static const QRegularExpression clips("<clipPath.*?</clipPath>",
                                        QRegularExpression::DotMatchesEverythingOption);
  return svg.remove(clips);
}

}  // namespace

QVariant to_variant(const desk::Drawing& drawing) { return QVariant::fromValue(Picture{drawing}); }

FigureView::FigureView(QQuickItem* parent) : QQuickPaintedItem(parent) { setAntialiasing(true); }

void FigureView::set_picture(const QVariant& picture) {
  picture_ = picture.value<Picture>();
  emit pictureChanged();
  update();
}

void FigureView::paint(QPainter* painter) {
  const QRectF card(0, 0, width(), height()), inside = card.adjusted(kMargin, kMargin, -kMargin, -kMargin);
  if (!picture_.draw || inside.width() < 1 || inside.height() < 1) return;
  const double scale = text_pixels_ / kDrawnText_px;
  const auto svg = QString::fromStdString(picture_.draw(inside.width() / scale, inside.height() / scale));
  QSvgRenderer renderer(without_clips(in_pages_font(svg)).toUtf8());
  renderer.setAspectRatioMode(Qt::KeepAspectRatio);
  // A card in the figures' white background, so that figures of other proportions fill the page.
  painter->setPen(Qt::NoPen);
  painter->setBrush(Qt::white);
  painter->drawRoundedRect(card, kMargin, kMargin);
  renderer.render(painter, inside);
}

}  // namespace turnpoint::ui
