#include "tests/ui/real_session.hpp"

#include <QFile>
#include <chrono>

#include "station/session/prepare.hpp"
#include "station/store/export.hpp"
#include "tests/support/shared_lines.hpp"

namespace turnpoint::ui {

RealSession::RealSession(QObject* parent)
    : QObject(parent),
      bridge_([] { return std::chrono::steady_clock::now().time_since_epoch().count(); },
              [this](session::Input input) { inputs_.push(std::move(input)); }) {}

RealSession::~RealSession() { end(); }

void RealSession::end() {
  inputs_.push({bridge_.now_ns(), session::input::Stop{}});
  if (thread_.joinable()) thread_.join();
}

void RealSession::start(const QString& protocol) {
  if (thread_.joinable()) end();
  inputs_.drain();
  over_ = false;
  failure_.clear();
  ++sessions_;
  protocol_ = protocol.section('.', 0, 0);
  lines_ = std::make_shared<io::SimulatedLines>(SharedLines::count);
  session::RunRequest request;
  request.protocol = TURNPOINT_SOURCE_DIR "/tests/ui/" + protocol.toStdString();
  request.rig = TURNPOINT_SOURCE_DIR "/tests/support/thin_plate.toml";
  request.participant = "T1";
  request.database = database().toStdString();
  thread_ = std::jthread([this, request, number = sessions_] {
    QString failure;
    try {
      session::Devices devices;
      devices.amplifier = guarded(lines_);
      session::run(session::prepare(request), &bridge_, inputs_, std::move(devices));
    } catch (const std::exception& error) {
      failure = error.what();
    }
    QMetaObject::invokeMethod(this, [this, failure, number] {
      if (number != sessions_) return;  // this comes from an earlier session, so ignore it
      over_ = true;
      failure_ = failure;
      Q_EMIT ended();
    });
  });
}

void RealSession::setStop(bool pressed) { lines_->set(SharedLines::stop, pressed, bridge_.now_ns()); }
void RealSession::setAmplifierFault(bool active) {
  lines_->set(SharedLines::fault, active, bridge_.now_ns());
}

void RealSession::setDiskFull(bool full) {
  if (full)
    disk_.bytes_left(0);
  else
    disk_.space_again();
}

void RealSession::find(const QString& fault) {
  using session::FaultKind;
  for (const auto kind : {FaultKind::converter_gone, FaultKind::touch_gone, FaultKind::stimulus_missed})
    if (fault == core::name(kind)) inputs_.push({bridge_.now_ns(), session::Fault{kind, "found by a test"}});
}

QList<QStringList> RealSession::table(const QString& file) const {
  const auto folder = folder_.filePath("export%1").arg(sessions_);
  store::export_data(database().toStdString(), folder.toStdString(), {});
  QFile csv(folder + "/" + protocol_ + "/" + file);
  QList<QStringList> rows;
  if (!csv.open(QIODevice::ReadOnly)) return rows;
  while (!csv.atEnd()) rows += QString(csv.readLine()).trimmed().split(',');
  return rows;
}

QString RealSession::column(const QString& name) const {
  const auto rows = table("trials.csv");
  QStringList values;
  for (int row = 1; row < rows.size(); ++row) values += rows[row].value(rows[0].indexOf(name));
  return values.join(' ');
}

QString RealSession::events(const QString& kind) const {
  const auto rows = table("events.csv");
  QStringList values;
  for (int row = 1; row < rows.size(); ++row)
    if (rows[row].contains(kind)) values += rows[row].value(rows[0].indexOf("value"));
  return values.join(' ');
}

}  // namespace turnpoint::ui
