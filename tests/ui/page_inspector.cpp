#include "tests/ui/page_inspector.hpp"

#include <QAccessible>
#include <functional>
#include <utility>

#include <sys/inotify.h>
#include <unistd.h>

#include <QFontMetricsF>
#include <QImage>
#include <QJSValue>
#include <QQuickWindow>
#include <QRegularExpression>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace turnpoint::ui {

namespace {

/// Relative luminance of a colour, as WCAG 2.1 defines it.
double luminance(QRgb colour) {
  const auto linear = [](int channel) {
    const double c = channel / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(qRed(colour)) + 0.7152 * linear(qGreen(colour)) + 0.0722 * linear(qBlue(colour));
}

/// Returns the contrast between the darkest and the lightest pixel of an area. If the area contains text,
/// these pixels belong to letters and background.
double contrast(const QImage& image, const QRect& place) {
  double darkest = 1, lightest = 0;
  for (int y = place.top(); y <= place.bottom(); ++y)
    for (int x = place.left(); x <= place.right(); ++x) {
      const double here = luminance(image.pixel(x, y));
      darkest = std::min(darkest, here), lightest = std::max(lightest, here);
    }
  return (lightest + 0.05) / (darkest + 0.05);
}

void each_text(const QQuickItem& item, const std::function<void(const QQuickItem&)>& look) {
  if (!item.isVisible() || !item.isEnabled() || item.opacity() < 1) return;
  const bool is_text = item.inherits("QQuickText");
  if (is_text && !item.property("text").toString().trimmed().isEmpty()) look(item);
  for (const auto* child : item.childItems()) each_text(*child, look);
}

/// Returns the part of an area that is visible, taking into account the items around `item` that clip it.
QRectF seen(const QQuickItem& item, QRectF area) {
  for (const auto* around = item.parentItem(); around != nullptr; around = around->parentItem())
    if (around->clip()) area = area.intersected(around->mapRectToScene(around->boundingRect()));
  return area;
}

void each_button(const QQuickItem& item, const std::function<void(const QQuickItem&)>& look) {
  if (!item.isVisible()) return;
  if (item.property("holdMs").isValid()) look(item);
  for (const auto* child : item.childItems()) each_button(*child, look);
}

bool has_ideographs(const QString& word) {
  return std::any_of(word.begin(), word.end(), [](QChar c) { return c.unicode() >= 0x2e80; });
}

/// Returns the area that the letters of a text cover, in pixels of the window.
QRectF letters(const QQuickItem& text) {
  const double width = text.property("contentWidth").toDouble();
  const double height = text.property("contentHeight").toDouble();
  const int across = text.property("horizontalAlignment").toInt();
  const int along = text.property("verticalAlignment").toInt();
  const double x = across == Qt::AlignHCenter ? (text.width() - width) / 2
                   : across == Qt::AlignRight ? text.width() - width
                                              : 0;
  const double y = along == Qt::AlignVCenter  ? (text.height() - height) / 2
                   : along == Qt::AlignBottom ? text.height() - height
                                              : 0;
  return text.mapRectToScene(QRectF(x, y, width, height));
}

}  // namespace

QStringList PageInspector::faintTexts(QQuickItem* page, double least) const {
  const QImage image = page->window()->grabWindow();
  QStringList faint;
  each_text(*page, [&](const QQuickItem& text) {
    const auto place = letters(text).toAlignedRect().intersected(image.rect());
    const double found = contrast(image, place);
    if (found < least) faint += text.property("text").toString() + ": " + QString::number(found, 'f', 2);
  });
  return faint;
}

QStringList PageInspector::cutTexts(QQuickItem* page) const {
  const QRectF room = page->mapRectToScene(page->boundingRect()).adjusted(-1, -1, 1, 1);
  QStringList cut;
  each_text(*page, [&](const QQuickItem& text) {
    const bool too_high = text.property("contentHeight").toDouble() > text.height() + 1;
    if (text.property("truncated").toBool() || too_high || !room.contains(letters(text)))
      cut += text.property("text").toString();
  });
  return cut;
}

QStringList PageInspector::brokenWords(QQuickItem* page) const {
  QStringList broken;
  each_text(*page, [&](const QQuickItem& text) {
    if (text.property("lineCount").toInt() < 2) return;
    QFont font = text.property("font").value<QFont>();
    // Qt may have shrunk the font so that the text fits, so use the size that Qt reports.
    font.setPixelSize(text.property("fontInfo").value<QJSValue>().property("pixelSize").toInt());
    const QFontMetricsF metrics(font);
    for (const auto& word : text.property("text").toString().split(QRegularExpression("[\\s\u00ad]+")))
      if (!has_ideographs(word) && metrics.horizontalAdvance(word) > text.width() + 1) broken += word;
  });
  return broken;
}

QStringList PageInspector::overlaps(QQuickItem* page) const {
  struct Thing {
    const QQuickItem* item;
    QRectF area;
    QString name;
  };
  page->window()->grabWindow();  // this lays out the page, so that every item is at its place
  std::vector<Thing> things;
  each_text(*page, [&](const QQuickItem& text) {
    things.push_back({&text, seen(text, letters(text)), text.property("text").toString()});
  });
  const auto texts = things.size();
  each_button(*page, [&](const QQuickItem& button) {
    things.push_back({&button, seen(button, button.mapRectToScene(button.boundingRect())),
                      "[" + button.objectName() + " " + button.property("text").toString() + "]"});
  });
  QStringList found;
  const QRectF room = page->mapRectToScene(page->boundingRect()).adjusted(-1, -1, 1, 1);
  for (const auto& thing : things)
    if (!thing.area.isEmpty() && !room.contains(thing.area)) found += thing.name + " / the edge of the page";
  for (std::size_t i = 0; i < things.size(); ++i)
    for (std::size_t k = std::max(i + 1, i < texts ? 0 : texts); k < things.size(); ++k) {
      const auto common = things[i].area.intersected(things[k].area);
      const bool inside = things[k].item->isAncestorOf(things[i].item);
      if (!inside && common.width() > 1.5 && common.height() > 1.5)
        found += things[i].name + " / " + things[k].name;
    }
  return found;
}

bool PageInspector::reachesEdge(QQuickItem* item) const {
  const QImage image = item->window()->grabWindow();
  const QRect place = item->mapRectToScene(item->boundingRect())
                          .toAlignedRect()
                          .intersected(image.rect())
                          .adjusted(1, 1, -1, -1);
  const auto ground = image.pixel(place.topLeft());
  for (int y = place.top(); y <= place.bottom(); ++y)
    if (image.pixel(place.left(), y) != ground || image.pixel(place.right(), y) != ground) return true;
  return false;
}

PageInspector::~PageInspector() {
  if (watch_ >= 0) ::close(watch_);
}

namespace {

const char* role_word(QAccessible::Role role) {
  switch (role) {
    case QAccessible::Button:
      return "button";
    case QAccessible::PageTab:
      return "tab";
    case QAccessible::ListItem:
      return "item";
    case QAccessible::EditableText:
      return "text";
    case QAccessible::Slider:
      return "slider";
    default:
      return "";
  }
}

/// Returns the role and the name of an item as assistive technology reads them; both are "" if it does not
/// find the item.
std::pair<QString, QString> read_aloud(QQuickItem* item) {
  auto* interface = QAccessible::queryAccessibleInterface(item);
  if (interface == nullptr || !interface->isValid()) return {};
  return {role_word(interface->role()), interface->text(QAccessible::Name)};
}

/// True for an item that acts on touches: one with a tap handler, or an area that is no mere shield.
bool reacts_to_taps(const QQuickItem* item) {
  for (const auto* child : item->children())
    if (child->inherits("QQuickTapHandler")) return true;
  return item->inherits("QQuickMouseArea") && item->isEnabled() && !item->property("shield").toBool();
}

void for_each_visible(QQuickItem* item, const std::function<void(QQuickItem*)>& visit) {
  if (!item->isVisible()) return;
  visit(item);
  for (auto* child : item->childItems()) for_each_visible(child, visit);
}

}  // namespace

QStringList PageInspector::controls(QQuickItem* page) const {
  QStringList found;
  for_each_visible(page, [&found](QQuickItem* item) {
    const auto [role, name] = read_aloud(item);
    if (!role.isEmpty()) found += role + ": " + name;
  });
  return found;
}

QStringList PageInspector::unnamedControls(QQuickItem* page) const {
  QStringList found;
  for_each_visible(page, [&found](QQuickItem* item) {
    const auto [role, name] = read_aloud(item);
    // An area may lie in the control whose touches it takes.
    const bool inside = item->inherits("QQuickMouseArea") && !read_aloud(item->parentItem()).first.isEmpty();
    if (role.isEmpty() ? reacts_to_taps(item) && !inside : name.trimmed().isEmpty())
      found += QString(item->metaObject()->className()) + " " + item->objectName() + " " + role;
  });
  return found;
}

QStringList PageInspector::unreadTexts(QQuickItem* page) const {
  QStringList found;
  for_each_visible(page, [&found](QQuickItem* item) {
    const auto text = item->property("text").toString();
    if (!item->inherits("QQuickText") || text.trimmed().isEmpty()) return;
    bool in_control = false;
    for (auto* around = item->parentItem(); around != nullptr; around = around->parentItem())
      in_control = in_control || !read_aloud(around).second.isEmpty();
    auto* interface = QAccessible::queryAccessibleInterface(item);
    const bool read = item->property("readAloud").toBool() && interface != nullptr &&
                      interface->role() == QAccessible::StaticText &&
                      interface->text(QAccessible::Name) == text;
    if (read == in_control) found += (read ? "twice: " : "not read: ") + text;
  });
  return found;
}

QString PageInspector::picture() {
  const auto path = folder_.filePath("picture.png");
  QImage image(40, 40, QImage::Format_RGB32);
  image.fill(Qt::red);
  image.save(path);
  if (watch_ >= 0) ::close(watch_);
  watch_ = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  opened_ = 0;
  if (::inotify_add_watch(watch_, path.toLocal8Bit().constData(), IN_OPEN) < 0) qFatal("inotify");
  return path;
}

int PageInspector::opened() {
  alignas(inotify_event) char events[4096];
  for (auto size = ::read(watch_, events, sizeof events); size > 0;
       size = ::read(watch_, events, sizeof events))
    opened_ += static_cast<int>(static_cast<std::size_t>(size) / sizeof(inotify_event));
  return opened_;
}

QStringList PageInspector::blurredEdges(QQuickItem* page) const {
  QStringList found;
  const auto whole = [](double value) { return std::abs(value - std::round(value)) < 0.01; };
  const std::function<void(const QQuickItem&)> look = [&](const QQuickItem& item) {
    if (!item.isVisible()) return;
    const bool button = item.property("holdMs").isValid() || item.objectName().startsWith("answer") ||
                        item.objectName().startsWith("key");
    if (button) {
      const auto area = item.mapRectToScene(item.boundingRect());
      if (!whole(area.x()) || !whole(area.y()) || !whole(area.width()) || !whole(area.height()))
        found += QString("%1 %2: %3, %4, %5 x %6")
                     .arg(item.objectName(), item.property("text").toString())
                     .arg(area.x())
                     .arg(area.y())
                     .arg(area.width())
                     .arg(area.height());
    }
    for (const auto* child : item.childItems()) look(*child);
  };
  look(*page);
  return found;
}

QStringList PageInspector::smallTexts(QQuickItem* page, double capitals_px) const {
  QStringList small;
  each_text(*page, [&](const QQuickItem& text) {
    QFont font = text.property("font").value<QFont>();
    font.setPixelSize(text.property("fontInfo").value<QJSValue>().property("pixelSize").toInt());
    // An item around the text may have a scale of its own.
    const double scale = text.mapRectToScene(QRectF(0, 0, 1, 1)).height();
    const double found = scale * 0.727 * font.pixelSize();  // the capitals of Inter
    if (found < capitals_px - 0.05)
      small +=
          text.property("text").toString() + ": capitals of " + QString::number(found, 'f', 1) + " pixels";
  });
  return small;
}

int PageInspector::texts(QQuickItem* page) const {
  int count = 0;
  each_text(*page, [&count](const QQuickItem&) { ++count; });
  return count;
}

}  // namespace turnpoint::ui
