#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>

#include "station/core/problem.hpp"
#include "station/core/usage_error.hpp"
#include "station/maintenance/calibrate.hpp"
#include "station/rig/apply.hpp"
#include "station/scene/planner.hpp"
#include "station/session/prepare.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/number_from.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;

namespace {

using Rows = std::vector<std::vector<double>>;

/// One of the four tables of `turnpoint calibrate`: its columns, and rows that a good measurement gives.
struct Table {
  std::string columns;
  std::function<std::vector<double>(double share)> row;
  std::string rig::Measurements::*file;  ///< null for a sweep
};

const std::vector<Table> kinds{{"frequency_Hz,boundary_mm,sd_mm",
                                [](double s) {
                                  return std::vector{26000 + 10000 * s, 112 + 65 * s, 1.0};
                                },
                                &rig::Measurements::boundaries_csv},
                               {"displacement_um,relative_friction",
                                [](double s) {
                                  return std::vector{4 * s, 1 / (1 + 2 * s)};
                                },
                                &rig::Measurements::friction_csv},
                               {"frequency_Hz,level_dB",
                                [](double s) {
                                  return std::vector{20000 + 20000 * s, 60 - 9 * s};
                                },
                                &rig::Measurements::sound_csv},
                               {"frequency_Hz,displacement_um,phase_deg",
                                [](double s) {
                                  return std::vector{25000 + 12000 * s, 2 - s * s, -90 - 30 * s};
                                },
                                nullptr}};

class Tables {
 public:
  explicit Tables(std::uint64_t seed) : random_(seed) {}

  /// Returns the text of a table that is good, disturbed in one way, or hostile in its numbers or its
  /// letters.
  std::string text(const Table& kind) {
    const bool huge = below(400) == 0;
    const std::size_t count =
        huge ? 100'000 : std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 8, 12, 30}[below(10)];
    Rows rows;
    for (std::size_t i = 0; i < count; ++i)
      rows.push_back(kind.row(static_cast<double>(i) / std::max(1.0, static_cast<double>(count) - 1)));
    disturb(rows);
    const bool words = !huge && below(4) == 0;
    const std::string separator = std::vector<std::string>{",", ",", ";", "\t"}[below(4)];
    const std::string end = below(5) == 0 ? "\r\n" : below(40) == 0 ? "\r" : "\n";
    std::string all = below(15) == 0 ? "\xef\xbb\xbf" : "";
    for (const char c : header(kind.columns)) all += c == ',' ? separator : std::string(1, c);
    for (const auto& row : rows) {
      all += end;
      for (std::size_t k = 0; k < row.size(); ++k)
        all += (k > 0 ? separator : "") + (words && below(12) == 0 ? word() : fmt::format("{}", row[k]));
    }
    if (below(2) == 0) all += end;
    if (below(60) == 0) all.resize(below(all.size() + 1));
    if (below(60) == 0 && !all.empty()) all[below(all.size())] = static_cast<char>(below(256));
    return all;
  }
  std::size_t below(std::size_t n) { return random_() % n; }

 private:
  double normal() { return std::normal_distribution<double>()(random_); }
  double power(double from, double to) {
    return std::pow(10, std::uniform_real_distribution<double>(from, to)(random_));
  }
  std::string word() {
    static const std::vector<std::string> all{"nan",    "inf", "-inf", "1e300", "-1e300", "5e-324",
                                              "1e-320", "0",   "-0.0", "",      "x",      "1e999",
                                              "0x10",   "1,5", "-1",   "1e-12", "1e15"};
    return all[below(all.size())];
  }
  std::string header(const std::string& columns) {
    switch (below(60)) {
      case 0:
        return columns.substr(0, columns.rfind(','));
      case 1:
        return columns + ",x";
      case 2:
        return columns.substr(columns.find(',') + 1) + "," + columns.substr(0, columns.find(','));
      case 3:
        return "";
      default:
        return columns;
    }
  }
  void disturb(Rows& rows) {
    if (rows.empty()) return;
    const std::size_t column = below(rows[0].size());
    const auto each = [&](const std::function<void(std::vector<double>&)>& change) {
      for (auto& row : rows) change(row);
    };
    const auto good = rows;
    const double amount = std::vector<double>{1e3, -1e3, 1e9, 1e-3, 1e-300, 1e300, 1e-15, -1, 0}[below(9)];
    switch (below(12)) {
      case 0:
        return std::reverse(rows.begin(), rows.end());
      case 1:
        return each([&](auto& row) { row = good[0]; });
      case 2:
        return each([&](auto& row) { row = good[below(good.size())]; });
      case 3:
        return each([&](auto& row) { row[column] += amount; });
      case 4:
        return each([&](auto& row) { row[column] *= amount; });
      case 5:
        return each([&](auto& row) { row[column] *= power(-0.7, 0.7); });
      case 6:
        return each([&](auto& row) { row[column] = below(3) == 0 ? power(-12, 12) : row[column]; });
      case 7:
        return each([&](auto& row) { row[1] = good[0][1] + good.back()[1] - row[1]; });  // rises, not falls
      case 8:
        return each([&](auto& row) { row[1] *= 1 + 1e-15 * normal(); });
      case 9:
        return each([&](auto& row) { row.back() = power(-4, 4); });
      default:
        return each([&](auto& row) { row[1] *= 1 + 0.005 * normal(); });
    }
  }

  std::mt19937_64 random_;
};

/// What a command says about input that it refuses; "" if it does not refuse.
std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const core::UsageError& error) {
    return error.what();
  } catch (const core::BadInput& error) {
    return error.what();
  }
  return "";
}

}  // namespace

// TURNPOINT_TABLES: number of sets of tables, 60 by default. TURNPOINT_SEED: another seed than 1.
TEST_CASE("whatever was measured, calibrate refuses it or writes what plan, check and run can use",
          "[maintenance][calibration]") {
  const int sets = number_from("TURNPOINT_TABLES", 60);
  Tables tables(static_cast<std::uint64_t>(number_from("TURNPOINT_SEED", 1)));
  const TemporaryFolder folder;
  const std::string rig_path = TURNPOINT_SOURCE_DIR "/deploy/rigs/simulated.toml";
  const auto rig = rig::load(rig_path);
  int made = 0, prepared = 0;
  std::vector<int> alone(kinds.size());  // calibrations that were made from one table, by its kind
  for (int set = 0; set < sets; ++set) {
    rig::Measurements measured;
    std::string files;
    const bool both = tables.below(4) == 0;
    std::size_t last = 0;
    for (std::size_t k = 0; k < (both ? 2U : 1U); ++k) {
      const auto& kind = kinds[last = tables.below(kinds.size())];
      const auto path = folder / (std::to_string(&kind - kinds.data()) + ".csv");
      const auto text = tables.text(kind);
      std::ofstream(path, std::ios::binary) << text;
      files += text.substr(0, 2000) + "\n\n";
      if (kind.file != nullptr)
        measured.*kind.file = path;
      else if (measured.sweeps.empty())
        measured.sweeps.push_back({rig.transducers.front().name, path, 1});
    }
    CAPTURE(set, files);
    const auto path = folder / "made.toml";
    const auto refused = refusal([&] {
      const auto calibration = maintenance::calibrate(rig, measured, 90, "");
      static_cast<void>(maintenance::calibration_figure(calibration, measured));
      maintenance::write_calibration(calibration, rig, path);
    });
    if (!refused.empty()) continue;
    ++made;
    if (!both) ++alone[last];
    std::ostringstream messages;
    const auto used = session::calibrated_rig(rig_path, path, messages);
    CHECK(messages.str().find(path) != std::string::npos);
    scene::Planner planner(used);
    scene::Scene scene;
    scene.boundary_m = 0.15, scene.displacement_m = 1e-6;
    const auto unreachable = refusal([&] { static_cast<void>(planner.plan(scene)); });
    CHECK(unreachable.find(path) == std::string::npos);
    if (made % 8 != 1) continue;
    ++prepared;
    session::RunRequest request;
    request.protocol = TURNPOINT_SOURCE_DIR "/protocols/demo.toml", request.rig = rig_path;
    request.participant = "P01", request.observer = "sim", request.calibration = path;
    CHECK(refusal([&] { static_cast<void>(session::prepare(request)); }).find(path) == std::string::npos);
  }
  WARN(made << " of " << sets << " sets of tables made a calibration, " << prepared
            << " of them were prepared for a session");
  CHECK(made > sets / 10);
  CHECK(made < sets);
  CHECK(prepared > 0);
  for (const int of_kind : alone) CHECK(of_kind > 0);
}
