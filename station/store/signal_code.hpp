#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "station/store/names.hpp"

namespace turnpoint::store {

/// The only encoding of signals so far. Each value v becomes the whole number round(v / resolution) in 32
/// bits; a missing value (NaN) becomes -2^31. The numbers of a channel are replaced by their differences from
/// the number before (modulo 2^32), channel after channel. Of all these numbers, the lowest bytes come first,
/// then the second bytes, and so on. The result is compressed by zlib (RFC 1950). Slow signals then take
/// about a third of the space.
inline constexpr const char* kSignalEncoding = "int32 delta shuffle zlib";

/// Fills points, encoding and data of a signal from `values`: one list per channel, all of the same length.
/// Throws std::logic_error for lists of different lengths, and for a value that does not fit into 32 bits.
void encode(SignalRow& signal, std::span<const std::vector<double>> values);
/// The same for whole numbers, interleaved: the first point of all channels, then the second, and so on. The
/// resolution of the channels must be 1. A missing number is -2^31.
void encode(SignalRow& signal, std::span<const std::int32_t> numbers);

/// Returns the values that encode() received, rounded to the resolution of their channel: one list per
/// channel. Throws StoreError (corrupt) if the data do not have this encoding or these channels.
std::vector<std::vector<double>> decode(const SignalRow& signal);

}  // namespace turnpoint::store
