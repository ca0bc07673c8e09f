#include "station/store/annotate.hpp"

#include <fmt/format.h>

#include "station/store/open.hpp"
#include "station/store/read.hpp"
#include "station/store/seal.hpp"
#include "station/system/clocks.hpp"
#include "station/system/uuid.hpp"
#include "station/terms/usage_error.hpp"

namespace turnpoint::store {

void annotate(const std::string& path, const std::string& session_id, const std::string& text) {
  if (text.empty()) throw terms::UsageError("annotate: the note is empty");
  auto writer = open_writer(path, IfMissing::fail);
  const auto session = session_record(writer.database, session_id);
  SealedTransaction transaction(writer.database);
  Statement(writer.database, "INSERT INTO annotation VALUES (?,?,?,?)")
      .bind(system::new_uuid(), session.session_id, system::realtime_ns(), text)
      .run();
  transaction.commit();
}

void abandon(const std::string& path, const std::string& session_id, const std::string& reason) {
  auto writer = open_writer(path, IfMissing::fail);
  const auto session = session_record(writer.database, session_id);
  if (session.status != SessionStatus::interrupted)
    throw StoreError(
        ErrorKind::refused,
        fmt::format("database {}: session {} is {}; only an interrupted session can be abandoned", path,
                    session_id, name(session.status)));
  SealedTransaction transaction(writer.database);
  Statement(writer.database,
            "UPDATE session SET status = 'abandoned', status_reason = ? WHERE session_id = ?")
      .bind(reason, session_id)
      .run();
  transaction.commit();
}

}  // namespace turnpoint::store
