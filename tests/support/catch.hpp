#pragma once
// The headers and one of the matchers have different names in Catch2 2.13 (Debian 12) and 3 (Debian 13). The
// tests use the names of Catch2 3.
#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;
#else
#include <catch2/catch.hpp>
namespace Catch::Matchers {
inline auto ContainsSubstring(const std::string& part) { return Contains(part); }
}  // namespace Catch::Matchers
#pragma GCC poison Contains  // which is another matcher in Catch2 3
#endif
