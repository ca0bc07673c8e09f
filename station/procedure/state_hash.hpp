#pragma once
#include <cstdint>

namespace turnpoint::procedure {

/// FNV-1a hash over 64-bit words. It is used to compare states; it does not protect against tampering.
class StateHash {
 public:
  void add(std::uint64_t word) {
    for (int byte = 0; byte < 8; ++byte) hash_ = (hash_ ^ ((word >> (8 * byte)) & 0xff)) * 0x100000001b3u;
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace turnpoint::procedure
