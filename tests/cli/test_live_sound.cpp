// Tests that a live session whose airborne sound may be too loud is refused without measured sound levels.
#include <fstream>
#include <sstream>

#include "station/cli/command.hpp"
#include "station/core/toml.hpp"
#include "station/session/prepare.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/quick_rig.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;

namespace {

const std::string root = TURNPOINT_SOURCE_DIR;

class Laboratory {
 public:
  Laboratory() {
    std::ofstream(folder_ / "rig.toml") << core::read_file(root + "/tests/support/thin_plate.toml");
    auto response = std::ofstream(folder_ / "response.csv");
    response << "frequency_Hz,displacement_um,phase_deg\n";
    for (int f = 20000; f <= 50000; f += 1000) response << f << ",4,0\n";
    std::ofstream(folder_ / "friction.csv")
        << "displacement_um,relative_friction\n0,1\n0.5,0.6\n1,0.4\n2,0.2\n4,0.15\n";
  }

  void calibrate(const std::string& sound) {
    std::vector<std::string> line{"turnpoint",    "calibrate",
                                  "--rig",        folder_ / "rig.toml",
                                  "--response",   "main=" + (folder_ / "response.csv"),
                                  "--full-scale", "0.1",
                                  "--friction",   folder_ / "friction.csv",
                                  "--out",        folder_ / "calibration.toml"};
    if (!sound.empty()) {
      std::ofstream(folder_ / "sound.csv") << "frequency_Hz,level_dB\n" << sound;
      line.insert(line.end(), {"--sound", folder_ / "sound.csv"});
    }
    std::vector<char*> arguments;
    for (auto& word : line) arguments.push_back(word.data());
    std::ostringstream out, err;
    const int status = cli::run(static_cast<int>(arguments.size()), arguments.data(), out, err);
    INFO(err.str());
    REQUIRE(status == 0);
  }

  /// Returns the reason why a live session of this protocol is refused; "" if it may begin.
  std::string refusal(const std::string& protocol) const {
    std::ofstream(folder_ / "p.toml") << protocol;
    session::RunRequest request;
    request.protocol = folder_ / "p.toml", request.rig = folder_ / "rig.toml";
    request.calibration = folder_ / "calibration.toml";
    request.participant = "P01", request.database = folder_ / "a.sqlite", request.mode = "live";
    try {
      static_cast<void>(session::prepare(request));
      return "";
    } catch (const core::BadInput& bad) {
      return bad.what();
    }
  }

 private:
  TemporaryFolder folder_;
};

std::string demo() { return core::read_file(root + "/protocols/demo.toml"); }

}  // namespace

TEST_CASE("a live session that may be too loud in air is refused without measured levels", "[cli]") {
  Laboratory laboratory;
  laboratory.calibrate("");
  const auto refusal = laboratory.refusal(demo());
  INFO(refusal);
  CHECK(refusal.find("airborne sound may reach") != std::string::npos);
  CHECK(refusal.find("at most 110 dB") != std::string::npos);
}

TEST_CASE("with measured levels around its tones it may begin", "[cli]") {
  Laboratory laboratory;
  laboratory.calibrate("20000,90\n50000,95\n");
  CHECK(laboratory.refusal(demo()) == "");
}

TEST_CASE("a level that was measured elsewhere does not count", "[cli]") {
  Laboratory laboratory;
  laboratory.calibrate("20000,90\n22500,90\n");
  CHECK(laboratory.refusal(demo()).find("airborne sound may reach") != std::string::npos);
}

TEST_CASE("a session whose bound is below the limit needs no measured level", "[cli]") {
  Laboratory laboratory;
  laboratory.calibrate("");
  CHECK(laboratory.refusal(replaced(demo(), "displacement_um = 1.0", "displacement_um = 0.3")) == "");
}
