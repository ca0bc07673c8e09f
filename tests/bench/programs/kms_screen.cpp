// kms_screen [X Y]: reads what the screen shows now from the buffer that the graphics card scans out,
// whichever program drew it. With X Y it prints the colour there as bbggrr in hexadecimal. Without
// X Y it prints "WIDTH HEIGHT", a new line, and all pixels, 4 bytes each (blue, green, red, unused), row by
// row. It must run as root, because only root may read the buffer.
#include <drm.h>
#include <drm_mode.h>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

/// Returns the buffer of this card's first active output; its id is 0 if the card shows nothing.
drm_mode_fb_cmd shown_by(int card) {
  std::array<std::uint32_t, 16> outputs{};
  drm_mode_card_res resources{};
  resources.crtc_id_ptr = reinterpret_cast<std::uint64_t>(outputs.data());
  resources.count_crtcs = outputs.size();
  drm_mode_fb_cmd buffer{};
  if (::ioctl(card, DRM_IOCTL_MODE_GETRESOURCES, &resources) < 0) return buffer;
  for (std::uint32_t k = 0; k < resources.count_crtcs && k < outputs.size(); ++k) {
    drm_mode_crtc output{};
    output.crtc_id = outputs[k];
    if (::ioctl(card, DRM_IOCTL_MODE_GETCRTC, &output) < 0 || output.fb_id == 0) continue;
    buffer.fb_id = output.fb_id;
    if (::ioctl(card, DRM_IOCTL_MODE_GETFB, &buffer) == 0 && buffer.handle != 0) return buffer;
  }
  return {};
}

const unsigned char* pixels_of(int card, const drm_mode_fb_cmd& buffer) {
  drm_mode_map_dumb map{};
  map.handle = buffer.handle;
  if (::ioctl(card, DRM_IOCTL_MODE_MAP_DUMB, &map) < 0) return nullptr;
  void* at = ::mmap(nullptr, std::size_t{buffer.pitch} * buffer.height, PROT_READ, MAP_SHARED, card,
                    static_cast<off_t>(map.offset));
  return at == MAP_FAILED ? nullptr : static_cast<const unsigned char*>(at);
}

void print(const drm_mode_fb_cmd& buffer, const unsigned char* pixels, int argc, char** argv) {
  if (argc == 3) {
    const auto x = static_cast<std::size_t>(std::atoi(argv[1]));
    const auto y = static_cast<std::size_t>(std::atoi(argv[2]));
    const unsigned char* at = pixels + y * buffer.pitch + x * 4;
    std::printf("%02x%02x%02x\n", at[0], at[1], at[2]);
    return;
  }
  std::printf("%u %u\n", buffer.width, buffer.height);
  for (std::uint32_t y = 0; y < buffer.height; ++y)
    std::fwrite(pixels + std::size_t{y} * buffer.pitch, 4, buffer.width, stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 1 && argc != 3) return std::fprintf(stderr, "kms_screen [X Y]\n"), 2;
  for (int number = 0; number < 8; ++number) {
    const int card = ::open(("/dev/dri/card" + std::to_string(number)).c_str(), O_RDWR | O_CLOEXEC);
    if (card < 0) continue;
    const auto buffer = shown_by(card);
    if (buffer.handle != 0 && buffer.bpp == 32)
      if (const auto* pixels = pixels_of(card, buffer)) return print(buffer, pixels, argc, argv), 0;
    ::close(card);
  }
  return std::fprintf(stderr, "kms_screen: no card shows a picture\n"), 1;
}
