// Starts the station on an X server, and reads and uses the operator's pages over AT-SPI, as a screen reader
// does. Needs a session bus, an X server and at-spi2-core (`dbus-run-session -- xvfb-run`).
#include <QCoreApplication>
#include <QDBusArgument>
#include <QDBusConnection>
#include <QDBusInterface>
#include <QDBusMessage>
#include <QDBusReply>
#include <QDBusVariant>
#include <QElapsedTimer>
#include <QProcess>
#include <QTemporaryDir>
#include <QThread>
#include <functional>
#include <vector>

#include "tests/support/catch.hpp"

namespace {

const QString kAccessible = "org.a11y.atspi.Accessible";
const QString kBus = "screen-reader";
constexpr int kPatience_ms = 30000;

/// An object on the bus of AT-SPI.
struct Node {
  QString service, path;
};

/// An object as a screen reader reads it aloud.
struct Heard {
  Node node;
  QString role, name;
};

/// Asks an object; an object that has gone meanwhile gives an empty list.
QList<QVariant> ask(const Node& node, const QString& interface, const QString& method,
                    const QList<QVariant>& arguments = {}) {
  auto call = QDBusMessage::createMethodCall(node.service, node.path, interface, method);
  call.setArguments(arguments);
  return QDBusConnection(kBus).call(call, QDBus::Block, 5000).arguments();
}

std::vector<Node> children_of(const Node& node) {
  std::vector<Node> children;
  const auto answer = ask(node, kAccessible, "GetChildren");
  if (answer.isEmpty() || !answer[0].canConvert<QDBusArgument>()) return children;
  const auto list = answer[0].value<QDBusArgument>();
  list.beginArray();
  while (!list.atEnd()) {
    QString service;
    QDBusObjectPath path;
    list.beginStructure();
    list >> service >> path;
    list.endStructure();
    children.push_back({service, path.path()});
  }
  return children;
}

QString name_of(const Node& node) {
  const auto answer = ask(node, "org.freedesktop.DBus.Properties", "Get", {kAccessible, "Name"});
  return answer.isEmpty() ? QString() : answer[0].value<QDBusVariant>().variant().toString();
}

/// True if the object is on the screen. A screen reader leaves out all others.
bool is_showing(const Node& node) {
  constexpr unsigned showing = 25;  // AtspiStateType
  const auto answer = ask(node, kAccessible, "GetState");
  if (answer.isEmpty() || !answer[0].canConvert<QDBusArgument>()) return false;
  QList<unsigned> bits;
  answer[0].value<QDBusArgument>() >> bits;
  return !bits.isEmpty() && ((bits[0] >> showing) & 1U) != 0;
}

/// Presses a control, as a screen reader or a switch does. Returns false if it cannot be pressed.
bool press(const Node& node) {
  const auto answer = ask(node, "org.a11y.atspi.Action", "GetActions");
  if (answer.isEmpty() || !answer[0].canConvert<QDBusArgument>()) return false;
  const auto list = answer[0].value<QDBusArgument>();
  int press = -1;
  list.beginArray();
  for (int index = 0; !list.atEnd(); ++index) {
    QString name, description, keys;
    list.beginStructure();
    list >> name >> description >> keys;
    list.endStructure();
    if (name == "Press") press = index;
  }
  list.endArray();
  if (press < 0) return false;
  const auto done = ask(node, "org.a11y.atspi.Action", "DoAction", {press});
  return !done.isEmpty() && done[0].toBool();
}

void listen(const Node& node, std::vector<Heard>& heard) {
  if (!is_showing(node)) return;
  const auto role = ask(node, kAccessible, "GetRoleName");
  heard.push_back({node, role.isEmpty() ? QString() : role[0].toString(), name_of(node)});
  for (const auto& child : children_of(node)) listen(child, heard);
}

/// The station, started in an empty folder, on the bus of AT-SPI.
class Station {
 public:
  Station() {
    const QDBusReply<QString> address =
        QDBusInterface("org.a11y.Bus", "/org/a11y/bus", "org.a11y.Bus").call("GetAddress");
    REQUIRE(address.isValid());
    QDBusConnection::connectToBus(address.value(), kBus);
    auto environment = QProcessEnvironment::systemEnvironment();
    environment.insert("QT_QPA_PLATFORM", "xcb");
    environment.insert("QT_QUICK_BACKEND", "software");
    environment.insert("QT_LINUX_ACCESSIBILITY_ALWAYS_ON", "1");
    program_.setProcessEnvironment(environment);
    program_.setProcessChannelMode(QProcess::ForwardedChannels);
    program_.start(TURNPOINT_UI, {"station", "--rig", TURNPOINT_SOURCE_DIR "/tests/support/thin_plate.toml",
                                  "--db", folder_.filePath("lab.sqlite")});
  }
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;
  ~Station() {
    program_.terminate();
    if (!program_.waitForFinished(10000)) program_.kill();
    program_.waitForFinished(10000);
    QDBusConnection::disconnectFromBus(kBus);
  }

  std::vector<Heard> heard() const {
    std::vector<Heard> all;
    for (const auto& application :
         children_of({"org.a11y.atspi.Registry", "/org/a11y/atspi/accessible/root"}))
      for (const auto& window : children_of(application)) listen(window, all);
    return all;
  }
  /// Waits until there is an object with this role and name, and returns it. A name that ends with an
  /// ellipsis is the beginning of one.
  Heard await(const QString& role, const QString& name) const {
    QElapsedTimer waited;
    waited.start();
    while (waited.elapsed() < kPatience_ms) {
      for (const auto& object : heard())
        if (object.role == role &&
            (object.name == name || (name.endsWith(u'…') && object.name.startsWith(name.chopped(1)))))
          return object;
      QThread::msleep(200);
    }
    QString all;
    for (const auto& object : heard()) all += object.role + ": " + object.name + "\n";
    FAIL("no " << role.toStdString() << " \"" << name.toStdString() << "\" in\n" << all.toStdString());
    return {};
  }

 private:
  QTemporaryDir folder_;
  QProcess program_;
};

/// Controls must have a name; texts and groups say what they show.
bool is_control(const QString& role) {
  return role == "push button" || role == "button" || role == "page tab" || role == "list item" ||
         role == "slider" || role == "text" || role == "entry";
}

}  // namespace

namespace {

/// Checks that each control which is shown has a name. Returns how many there are.
int named_controls(const Station& station) {
  int controls = 0;
  for (const auto& object : station.heard()) {
    if (!is_control(object.role)) continue;
    ++controls;
    INFO(object.role.toStdString() << " " << object.node.path.toStdString());
    CHECK_FALSE(object.name.trimmed().isEmpty());
  }
  return controls;
}

}  // namespace

TEST_CASE("the operator's pages are read and used over AT-SPI", "[at-spi]") {
  int argc = 1;
  char name[] = "test_at_spi";
  char* argv[] = {name, nullptr};
  const QCoreApplication application(argc, argv);
  const Station station;
  for (const char* tab : {"Run", "Studies", "Sessions", "Rig"}) station.await("page tab", tab);
  station.await("push button", "Begin pilot");
  CHECK(named_controls(station) > 8);

  // Each page is opened by pressing its tab, and shows a control and a text of its own.
  const struct {
    const char *tab, *button, *text;
  } pages[] = {
      {"Studies", "New study", "The session"},
      {"Sessions", "Withdraw participant …", "No session has been recorded yet. Begin one under Run."},
      {"Rig", "Examine the rig", "This screen"}};
  for (const auto& page : pages) {
    REQUIRE(press(station.await("page tab", page.tab).node));
    station.await("push button", page.button);
    station.await("label", page.text);
    CHECK(named_controls(station) > 5);
  }

  // A protocol is chosen, and the participant's code is asked for.
  REQUIRE(press(station.await("page tab", "Run").node));
  REQUIRE(press(station.await("list item", "demo, Demo: where does the smooth part end?").node));
  station.await("label", "main, trials: 10, …");  // what `check` says of the demo
  REQUIRE(press(station.await("push button", "enter it now").node));
  station.await("push button", "A");
  CHECK(named_controls(station) > 20);
}
