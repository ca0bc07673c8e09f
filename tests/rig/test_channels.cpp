#include "tests/rig/rig_sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace rig_sample;

TEST_CASE("spare channels carry a marker and masking noise", "[rig]") {
  const std::string both =
      "[marker]\nchannel = 1\nkind = \"tone\"\nfrequency_Hz = 5000\nduration_ms = 2\n"
      "[noise]\nchannel = 3\nrms = 0.05\nsignal = { frequency_Hz = 1000, amplitude = 0.2 }\n\n[limits]";
  const auto rig = rig::parse(replaced(source(), "[limits]", both), "r.toml");
  REQUIRE(rig.marker);
  CHECK(rig.marker->kind == rig::Marker::Kind::tone);
  CHECK(rig.marker->duration_s == Approx(2e-3));
  REQUIRE(rig.noise);
  CHECK(rig.noise->high_Hz == 8000);
  REQUIRE(rig.noise->signal);
  CHECK(rig.noise->signal->frequency_Hz == 1000);
  CHECK(rig.noise->signal->amplitude == 0.2);
  CHECK(rig::channels(rig) == 4);
  CHECK(rig::channels(rig::load(simulated)) == 2);
}

TEST_CASE("a rig names the captured channels of its pick-ups", "[rig]") {
  const auto with = [](const std::string& keys) {
    return problems("[limits]", "[capture]\n" + keys + "\n[limits]");
  };
  const auto rig = rig::parse(
      replaced(source(), "[limits]", "[capture]\nuri = \"sim:\"\nchannels = 4\npickups = [3, 1]\n[limits]"),
      "r.toml");
  REQUIRE(rig.capture);
  CHECK(rig.capture->channels == 4);
  CHECK(rig.capture->pick_ups == std::vector<int>{3, 1});
  CHECK_FALSE(rig::load(simulated).capture);
  CHECK(
      contains(with("uri = \"sim:\"\nchannels = 2\npickups = [2]"),
               "channel 2 is not a captured channel of its own; write different whole numbers from 0 to 1"));
  CHECK(contains(with("uri = \"sim:\"\nchannels = 2\npickups = [1, 1]"), "channel 1"));
  CHECK(contains(with("uri = \"sim:\"\nchannels = 2\npickups = [0.5]"), "channel 0.5"));
  CHECK(contains(with("uri = \"usb:\"\nchannels = 2\npickups = [0]"), "allowed: \"sim:\" or \"alsa:NAME\""));
  CHECK(contains(with("uri = \"sim:\"\nchannels = 2"), "\"pickups\""));
}

TEST_CASE("a capture on a card needs a loop: an output channel of its own, wired to a captured one",
          "[rig]") {
  const std::string card = "[capture]\nuri = \"alsa:hw:1\"\nchannels = 4\npickups = [1, 2]\n";
  const auto with = [&](const std::string& keys) {
    return problems("[limits]", "[marker]\nchannel = 1\nkind = \"pulse\"\n" + card + keys + "\n[limits]");
  };
  const auto rig = rig::parse(
      replaced(source(), "[limits]", card + "reference = 3\nexcitation_channel = 4\n[limits]"), "r.toml");
  REQUIRE(rig.capture);
  CHECK(rig.capture->uri == "alsa:hw:1");
  CHECK(rig.capture->reference == 3);
  CHECK(rig.capture->excitation_channel == 4);
  CHECK(rig::channels(rig) == 5);
  const auto cells =
      rig::parse(replaced(source(), "[limits]",
                          "[capture]\nuri = \"alsa:hw:1\"\nchannels = 6\npickups = [1, 2]\nreference = 0\n"
                          "excitation_channel = 4\nbridges = [3, 4, 5]\n[limits]"),
                 "r.toml");
  CHECK(cells.capture.value().bridges == std::vector<int>{3, 4, 5});
  CHECK(contains(with(""), "\"reference\""));
  CHECK(contains(with(""), "\"excitation_channel\""));
  CHECK(contains(with("reference = 4\nexcitation_channel = 2"),
                 "channel 4 is not captured; a whole number from 0 to 3"));
  CHECK(contains(with("reference = 1\nexcitation_channel = 2"), "channel 1 is also in \"pickups\""));
  CHECK(contains(with("reference = 0\nexcitation_channel = 0"), "channel 0 drives"));
  CHECK(contains(with("reference = 0\nexcitation_channel = 1"), "channel 1 is used by the marker"));
  CHECK(contains(with("reference = 0\nexcitation_channel = 9"), "0 to 7"));
  CHECK(contains(problems("[limits]",
                          "[capture]\nuri = \"sim:\"\nchannels = 2\npickups = [0]\n"
                          "reference = 1\n[limits]"),
                 "\"reference\""));
}

TEST_CASE("force cells may be on a converter with a clock of its own, beside a capture on the card",
          "[rig]") {
  const std::string card =
      "[capture]\nuri = \"alsa:hw:1\"\nchannels = 4\npickups = [1, 2]\nreference = 0\nexcitation_channel = "
      "4\n";
  const std::string
      head = "[force_cells]\nuri = \"iio:ad7124-4\"\n",
      cells = "a = \"voltage0-voltage1\"\nb = \"voltage2-voltage3\"\nlateral = \"voltage4-voltage5\"\n";
  const auto rig = rig::parse(
      replaced(source(), "[limits]",
               card + head + cells + "rate_Hz = 500\nsampling_frequency = 9600\ndelay_ms = 3\n[limits]"),
      "r.toml");
  REQUIRE(rig.capture.value().converter);
  const auto& converter = *rig.capture->converter;
  CHECK(converter.uri == "iio:ad7124-4");
  CHECK(converter.channels ==
        std::array<std::string, 3>{"voltage0-voltage1", "voltage2-voltage3", "voltage4-voltage5"});
  CHECK(converter.rate_Hz == 500);
  CHECK(converter.sampling_frequency.value() == 9600);
  CHECK(converter.trigger.empty());
  CHECK(converter.delay_s == Approx(0.003));
  CHECK(rig::has_force_cells(rig));
  const auto with = [&](const std::string& text) { return problems("[limits]", text + "\n[limits]"); };
  const auto rate = std::string("rate_Hz = 500\n");
  CHECK(with(card + head + cells + rate).empty());
  CHECK(contains(with(head + cells + rate), "add [capture] with uri = \"alsa:NAME\""));
  CHECK(contains(with("[capture]\nuri = \"sim:\"\nchannels = 2\npickups = [0]\n" + head + cells + rate),
                 "add [capture] with uri = \"alsa:NAME\""));
  CHECK(contains(with("[capture]\nuri = \"alsa:hw:1\"\nchannels = 6\npickups = [1, 2]\nreference = 0\n"
                      "excitation_channel = 4\nbridges = [3, 4, 5]\n" +
                      head + cells + rate),
                 "leave out \"bridges\" or [force_cells]"));
  CHECK(contains(with(card + "[force_cells]\nuri = \"gpio:line=X\"\n" + cells + rate), "\"iio:DEVICE\""));
  CHECK(contains(with(card + head + rate), "\"lateral\""));
  CHECK(contains(with(card + head + cells), "\"rate_Hz\""));
  CHECK(contains(with(card + head + cells + "rate_Hz = 4800\n"), "80"));
  CHECK(contains(with(card + head + cells + rate + "trigger = \"a b\"\n"), "\"trigger\" is \"a b\"; allowed: a name without spaces"));
  CHECK(contains(with(card + head + "a = \"x\"\nb = \"x\"\nlateral = \"z\"\n" + rate),
                 "channel \"x\" is also that of \"a\""));
}

TEST_CASE("a rig gives out trigger codes on the marker channel and on lines, and takes pulses", "[rig]") {
  const std::string marker = "[marker]\nchannel = 1\nkind = \"code\"\n",
                    capture = "[capture]\nuri = \"sim:\"\nchannels = 4\npickups = [0]\n",
                    lines = "[trigger_lines]\nuri = \"gpio:bit0=A,bit1=B,bit2=C,strobe=D,pulse_ms=2\"\n",
                    sync = "[sync]\nuri = \"capture:\"\nchannel = 3\n";
  const auto parsed = [](const std::string& more) {
    return rig::parse(replaced(source(), "[limits]", more + "[limits]"), "r.toml");
  };
  const auto with = [](const std::string& more) { return problems("[limits]", more + "\n[limits]"); };
  const auto rig = parsed(marker + capture + "marker_channel = 2\n" + lines + sync);
  CHECK(rig.marker->kind == rig::Marker::Kind::code);
  CHECK(rig.marker->duration_s == Approx(1e-3));
  CHECK(rig.capture->marker_channel == 2);
  CHECK(rig.sync->channel == 3);
  CHECK(rig::largest_trigger_code(rig) == 7);
  CHECK(rig::largest_trigger_code(parsed(marker)) == 255);
  CHECK(rig::largest_trigger_code(parsed("[trigger_lines]\nuri = \"sim:\"\n")) == 255);
  CHECK(rig::largest_trigger_code(rig::load(simulated)) == 0);
  CHECK(contains(with(marker + "duration_ms = 30"), "from 0.2 to 20 ms"));
  CHECK(contains(with(marker + "amplitude = 0.5"), "0.49"));
  CHECK(contains(with(capture + "marker_channel = 2"), "the rig has no marker with codes"));
  CHECK(contains(with(marker + capture + "marker_channel = 0"),
                 "channel 0 is also captured for something else"));
  CHECK(contains(with(marker + capture + "marker_channel = 4"), "channel 4 is not captured"));
  CHECK(contains(with(sync), "the rig captures nothing"));
  CHECK(contains(with("[sync]\nuri = \"gpio:in=A\"\n"), "does not name a line"));
  CHECK(contains(with("[trigger_lines]\nuri = \"gpio:bit1=A\"\n"), "has no line \"bit0\""));
}

TEST_CASE("a thermometer is of one of two subsystems of the kernel", "[rig]") {
  const auto with = [](const std::string& plate) {
    return problems("[limits]", "[temperature]\nplate = \"" + plate +
                                    "\"\nframe = \"hwmon:lm75@1-0049/temp1\"\n[limits]");
  };
  for (const char* good :
       {"hwmon:lm75/temp1", "iio:tmp117/temp", "iio:tmp117@1-0048/temp", "iio:mlx90614/temp_object"})
    CHECK(with(good).empty());
  for (const char* bad :
       {"hwmon:lm75/temp", "hwmon:lm75", "iio:tmp117", "iio:tmp117/in_temp", "iio:/temp", "lm75/temp1"})
    CHECK(contains(with(bad), "NAME@DEVICE if several have that name"));
}

TEST_CASE("a device may have more channels than the rig uses, not fewer", "[rig]") {
  CHECK(rig::parse(source(), "r.toml").output.device_channels == 0);
  CHECK(rig::parse(replaced(source(), "rate_Hz = 192000", "rate_Hz = 192000\ndevice_channels = 10"), "r.toml")
            .output.device_channels == 10);
  CHECK(contains(problems("rate_Hz = 192000", "rate_Hz = 192000\ndevice_channels = 1"),
                 "device_channels is 1; at least 2, the number of channels that the rig uses"));
  CHECK(contains(problems("rate_Hz = 192000", "rate_Hz = 192000\ndevice_channels = 65"), "1 to 64"));
}

TEST_CASE("a spare channel is one that nothing else drives", "[rig]") {
  const auto taken = problems(
      "[limits]", "[marker]\nchannel = 0\nkind = \"pulse\"\n[noise]\nchannel = 0\nrms = 0.5\n[limits]");
  CHECK(contains(taken, "channel 0 drives"));
  CHECK(contains(taken, "use a channel without a transducer"));
  CHECK(contains(taken, "channel 0 is used by the marker"));
  CHECK(contains(taken, "\"rms\""));
  CHECK(contains(problems("[limits]", "[marker]\nchannel = 8\nkind = \"click\"\n[limits]"), "\"click\""));
}
