// turnpoint-ui: the commands of turnpoint, with the touchscreen for those that need it. Without a command it
// shows the operator's start page.
#include <QtQml/QQmlExtensionPlugin>
#include <iostream>

#include "station/cli/command.hpp"
#include "station/cli/screens.hpp"
#include "station/ui/platform/screens.hpp"

Q_IMPORT_QML_PLUGIN(TurnpointPlugin)

int main(int argc, char** argv) {
  using namespace turnpoint;
  const cli::Screens screens{ui::run_on_screen, ui::run_station, ui::show_preview, ui::show_design,
                             ui::measure_latency};
  char station[] = "station";
  char* start_page[] = {argv[0], station, nullptr};
  const bool alone = argc <= 1;
  return cli::run(alone ? 2 : argc, alone ? start_page : argv, std::cout, std::cerr, &screens);
}
