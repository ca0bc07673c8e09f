#include <filesystem>
#include <fstream>

#include "station/session/places.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;

TEST_CASE("the screen's card is the first that has a connector", "[setup]") {
  const TemporaryFolder folder;
  const auto listed = [&folder](const char* name) { std::filesystem::create_directory(folder / name); };
  CHECK(session::screen_card(folder / "nowhere") == "");
  listed("card0");
  listed("renderD128");
  listed("version");
  CHECK(session::screen_card(folder / "") == "");  // these cards have no connector for a screen
  listed("card10");
  listed("card10-HDMI-A-1");
  CHECK(session::screen_card(folder / "") == "/dev/dri/card10");
  listed("card2");
  listed("card2-DSI-1");
  listed("card2-HDMI-A-2");
  CHECK(session::screen_card(folder / "") == "/dev/dri/card2");
  std::ofstream(folder / "card2-DSI-1/status") << "disconnected\n";
  std::ofstream(folder / "card10-HDMI-A-1/status") << "connected\n";
  // card10 is the only card with a connected screen
  CHECK(session::screen_card(folder / "") == "/dev/dri/card10");
}
