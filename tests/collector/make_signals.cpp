// make_signals FILE SESSIONS TRIALS: makes a database whose trials have signals of force cells.
#include <cstdlib>
#include <string>

#include "tests/store/sample.hpp"

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  for (int i = 0; i < std::atoi(argv[2]); ++i)
    sample::session(argv[1], std::atoi(argv[3]), sample::start("P" + std::to_string(i)));
}
