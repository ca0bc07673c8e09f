#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace turnpoint::core {

/// Computes the SHA-256 (FIPS 180-4) of data that arrive in pieces. For data in one piece, use sha256() in
/// number.hpp.
class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  /// Returns the hash in lower-case hexadecimal. Do not call add() afterwards.
  std::string hex();

 private:
  std::array<std::uint32_t, 8> state_;
  std::string rest_;  ///< bytes that do not yet fill a block
  std::uint64_t size_ = 0;
};

}  // namespace turnpoint::core
