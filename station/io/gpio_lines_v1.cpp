// Kernel lines by libgpiod 1 (Debian 12). For libgpiod 2, gpio_lines_v2.cpp is compiled instead.
#include <gpiod.h>

#include <cerrno>

#include "station/io/gpio_common.hpp"

namespace turnpoint::io {
namespace {

// number of edges that the kernel buffers for a line in version 1 of the character device interface
constexpr int kernel_buffer_edges = 16;

struct ChipCloser {
  void operator()(gpiod_chip* chip) const noexcept { gpiod_chip_close(chip); }
};
using Chip = std::unique_ptr<gpiod_chip, ChipCloser>;

struct Found {
  Chip chip;
  gpiod_line* line = nullptr;  ///< belongs to the chip, which frees it
};

// Finds a line by name and opens its chip. Never pass a null chip to the library, because it does not check.
Found find(const std::string& name) {
  Found found;
  int denied = 0;
  for (const std::string& path : chip_paths()) {
    Chip chip(gpiod_chip_open(path.c_str()));
    if (!chip) {
      if (errno == EACCES || errno == EPERM) denied = errno;
      continue;
    }
    gpiod_line* line = gpiod_chip_find_line(chip.get(), name.c_str());
    if (!line) continue;
    if (found.line) throw_line_error(EEXIST, name, "two lines have this name");
    found = {std::move(chip), line};
  }
  if (!found.line && denied)
    throw_line_error(denied, name, "no permission to open the GPIO chips (is the user in the group gpio?)");
  return found;
}

void request(const Found& found, const LineRequest& wanted) {
  const bool output = wanted.use == LineUse::output_low;
  const int result = output ? gpiod_line_request_output(found.line, wanted.consumer.c_str(), 0)
                            : gpiod_line_request_both_edges_events(found.line, wanted.consumer.c_str());
  if (result == 0) return;
  const int error = errno;
  const char* holder = gpiod_line_consumer(found.line);
  throw_line_error(
      error, wanted.name,
      error == EBUSY ? std::string("in use by ") + (holder ? holder : "another program") : "request");
}

class GpioLines final : public Lines {
 public:
  explicit GpioLines(const std::vector<LineRequest>& requests) : last_(requests.size()) {
    for (const LineRequest& wanted : requests) {
      Found found = find(wanted.name);
      if (!found.line) throw_line_error(ENOENT, wanted.name, "no GPIO chip has a line with this name");
      request(found, wanted);
      if (wanted.use == LineUse::input) {
        descriptors_.push_back({gpiod_line_event_get_fd(found.line), POLLIN, 0});
        inputs_.push_back(static_cast<int>(lines_.size()));
      }
      lines_.push_back(std::move(found));
    }
  }

  std::optional<Edge> wait(std::int64_t timeout_ns, int wake) override {
    auto ready = wait_readable(descriptors_, 0, -1);
    if (!ready) {  // no edge was waiting, so all buffers are empty
      for (Last& last : last_) last.waiting = 0;
      ready = wait_readable(descriptors_, timeout_ns, wake);
    }
    if (!ready) return std::nullopt;
    gpiod_line_event event{};
    if (gpiod_line_event_read_fd(descriptors_[*ready].fd, &event) != 0)
      throw std::system_error(errno, std::generic_category(), "gpio lines: reading an edge");
    const int line = inputs_[*ready];
    Last& last = last_[static_cast<std::size_t>(line)];
    const bool rising = event.event_type == GPIOD_LINE_EVENT_RISING_EDGE;
    // Version 1 of the interface does not number its edges. If the buffer was full, assume that later edges
    // were lost. Two edges in the same direction do not prove a loss: the reported direction is the level at
    // the time of the interrupt handler, so a short spike can also give two edges in the same direction.
    const bool lost = last.was_full;
    last.was_full = ++last.waiting >= kernel_buffer_edges;
    if (last.was_full) last.waiting = 0;
    last.sequence += lost ? 2 : 1;
    return Edge{std::int64_t{1'000'000'000} * event.ts.tv_sec + event.ts.tv_nsec, line, rising,
                last.sequence};
  }

  bool level(int index) override {
    const int value = gpiod_line_get_value(lines_.at(static_cast<std::size_t>(index)).line);
    if (value < 0) throw std::system_error(errno, std::generic_category(), "gpio lines: reading a level");
    return value != 0;
  }

  void drive(int index, int level) override {
    if (gpiod_line_set_value(lines_.at(static_cast<std::size_t>(index)).line, level) != 0)
      throw std::system_error(errno, std::generic_category(), "gpio lines: driving a line");
  }

  std::optional<bool> read_back(int index) override {
    const int value = gpiod_line_get_value(lines_.at(static_cast<std::size_t>(index)).line);
    if (value < 0 && errno == ENODEV)
      throw std::system_error(errno, std::generic_category(), "gpio lines: reading back a level");
    return value < 0 ? std::nullopt : std::optional(value != 0);
  }

 private:
  struct Last {
    std::uint32_t sequence = 0;
    int waiting = 0;  ///< number of edges read since the kernel's buffers were last empty
    bool was_full = false;
  };
  std::vector<Found> lines_;
  std::vector<pollfd> descriptors_;
  std::vector<int> inputs_;  ///< index of the line that each descriptor belongs to
  std::vector<Last> last_;
};

class GpioOutputs final : public Outputs {
 public:
  GpioOutputs(const std::vector<std::string>& names, const std::string& consumer) {
    Found first = find(names.front());
    if (!first.line) throw_line_error(ENOENT, names.front(), "no GPIO chip has a line with this name");
    chip_ = std::move(first.chip);
    gpiod_line_bulk_init(&lines_);
    for (const std::string& name : names) {
      gpiod_line* line = gpiod_chip_find_line(chip_.get(), name.c_str());
      if (!line)
        throw_line_error(ENOENT, name, "the chip of " + names.front() + " has no line with this name");
      gpiod_line_bulk_add(&lines_, line);
    }
    values_.resize(names.size());
    if (gpiod_line_request_bulk_output(&lines_, consumer.c_str(), values_.data()) != 0)
      throw_line_error(errno, names.front(), "cannot be requested together with the other lines");
  }

  void drive(std::uint32_t levels) override {
    for (std::size_t k = 0; k < values_.size(); ++k) values_[k] = static_cast<int>(levels >> k & 1);
    if (gpiod_line_set_value_bulk(&lines_, values_.data()) != 0)
      throw std::system_error(errno, std::generic_category(), "gpio lines: driving several lines");
  }

 private:
  Chip chip_;
  gpiod_line_bulk lines_{};
  std::vector<int> values_;
};

}  // namespace

std::unique_ptr<Outputs> open_gpio_outputs(const std::vector<std::string>& names,
                                           const std::string& consumer) {
  return std::make_unique<GpioOutputs>(names, consumer);
}

std::unique_ptr<Lines> open_gpio_lines(const std::vector<LineRequest>& requests) {
  return std::make_unique<GpioLines>(requests);
}

std::optional<LineState> find_line(const std::string& name) {
  const Found found = find(name);
  if (!found.line) return std::nullopt;
  LineState state{name, gpiod_chip_name(found.chip.get()), static_cast<int>(gpiod_line_offset(found.line)),
                  gpiod_line_is_used(found.line), ""};
  if (const char* consumer = gpiod_line_consumer(found.line)) state.consumer = consumer;
  return state;
}

std::vector<std::string> gpio_chips() {
  std::vector<std::string> open;
  for (const std::string& path : chip_paths())
    if (const Chip chip(gpiod_chip_open(path.c_str())); chip) open.push_back(path);
  return open;
}

}  // namespace turnpoint::io
