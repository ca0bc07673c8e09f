#include <fmt/format.h>

#include <limits>
#include <utility>

#include "station/session/rows.hpp"
#include "station/session/session_run.hpp"
#include "station/terms/usage_error.hpp"

namespace turnpoint::session {

// The part of SessionRun for blocks in which the finger strokes the surface and nothing is asked.

namespace {

std::string in_words(const sensing::FrictionTable& table, bool used) {
  std::string text = used ? "used" : "not used";
  if (table.half_displacement_m)
    text += fmt::format("; half friction at {:.3f} um (SE {:.3f})", 1e6 * *table.half_displacement_m,
                        1e6 * table.half_displacement_sd_m);
  if (table.unused > 0) text += fmt::format("; {} trials do not count", table.unused);
  return text;
}

}  // namespace

bool SessionRun::is_training() const { return director_.block()->kind == protocol::BlockKind::training; }

/// Ends a trial in which nothing is asked, once it is known how the finger moved. The trial is void if the
/// forces are unknown.
void SessionRun::judge_strokes(const Input& input, Running& trial) {
  const bool known = input.forces->state == sensing::ForcesState::ok;
  const int movement = input.forces->movement == sensing::Movement::ok ? 0 : 1;
  if (known) trial.row.response_time_quality = name(input.quality);
  perform(trial.machine.handle({input.time_ns, known ? trial::EventKind::answer : trial::EventKind::refuted,
                                known ? movement : 0}),
          trial);
}

/// Computes the friction table from the trials of a block. Throws terms::UsageError if a level has too few
/// valid trials.
sensing::FrictionTable SessionRun::measured_friction(int block_index) const {
  std::vector<sensing::TableStroke> strokes;
  for (const auto& stroke : director_.strokes(block_index))
    strokes.push_back(
        {1e-6 * stroke.displacement_um, stroke.friction.value_or(std::numeric_limits<double>::quiet_NaN())});
  return sensing::friction_table(strokes, summary_.seed);
}

/// Computes and stores the friction table of the block that has just ended.
Flow SessionRun::finish_friction_table() {
  const auto& block = *director_.block();
  sensing::FrictionTable table;
  try {
    table = measured_friction(director_.block_index());
  } catch (const terms::UsageError& error) {
    gate_.stop(fmt::format("block \"{}\": {}; \"turnpoint resume --policy block\" repeats the block",
                           block.name, error.what()));
    return Flow::stop;
  }
  records::EventRow event{stage_->now_ns(), "friction_table", in_words(table, block.strokes.used),
                          std::nullopt};
  for (const auto& level : table.levels)
    event.friction_levels.push_back({1e6 * level.displacement_m, level.strokes, level.measured,
                                     level.relative_friction, level.sd, level.interval.low,
                                     level.interval.high});
  gate_.keep([&] { log_.event(event); });
  if (table.half_displacement_m)
    summary_.estimates.push_back({block.name, "half friction at (um)", 1e6 * *table.half_displacement_m,
                                  1e6 * table.half_displacement_sd_m, ""});
  if (block.strokes.used) plans_.use_friction(table);
  return Flow::go_on;
}

/// In a resumed session, plans trials with the newest friction table of an earlier block, as the session did
/// before it was interrupted.
void SessionRun::use_measured_friction() {
  for (int i = director_.block_index() - 1; i >= 0; --i) {
    const auto& block = director_.all_blocks()[static_cast<std::size_t>(i)];
    if (block.kind != protocol::BlockKind::friction_table || !block.strokes.used) continue;
    return plans_.use_friction(measured_friction(i));
  }
}

}  // namespace turnpoint::session
