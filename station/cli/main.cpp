#include <iostream>

#include "station/cli/command.hpp"

int main(int argc, char** argv) { return turnpoint::cli::run(argc, argv, std::cout, std::cerr); }
