// turnpoint-ui: the commands of turnpoint, with the touchscreen for those that want one.
#include <QtQml/QQmlExtensionPlugin>
#include <iostream>

#include "station/cli/command.hpp"
#include "station/ui/station_window.hpp"

Q_IMPORT_QML_PLUGIN(TurnpointPlugin)

int main(int argc, char** argv) {
  return turnpoint::cli::run(argc, argv, std::cout, std::cerr, turnpoint::ui::run_on_screen);
}
