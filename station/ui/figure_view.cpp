#include "station/ui/figure_view.hpp"

#include <QPainter>
#include <QRegularExpression>

namespace turnpoint::ui {

namespace {

constexpr double kMargin = 6;

/// Qt draws what a clip path holds instead of clipping by it.
QString without_clips(QString svg) {
  static const QRegularExpression clips("<clipPath.*?</clipPath>",
                                        QRegularExpression::DotMatchesEverythingOption);
  return svg.remove(clips);
}

}  // namespace

FigureView::FigureView(QQuickItem* parent) : QQuickPaintedItem(parent) {
  setAntialiasing(true);
  renderer_.setAspectRatioMode(Qt::KeepAspectRatio);
}

void FigureView::set_svg(const QString& svg) {
  if (svg == svg_) return;
  svg_ = svg;
  renderer_.load(without_clips(svg_).toUtf8());
  renderer_.setAspectRatioMode(Qt::KeepAspectRatio);
  emit svgChanged();
  update();
}

void FigureView::paint(QPainter* painter) {
  if (svg_.isEmpty() || !renderer_.isValid()) return;
  // A card in the pictures' own white, so that those of other proportions make one page.
  const QRectF card(0, 0, width(), height());
  painter->setPen(Qt::NoPen);
  painter->setBrush(Qt::white);
  painter->drawRoundedRect(card, kMargin, kMargin);
  renderer_.render(painter, card.adjusted(kMargin, kMargin, -kMargin, -kMargin));
}

}  // namespace turnpoint::ui
