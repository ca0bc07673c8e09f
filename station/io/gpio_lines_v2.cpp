// Kernel lines by libgpiod 2 (Debian 13). For libgpiod 1, gpio_lines_v1.cpp is compiled instead.
#include <gpiod.h>

#include <cerrno>

#include "station/io/gpio_common.hpp"

namespace turnpoint::io {
namespace {

template <typename T, void (*free_it)(T*)>
struct Freer {
  void operator()(T* object) const noexcept { free_it(object); }
};
template <typename T, void (*free_it)(T*)>
using Handle = std::unique_ptr<T, Freer<T, free_it>>;
using Chip = Handle<gpiod_chip, gpiod_chip_close>;
using ChipInfo = Handle<gpiod_chip_info, gpiod_chip_info_free>;
using LineInfo = Handle<gpiod_line_info, gpiod_line_info_free>;
using Request = Handle<gpiod_line_request, gpiod_line_request_release>;
using Settings = Handle<gpiod_line_settings, gpiod_line_settings_free>;
using LineConfig = Handle<gpiod_line_config, gpiod_line_config_free>;
using RequestConfig = Handle<gpiod_request_config, gpiod_request_config_free>;
using Buffer = Handle<gpiod_edge_event_buffer, gpiod_edge_event_buffer_free>;

struct Found {
  Chip chip;
  unsigned offset = 0;
};

// Never pass a null chip to the library, because it does not check.
Found find(const std::string& name) {
  Found found;
  int denied = 0;
  for (const std::string& path : chip_paths()) {
    Chip chip(gpiod_chip_open(path.c_str()));
    if (!chip) {
      if (errno == EACCES || errno == EPERM) denied = errno;
      continue;
    }
    const int offset = gpiod_chip_get_line_offset_from_name(chip.get(), name.c_str());
    if (offset < 0) continue;
    if (found.chip) throw_line_error(EEXIST, name, "two lines have this name");
    found = {std::move(chip), static_cast<unsigned>(offset)};
  }
  if (!found.chip && denied)
    throw_line_error(denied, name, "no permission to open the GPIO chips (is the user in the group gpio?)");
  return found;
}

std::string holder_of(const Found& found) {
  const LineInfo info(gpiod_chip_get_line_info(found.chip.get(), found.offset));
  const char* consumer = info ? gpiod_line_info_get_consumer(info.get()) : nullptr;
  return consumer ? consumer : "another program";
}

template <typename T>
T made(T handle, const std::string& name) {
  if (!handle) throw_line_error(ENOMEM, name, "request");
  return handle;
}

Request request(const Found& found, const LineRequest& wanted) {
  const auto settings = made(Settings(gpiod_line_settings_new()), wanted.name);
  const auto lines = made(LineConfig(gpiod_line_config_new()), wanted.name);
  const auto config = made(RequestConfig(gpiod_request_config_new()), wanted.name);
  if (wanted.use == LineUse::output_low) {
    gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_OUTPUT);
    gpiod_line_settings_set_output_value(settings.get(), GPIOD_LINE_VALUE_INACTIVE);
  } else {
    gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_INPUT);
    gpiod_line_settings_set_edge_detection(settings.get(), GPIOD_LINE_EDGE_BOTH);
    gpiod_line_settings_set_event_clock(settings.get(), GPIOD_LINE_CLOCK_MONOTONIC);
  }
  gpiod_request_config_set_consumer(config.get(), wanted.consumer.c_str());
  if (gpiod_line_config_add_line_settings(lines.get(), &found.offset, 1, settings.get()) != 0)
    throw_line_error(errno, wanted.name, "request");
  Request held(gpiod_chip_request_lines(found.chip.get(), config.get(), lines.get()));
  if (!held) {
    const int error = errno;
    throw_line_error(error, wanted.name, error == EBUSY ? "in use by " + holder_of(found) : "request");
  }
  return held;
}

class GpioLines final : public Lines {
 public:
  explicit GpioLines(const std::vector<LineRequest>& requests) : buffer_(gpiod_edge_event_buffer_new(1)) {
    if (!buffer_)
      throw std::system_error(ENOMEM, std::generic_category(), "gpio lines: allocating an event buffer");
    for (const LineRequest& wanted : requests) {
      const Found found = find(wanted.name);
      if (!found.chip) throw_line_error(ENOENT, wanted.name, "no GPIO chip has a line with this name");
      Request held = request(found, wanted);
      if (wanted.use == LineUse::input) {
        descriptors_.push_back({gpiod_line_request_get_fd(held.get()), POLLIN, 0});
        inputs_.push_back(static_cast<int>(lines_.size()));
      }
      lines_.push_back({std::move(held), found.offset});
    }
  }

  std::optional<Edge> wait(std::int64_t timeout_ns, int wake) override {
    const auto ready = wait_readable(descriptors_, timeout_ns, wake);
    if (!ready) return std::nullopt;
    const int line = inputs_[*ready];
    gpiod_line_request* held = lines_[static_cast<std::size_t>(line)].request.get();
    if (gpiod_line_request_read_edge_events(held, buffer_.get(), 1) != 1)
      throw std::system_error(errno, std::generic_category(), "gpio lines: reading an edge");
    gpiod_edge_event* event = gpiod_edge_event_buffer_get_event(buffer_.get(), 0);
    return Edge{static_cast<std::int64_t>(gpiod_edge_event_get_timestamp_ns(event)), line,
                gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE,
                static_cast<std::uint32_t>(gpiod_edge_event_get_line_seqno(event))};
  }

  bool level(int index) override {
    const Held& held = lines_.at(static_cast<std::size_t>(index));
    const gpiod_line_value value = gpiod_line_request_get_value(held.request.get(), held.offset);
    if (value == GPIOD_LINE_VALUE_ERROR)
      throw std::system_error(errno, std::generic_category(), "gpio lines: reading a level");
    return value == GPIOD_LINE_VALUE_ACTIVE;
  }

  void drive(int index, int level) override {
    const Held& held = lines_.at(static_cast<std::size_t>(index));
    const auto value = level != 0 ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
    if (gpiod_line_request_set_value(held.request.get(), held.offset, value) != 0)
      throw std::system_error(errno, std::generic_category(), "gpio lines: driving a line");
  }

  std::optional<bool> read_back(int index) override {
    const Held& held = lines_.at(static_cast<std::size_t>(index));
    const gpiod_line_value value = gpiod_line_request_get_value(held.request.get(), held.offset);
    if (value == GPIOD_LINE_VALUE_ERROR && errno == ENODEV)
      throw std::system_error(errno, std::generic_category(), "gpio lines: reading back a level");
    return value == GPIOD_LINE_VALUE_ERROR ? std::nullopt : std::optional(value == GPIOD_LINE_VALUE_ACTIVE);
  }

 private:
  struct Held {
    Request request;
    unsigned offset;
  };
  Buffer buffer_;
  std::vector<Held> lines_;
  std::vector<pollfd> descriptors_;
  std::vector<int> inputs_;  ///< index of the line that each descriptor belongs to
};

class GpioOutputs final : public Outputs {
 public:
  GpioOutputs(const std::vector<std::string>& names, const std::string& consumer) {
    const Found first = find(names.front());
    if (!first.chip) throw_line_error(ENOENT, names.front(), "no GPIO chip has a line with this name");
    const auto settings = made(Settings(gpiod_line_settings_new()), names.front());
    const auto lines = made(LineConfig(gpiod_line_config_new()), names.front());
    const auto config = made(RequestConfig(gpiod_request_config_new()), names.front());
    gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_OUTPUT);
    gpiod_line_settings_set_output_value(settings.get(), GPIOD_LINE_VALUE_INACTIVE);
    gpiod_request_config_set_consumer(config.get(), consumer.c_str());
    std::vector<unsigned> offsets;
    for (const std::string& name : names) {
      const int offset = gpiod_chip_get_line_offset_from_name(first.chip.get(), name.c_str());
      if (offset < 0)
        throw_line_error(ENOENT, name, "the chip of " + names.front() + " has no line with this name");
      offsets.push_back(static_cast<unsigned>(offset));
    }
    if (gpiod_line_config_add_line_settings(lines.get(), offsets.data(), offsets.size(), settings.get()) != 0)
      throw_line_error(errno, names.front(), "request");
    request_ = Request(gpiod_chip_request_lines(first.chip.get(), config.get(), lines.get()));
    if (!request_)
      throw_line_error(errno, names.front(), "cannot be requested together with the other lines");
    values_.resize(names.size());
  }

  void drive(std::uint32_t levels) override {
    for (std::size_t k = 0; k < values_.size(); ++k)
      values_[k] = (levels >> k & 1) != 0 ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
    if (gpiod_line_request_set_values(request_.get(), values_.data()) != 0)
      throw std::system_error(errno, std::generic_category(), "gpio lines: driving several lines");
  }

 private:
  Request request_;
  std::vector<gpiod_line_value> values_;
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
  if (!found.chip) return std::nullopt;
  const ChipInfo chip(gpiod_chip_get_info(found.chip.get()));
  const LineInfo line(gpiod_chip_get_line_info(found.chip.get(), found.offset));
  if (!chip || !line) throw_line_error(errno, name, "reading the state of the line");
  LineState state{name, gpiod_chip_info_get_name(chip.get()), static_cast<int>(found.offset),
                  gpiod_line_info_is_used(line.get()), ""};
  if (const char* consumer = gpiod_line_info_get_consumer(line.get())) state.consumer = consumer;
  return state;
}

std::vector<std::string> gpio_chips() {
  std::vector<std::string> open;
  for (const std::string& path : chip_paths())
    if (const Chip chip(gpiod_chip_open(path.c_str())); chip) open.push_back(path);
  return open;
}

}  // namespace turnpoint::io
