#include "tests/ui/real_session.hpp"

#include <QFile>
#include <chrono>

#include "station/app/prepare.hpp"
#include "station/store/export.hpp"

namespace turnpoint::ui {

RealSession::RealSession(QObject* parent)
    : QObject(parent),
      bridge_([] { return std::chrono::steady_clock::now().time_since_epoch().count(); },
              [this](session::Input input) { inputs_.push(std::move(input)); }) {}

RealSession::~RealSession() {
  session::Input input;
  input.time_ns = bridge_.now_ns();
  input.kind = session::InputKind::stop;
  inputs_.push(std::move(input));
}

void RealSession::start(const QString& protocol) {
  app::RunRequest request;
  request.protocol = TURNPOINT_SOURCE_DIR "/tests/ui/" + protocol.toStdString();
  request.rig = TURNPOINT_SOURCE_DIR "/deploy/rigs/simulated.toml";
  request.participant = "T1";
  request.database = database().toStdString();
  thread_ = std::jthread([this, request] {
    QString failure;
    try {
      session::run(app::prepare(request), &bridge_, inputs_);
    } catch (const std::exception& error) {
      failure = error.what();
    }
    QMetaObject::invokeMethod(this, [this, failure] {
      over_ = true;
      failure_ = failure;
      emit ended();
    });
  });
}

QString RealSession::column(const QString& name) const {
  store::export_data(database().toStdString(), folder_.filePath("export").toStdString(), {});
  QFile file(folder_.filePath("export/short/trials.csv"));
  if (!file.open(QIODevice::ReadOnly)) return {};
  const auto header = QString(file.readLine()).trimmed().split(',');
  const auto index = header.indexOf(name);
  QStringList values;
  while (!file.atEnd()) values += QString(file.readLine()).trimmed().split(',').value(index);
  return values.join(" ");
}

}  // namespace turnpoint::ui
