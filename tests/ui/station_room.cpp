#include "tests/ui/station_room.hpp"
#include "tests/support/simulated_run.hpp"

#include <QDir>
#include <QDirIterator>
#include <QFile>
#include <QGuiApplication>
#include <QQmlEngine>
#include <QScreen>
#include <QTest>
#include <chrono>
#include <csignal>
#include <fstream>

#include "station/core/canonical.hpp"
#include "station/core/number.hpp"
#include "station/core/read_file.hpp"
#include "station/maintenance/calibrate.hpp"
#include "station/maintenance/panel_latency.hpp"
#include "station/rig/apply.hpp"
#include "station/session/places.hpp"
#include "station/session/planned_session.hpp"
#include "station/session/prepare.hpp"
#include "station/store/export.hpp"
#include "station/store/session_log.hpp"
#include "station/store/station.hpp"
#include "tests/support/child.hpp"

namespace turnpoint::ui {

namespace {

std::int64_t now_ns() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

void write(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

}  // namespace

StationRoom::StationRoom(QObject* parent) : QObject(parent) {
  beat_.setTimerType(Qt::PreciseTimer);
  beat_.setInterval(16);
  connect(&beat_, &QTimer::timeout, this, [this] {
    const double late_ms = 1e-6 * static_cast<double>(now_ns() - beat_ns_);
    beat_ns_ = now_ns();
    if (late_ms > 25) stalls_ += static_cast<int>(late_ms / (1e3 / 60));
  });
}

StationRoom::~StationRoom() { close(); }

void StationRoom::open(const QString& code) {
  close();
  folder_ = std::make_unique<QTemporaryDir>();
  QDir(folder_->path()).mkdir("protocols");
  QFile::copy(TURNPOINT_SOURCE_DIR "/tests/ui/short.toml", folder_->filePath("protocols/short.toml"));
  QFile::copy(TURNPOINT_SOURCE_DIR "/tests/support/thin_plate.toml", folder_->filePath("rig.toml"));
  latency_.again();
  reopen(code);
}

void StationRoom::entitle(const QString& title) {
  QFile file(folder_->filePath("protocols/short.toml"));
  if (!file.open(QIODevice::ReadOnly)) return;
  auto lines = QString::fromUtf8(file.readAll()).split('\n');
  file.close();
  for (auto& line : lines)
    if (line.startsWith("title = ")) line = "title = '" + title + "'";
  write(path("protocols/short.toml"), lines.join('\n').toStdString());
}

void StationRoom::reopen(const QString& code) {
  start(view::OperatorCode::of_digits(code.toStdString()), Begins::open);
}

void StationRoom::reopenLocked(const QString& code) {
  start(view::OperatorCode::of_digits(code.toStdString()), Begins::locked);
}

void StationRoom::reopenBuiltIn() { start(view::OperatorCode(), Begins::locked); }

void StationRoom::reopenEmpty(const QString& code) {
  QFile::remove(folder_->filePath("protocols/short.toml"));
  reopen(code);
}

void StationRoom::start(const view::OperatorCode& code, Begins begins) {
  start_with({path("protocols"), path("rig.toml"), path("lab.sqlite"), begins == Begins::locked}, code);
}

void StationRoom::openNew() {
  close();
  folder_ = std::make_unique<QTemporaryDir>();
  start_with({session::shipped("protocols"), session::shipped("deploy/rigs") + "/simulated.toml",
              path("lab.sqlite")},
             view::OperatorCode());
}

void StationRoom::start_with(const session::StationRequest& request, const view::OperatorCode& code) {
  close();
  operating_ = std::make_unique<OperatorController>(request);
  station_ = std::make_unique<StationWindow>(
      StationWindow::Place{5.9, QSize(1280, 800), false},
      StationWindow::Operator{operating_.get(), code, request.locked, disks(), path("operator-code")},
      path("lab.sqlite"));
  Q_EMIT opened();
}

maintenance::DiskSources StationRoom::disks() const {
  return {path("block"), path("mountinfo"), path("udisksctl")};
}

OperatorScreen* StationRoom::look() const {
  if (!station_) return nullptr;
  auto* engine = qmlEngine(&station_->window());
  auto* screen = engine->singletonInstance<OperatorScreen*>(qmlTypeId("Turnpoint", 1, 0, "OperatorScreen"));
  // Otherwise the tests' own engine, which did not make it, collects it as garbage.
  QQmlEngine::setObjectOwnership(screen, QQmlEngine::CppOwnership);
  return screen;
}

void StationRoom::plugIn() {
  const QDir folder(folder_->path());
  for (const auto* made : {"block/sda/sda1", "block/sda/device", "stick"}) folder.mkpath(made);
  write(path("block/sda/removable"), "1\n");
  write(path("block/sda/size"), "31250000\n");
  write(path("block/sda/device/model"), "Test\n");
  write(path("block/sda/sda1/partition"), "1\n");
  write(path("block/sda/sda1/dev"), "8:1\n");
  write(path("udisksctl"),
        "#!/bin/sh\nhere=$(dirname \"$0\")\nprintf '%s ' \"$1\" >> \"$here/asked\"\n"
        "case $1 in\n"
        "mount) echo \"31 25 8:1 / $here/stick rw - vfat /dev/sda1 rw\" > \"$here/mountinfo\";;\n"
        "unmount) rm \"$here/mountinfo\";;\nesac\n");
  QFile::setPermissions(folder_->filePath("udisksctl"),
                        QFile::ReadOwner | QFile::WriteOwner | QFile::ExeOwner);
}

void StationRoom::planSessions() {
  {
    std::ofstream file(path("protocols/short.toml"), std::ios::app);
    file << "\n[sessions]\ncount = 2\nmin_days = 1\n";
  }
  core::SessionStart start;
  start.participant = "T1", start.protocol_id = "short", start.planned_session = 1;
  start.run_mode = core::RunMode::pilot;
  start.station_id = store::suggested_station_name(), start.started_local = session::local_time();
  store::SessionLog::begin(path("lab.sqlite"), start, {}).finish(core::SessionStatus::completed, "");
}

void StationRoom::recordSessions() {
  core::SegmentStart segment;
  using Visit = std::pair<const char*, const char*>;
  for (const auto& [person, study] :
       {Visit{"P02", "bands"}, Visit{"P01", "short"}, Visit{"P02", "short"}, Visit{"P01", "bands"}}) {
    core::SessionStart start;
    start.participant = person, start.protocol_id = study, start.protocol_version = "1.0.0";
    start.run_mode = core::RunMode::pilot;
    start.station_id = store::suggested_station_name(), start.started_local = session::local_time();
    segment.realtime_ns += 60'000'000'000;  // a minute after the one before
    store::SessionLog::begin(path("lab.sqlite"), start, segment).finish(core::SessionStatus::completed, "");
  }
}

QString StationRoom::askedUdisks() const {
  QFile file(folder_->filePath("asked"));
  return file.open(QIODevice::ReadOnly) ? QString::fromUtf8(file.readAll()).trimmed() : QString();
}

QStringList StationRoom::filesIn(const QString& folder) const {
  QStringList files;
  const QDir below(folder_->filePath(folder));
  for (QDirIterator all(below.path(), QDir::AllEntries | QDir::NoDotAndDotDot, QDirIterator::Subdirectories);
       all.hasNext();)
    files += below.relativeFilePath(all.next());
  files.sort();
  return files;
}

QString StationRoom::startOf(const QString& folder, const QString& ending, int bytes) const {
  for (const auto& name : filesIn(folder)) {
    QFile file(folder_->filePath(folder + "/" + name));
    if (name.endsWith(ending) && file.open(QIODevice::ReadOnly)) return QString::fromLatin1(file.read(bytes));
  }
  return {};
}

void StationRoom::pressKey(int key) { QTest::keyPress(&station_->window(), static_cast<Qt::Key>(key)); }
void StationRoom::releaseKey(int key) { QTest::keyRelease(&station_->window(), static_cast<Qt::Key>(key)); }

void StationRoom::addMistaken() {
  write(path("protocols/mistaken.toml"), "format = \"friction-protocol/1\"\nprotocl = 3\ntitel = \"x\"\n");
}

void StationRoom::damageDatabase() { write(path("lab.sqlite"), "rubbish " + std::string(5000, 'x')); }

void StationRoom::close() {
  second_ = nullptr;
  station_.reset();
  operating_.reset();
  Q_EMIT opened();
}

void StationRoom::addSecondScreen() {
  second_ = &station_->show_live_window(*QGuiApplication::primaryScreen());
  Q_EMIT opened();
}

void StationRoom::calibrate() {
  std::string sweep = "frequency_Hz,displacement_um,phase_deg\n";
  for (int frequency_Hz = 20000; frequency_Hz <= 50000;
       frequency_Hz += 500)  // the calibration contains no resonance
    sweep += std::to_string(frequency_Hz) + "," + core::number(0.3 + 4e-6 * frequency_Hz) + ",-20\n";
  write(path("sweep.csv"), sweep);
  write(path("friction.csv"), "displacement_um,relative_friction\n0,1\n0.5,0.6\n1,0.4\n2,0.2\n4,0.15\n");
  write(path("sound.csv"), "frequency_Hz,level_dB\n20000,60\n30000,70\n50000,80\n");
  rig::Measurements measurements;
  measurements.sweeps = {{"main", path("sweep.csv"), 0.1}};
  measurements.friction_csv = path("friction.csv");
  measurements.sound_csv = path("sound.csv");
  const auto rig = rig::load(path("rig.toml"));
  auto made = maintenance::calibrate(rig, measurements, 30, "");
  maintenance::keep_devices(rig, made);
  write(rig::file_for(rig.path, made.made_on), rig::to_toml(made));
}

QString StationRoom::shipped(const QString& protocol) const {
  return QString::fromStdString(
      core::read_file(TURNPOINT_SOURCE_DIR "/protocols/" + protocol.toStdString() + ".toml"));
}

QString StationRoom::canonical(const QString& text) const {
  return QString::fromStdString(core::canonical(core::parse_toml(text.toStdString(), "")));
}

void StationRoom::addCells() {
  QFile file(folder_->filePath("rig.toml"));
  if (!file.open(QIODevice::Append)) return;
  file.write(
      "\n[capture]\nuri = \"sim:\"\nchannels = 8\npickups = [5, 6]\nreference = 0\nexcitation_channel = 3\n"
      "bridges = [1, 2, 3]\n");
}

void StationRoom::addGuidance() {
  std::ofstream file(path("protocols/short.toml"), std::ios::app);
  file << "\n[sensing]\nnormal_N = [0.3, 0.8]\nspeed_mm_s = [40, 120]\nstrokes = 1\nguidance = true\n"
          "live_guidance = true\n";
}

void StationRoom::pretendPanel(CalibrationGuide* guide) {
  guide->open_panel_with([](LatencyController&, const rig::Rig&) {});
}

void StationRoom::pressed(double ago_ms) {
  latency_.edge(now_ns() - static_cast<std::int64_t>(ago_ms * 1e6));
}

double StationRoom::keepLatency() {
  latency_.keep();
  const auto kept = latency_.kept();
  if (!kept) return 0;
  const auto rig = rig::load(path("rig.toml"));
  write(rig::file_for(rig.path, rig::today()), rig::to_toml(maintenance::with_panel(rig, *kept)));
  return kept->touch->median_s;
}

int StationRoom::cutOffSession(const QString& mode) {
  const auto path = [this](const char* name) { return folder_->filePath(name).toStdString(); };
  Child child({CUT_OFF_SESSION, path("protocols/short.toml"), path("rig.toml"), path("lab.sqlite"),
               mode.toStdString()});
  if (!child.ends_within(60'000)) return 0;
  if (child.outcome() != -SIGKILL) qWarning("%s", child.said().c_str());
  return child.outcome();
}

void StationRoom::lookOn() {
  stalls_ = 0;
  beat_ns_ = now_ns();
  beat_.start();
}

int StationRoom::stallsSeen() {
  beat_.stop();
  return stalls_;
}

double StationRoom::pressUntilShown(QQuickItem* item) {
  auto& window = station_->window();
  const auto before = window.grabWindow();
  const auto centre = item->mapToScene({item->width() / 2, item->height() / 2}).toPoint();
  std::int64_t frame_ns = 0;
  const auto frames = connect(&window, &QQuickWindow::frameSwapped, this, [&] { frame_ns = now_ns(); });
  const auto start_ns = now_ns();
  QTest::mousePress(&window, Qt::LeftButton, Qt::NoModifier, centre);
  bool changed = false;
  while (!changed && now_ns() - start_ns < 1'000'000'000) {
    QCoreApplication::processEvents();
    if (frame_ns != 0) changed = window.grabWindow() != before;
    if (!changed) frame_ns = 0;
  }
  disconnect(frames);
  const QPoint elsewhere{window.width() / 2, 1};
  QTest::mouseMove(&window, elsewhere);
  QTest::mouseRelease(&window, Qt::LeftButton, Qt::NoModifier, elsewhere);
  return changed ? 1e-6 * static_cast<double>(frame_ns - start_ns) : -1;
}

void StationRoom::block(int ms) {
  const auto until = now_ns() + std::int64_t{1'000'000} * ms;
  while (now_ns() < until) {
  }
}

QStringList StationRoom::plannedLevels() const {
  auto request = simulated_run(path("protocols/short.toml"), path("unbroken.sqlite"));
  request.rig = path("rig.toml");
  request.participant = "T1";
  session::Inputs inputs;
  session::run(session::prepare(request), nullptr, inputs);
  return read(request.database, "trials.csv", "level", {}, {});
}

QStringList StationRoom::column(const QString& file, const QString& name, const QString& where,
                                const QString& is) const {
  return read(path("lab.sqlite"), file, name, where, is);
}

QStringList StationRoom::read(const std::string& database, const QString& file, const QString& name,
                              const QString& where, const QString& is) const {
  const QTemporaryDir out;
  store::export_data(database, out.path().toStdString(), {});
  const auto study = QDir(out.path()).entryList(QDir::Dirs | QDir::NoDotAndDotDot).value(0);
  QFile csv(out.filePath(study + "/" + file));
  if (!csv.open(QIODevice::ReadOnly)) return {"no " + file};
  const auto header = QString(csv.readLine()).trimmed().split(',');
  QStringList values;
  while (!csv.atEnd()) {
    const auto row = QString(csv.readLine()).trimmed().split(',');
    if (where.isEmpty() || row.value(header.indexOf(where)) == is) values += row.value(header.indexOf(name));
  }
  return values;
}

}  // namespace turnpoint::ui
