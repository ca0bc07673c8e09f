#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace turnpoint::text {

/// SHA-256 (FIPS 180-4) of bytes that come piece by piece; sha256() in number.hpp takes them all at once.
class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  /// Lower-case hexadecimal; nothing may be added afterwards.
  std::string hex();

 private:
  std::array<std::uint32_t, 8> state_;
  std::string rest_;  ///< bytes that do not fill a block yet
  std::uint64_t size_ = 0;
};

}  // namespace turnpoint::text
