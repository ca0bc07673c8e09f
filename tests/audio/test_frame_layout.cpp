#include "station/audio/alsa_device.hpp"

#include <vector>

#include "tests/support/catch.hpp"

using namespace turnpoint::audio;

namespace {

std::vector<unsigned char> packed(const std::vector<std::int32_t>& samples, int channels,
                                  const FrameLayout& layout) {
  const auto frames = samples.size() / static_cast<std::size_t>(channels);
  std::vector<unsigned char> out(frames * layout.bytes() + 1, 0xee);
  pack(samples, channels, layout, out);
  CHECK(out.back() == 0xee);  // bytes behind the last frame are not written
  out.pop_back();
  return out;
}

using Bytes = std::vector<unsigned char>;

}  // namespace

TEST_CASE("32-bit samples are written low byte first", "[drive][layout]") {
  CHECK(packed({0x01020304, -2}, 2, {SampleFormat::s32_le, 2}) ==
        Bytes{0x04, 0x03, 0x02, 0x01, 0xfe, 0xff, 0xff, 0xff});
}

TEST_CASE("24-bit samples are written as the upper three bytes, including the sign", "[drive][layout]") {
  CHECK(packed({0x01020300, -256, 0x7fffff00, INT32_MIN}, 2, {SampleFormat::s24_3le, 2}) ==
        Bytes{0x03, 0x02, 0x01, 0xff, 0xff, 0xff, 0xff, 0xff, 0x7f, 0x00, 0x00, 0x80});
}

TEST_CASE("device channels that the stream does not have are filled with zeros", "[drive][layout]") {
  CHECK(packed({0x01020300, 0x0a0b0c00}, 1, {SampleFormat::s24_3le, 3}) ==
        Bytes{3, 2, 1, 0, 0, 0, 0, 0, 0, 0x0c, 0x0b, 0x0a, 0, 0, 0, 0, 0, 0});
  CHECK(packed({1, 2}, 2, {SampleFormat::s32_le, 4}) ==
        Bytes{1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
}
