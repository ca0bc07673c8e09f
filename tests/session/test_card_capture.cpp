#include "station/audio/trigger_code.hpp"
#include "tests/session/card_session.hpp"

// Tests live sessions on the simulated sound card, whose capture returns what was played, delayed and
// attenuated.

using namespace turnpoint;
using namespace turnpoint::card_session;
using core::Proof;
using core::ProofCause;

TEST_CASE(
    "a session on a card proves its stimuli from what the card captures, whatever the delay of the loop",
    "[session][card][proof]") {
  CardSession card;
  card.add_capture(GENERATE(0, 37, 12'345, 60'000));
  const auto trials = card.runs();
  REQUIRE(trials.size() == 2);
  for (const auto& trial : trials) {
    CHECK(trial.outcome == core::Outcome::answered);
    CHECK(trial.surface.proof == Proof::ok);
    CHECK(std::abs(trial.surface.drive_ratio_dB.value()) < 0.01);
    CHECK(std::abs(trial.surface.onset_error_us.value()) < 30);
    REQUIRE_FALSE(trial.tones.empty());
    for (const auto& tone : trial.tones) CHECK(std::abs(tone.measured_phase_deg.value()) < 1);
  }
}

TEST_CASE("a pilot is found if all frames captured before it have been taken", "[session][card][proof]") {
  CardSession card;
  card.add_capture(37);
  card.reacts = [&](const session::Page& page) {
    card.capture->backlog_frames = page.kind == PageKind::stimulus ? 20'000 : 0;
  };
  CHECK(card.runs().size() == 2);
}

TEST_CASE("a stimulus of half the amplitude is void, and the next one is proven", "[session][card][proof]") {
  CardSession card;
  card.add_capture(12'345);
  card.reacts = [&](const session::Page& page) {
    if (page.kind == PageKind::stimulus) card.gain = card.room.stimuli == 1 ? 0.25 : 0.5;
  };
  const auto trials = card.runs();
  REQUIRE(trials.size() == 3);
  CHECK(trials[0].outcome == core::Outcome::fault);
  CHECK(trials[0].surface.proof == Proof::refused);
  CHECK(trials[0].surface.proof_cause == ProofCause::half);
  CHECK(trials[0].surface.drive_ratio_dB.value() == Approx(-6.02).margin(0.1));
  CHECK(trials[1].surface.proof == Proof::ok);
  CHECK(trials[2].surface.proof == Proof::ok);
}

TEST_CASE("a trial whose capture has a gap is void, and a new pilot aligns the next one",
          "[session][card][proof]") {
  const bool unknown = GENERATE(false, true);
  CardSession card;
  card.add_capture(12'345);
  card.reacts = [&](const session::Page& page) {
    if (page.kind != PageKind::stimulus || card.room.stimuli != 1) return;
    card.later(0.1, [unknown] {
      if (unknown)
        fake_pcm().capture_state = audio::FakePcm::State::xrun;
      else
        fake_pcm().taken -= 5'000;  // as if the station had left 5000 more frames unread
    });
  };
  const auto trials = card.runs();
  REQUIRE(trials.size() == 3);
  CHECK(trials[0].outcome == core::Outcome::fault);
  CHECK(trials[0].surface.proof == Proof::lost);
  CHECK(trials[0].surface.proof_cause == ProofCause::gap);
  const auto notices = live_room::events_of(card.setup.database, card.summary, "notice");
  REQUIRE(notices.size() == 1);
  CHECK(notices[0].value.find(unknown ? "1 gaps of unknown length" : "in 1 overruns") != std::string::npos);
  for (const auto i : {1, 2}) {
    CHECK(trials[static_cast<std::size_t>(i)].surface.proof == Proof::ok);
    CHECK(std::abs(trials[static_cast<std::size_t>(i)].surface.onset_error_us.value()) < 30);
  }
}

TEST_CASE("if the pilot is not heard, no stimulus is presented, and the page names the channels",
          "[session][card][proof]") {
  CardSession card;
  card.add_capture(12'345);
  card.wired = false;
  card.reacts = [&](const session::Page& page) {
    if (page.kind == PageKind::fault && page.fault.kind == FaultKind::capture) card.wired = true;
  };
  const auto trials = card.runs();
  REQUIRE(trials.size() == 3);
  CHECK(trials[0].outcome == core::Outcome::fault);
  CHECK(card.faults.back() == FaultKind::capture);
  CHECK(card.details.back() == "the pilot on output channel 2 was not heard on captured channel 0");
  CHECK(live_room::events_of(card.setup.database, card.summary, "stimulus").size() == 2);
  CHECK(trials[1].surface.proof == Proof::ok);
  CHECK(trials[2].surface.proof == Proof::ok);
}

TEST_CASE("after the playback was restarted, a new pilot aligns the capture", "[session][card][proof]") {
  CardSession card;
  card.add_capture(12'345);
  card.reacts = [&](const session::Page& page) {
    if (page.kind == PageKind::stimulus && card.room.stimuli == 1)
      card.later(0.1, [] { fake_pcm().fail(audio::FakePcm::State::xrun); });
  };
  const auto trials = card.runs();
  REQUIRE(trials.size() == 3);
  CHECK(trials[0].outcome == core::Outcome::fault);
  CHECK(trials[1].surface.proof == Proof::ok);
  CHECK(trials[2].surface.proof == Proof::ok);
}

TEST_CASE("without a calibration of the pick-ups, trials count and are unproven", "[session][card][proof]") {
  CardSession card;
  card.add_capture(37, false);
  const auto trials = card.runs();
  REQUIRE(trials.size() == 2);
  for (const auto& trial : trials) {
    CHECK(trial.outcome == core::Outcome::answered);
    CHECK(trial.surface.proof == Proof::unproven);
  }
}

TEST_CASE("trigger codes that the card plays are read back, and other codes on the wire are found",
          "[session][card][trigger]") {
  CardSession card;
  card.add_capture(12'345);
  auto& rig = card.setup.rig;
  rig.marker->kind = rig::Marker::Kind::code;
  rig.marker->amplitude = 0.45;
  rig.capture->channels = 3;
  rig.capture->marker_channel = 2;
  // number of frames since another device began to send code 77; -1 while it sends nothing
  std::int64_t stray = -1;
  const auto wires = fake_pcm().wires;
  fake_pcm().wires = [&](std::span<const std::int32_t> played, std::span<std::int32_t> captured) {
    wires(played, captured);
    captured[2] = played[1] / 2;
    if (stray < 0) return;
    const auto half_bit = stray++ / 96;
    if (half_bit < audio::trigger_half_bits)
      captured[2] += audio::trigger_wave(audio::trigger_pattern(77), static_cast<int>(half_bit)) * (1 << 28);
  };
  card.reacts = [&](const session::Page& page) {
    if (page.kind == PageKind::stimulus && card.room.stimuli == 2) card.later(0.1, [&] { stray = 0; });
  };
  REQUIRE(card.runs().size() == 2);
  const auto rows = live_room::events_of(card.setup.database, card.summary, "trigger");
  CHECK(rows.size() == 6);
  for (const auto& row : rows) {
    INFO(row.value);
    CHECK(row.value.find("read back") != std::string::npos);
  }
  CHECK(card.summary.triggers_missed == 0);
  const auto extra = live_room::events_of(card.setup.database, card.summary, "trigger_extra");
  REQUIRE(extra.size() == 1);
  CHECK(extra[0].value.find("77 frame") == 0);
}

TEST_CASE("a surface that vibrates while the amplifier is off trips the guard, and the page says why",
          "[session][card][sounding]") {
  const bool loud = GENERATE(true, false);
  CardSession card;
  card.add_capture(12'345);
  card.reading_s = 1.2;
  // An amplifier that stays on, and to which something else than the station sends a tone.
  bool stays_on = true;
  const double level = 0.5 * std::pow(10, (loud ? -46 : -54) / 20.0);
  const auto wires = fake_pcm().wires;
  fake_pcm().wires = [&, n = std::int64_t{0}](std::span<const std::int32_t> played,
                                              std::span<std::int32_t> captured) mutable {
    wires(played, captured);
    const double cycles = 27e3 / kRate_Hz * static_cast<double>(n++ % kRate_Hz);
    if (stays_on && card.amplifier->state() != audio::AmplifierState::enabled)
      captured[1] += static_cast<std::int32_t>(0x1p31 * level * std::sin(2 * M_PI * cycles));
  };
  card.reacts = [&](const session::Page& page) {
    if (page.kind == PageKind::fault && page.fault.kind == FaultKind::sounding) stays_on = false;
  };
  const auto trials = card.runs();
  CHECK(std::count(card.faults.begin(), card.faults.end(), FaultKind::sounding) == (loud ? 1 : 0));
  for (std::size_t k = 0; k < card.faults.size(); ++k)
    if (card.faults[k] == FaultKind::sounding)
      CHECK(card.details[k] == "a tone of 27.0 kHz at -46 dB of full drive");
  CHECK(std::count_if(trials.begin(), trials.end(), [](const auto& trial) {
          return trial.outcome == core::Outcome::answered && trial.surface.proof == Proof::ok;
        }) == 2);
}
