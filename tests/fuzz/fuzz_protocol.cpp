// Fuzz test of the reader of protocol files. Any bytes must either be accepted as a protocol or be refused
// with at least one problem. If they are accepted, the test calls every function that takes a protocol and
// needs no rig.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "station/protocol/combinations.hpp"
#include "station/protocol/protocol.hpp"
#include "station/protocol/survey.hpp"

using namespace turnpoint;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string source(reinterpret_cast<const char*>(data), size);
  try {
    const auto protocol = protocol::parse(source, "fuzz.toml");
    for (int index = 0; index < 3; ++index)
      if (protocol::block_order(protocol, index).empty()) std::abort();
    if (protocol::combinations_of(protocol).empty()) std::abort();
    protocol::advice(protocol);
  } catch (const core::BadInput& error) {
    if (error.problems().empty()) std::abort();
    for (const auto& problem : error.problems())
      if (problem.what.empty() || problem.place.file != "fuzz.toml") std::abort();
  }
  return 0;
}
