// The state of a Director, shared by director.cpp and director_trials.cpp. Other files must not include it.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "station/procedure/procedure.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::trial {

struct Director::State {
  static constexpr int no_procedure = -1;

  const protocol::Protocol& protocol;
  std::uint64_t seed;
  procedure::Programs* programs;
  procedure::EarlierTrials earlier;
  std::vector<protocol::Block> blocks;
  std::size_t block = 0;
  /// number of the current attempt at the block, and of the first attempt since the session was started or
  /// restarted
  int attempt = 0, first_attempt = 0;
  /// number of trials of the block so far that count; part of the key of the next trial's random draws
  int trial = 0;
  int shown = 0, right = 0;
  int warmups = 0, warmups_given = 0;
  int done = 0;
  std::string ended;
  std::vector<const procedure::Spec*> specs;
  std::vector<std::unique_ptr<procedure::Procedure>> procedures;
  std::vector<double> practice_levels;
  /// trials of the blocks that measure a friction table, by block
  std::map<std::size_t, std::vector<Stroke>> strokes;
  std::optional<TrialSpec> current;
  int current_procedure = no_procedure;

  State(const protocol::Protocol& p, const protocol::Visit& visit, std::uint64_t s,
        procedure::Programs* starts, procedure::EarlierTrials before)
      : protocol(p),
        seed(s),
        programs(starts),
        earlier(std::move(before)),
        blocks(protocol::block_order(p, visit)) {
    enter_block();
  }

  const protocol::Block* now() const {
    return ended.empty() && block < blocks.size() ? &blocks[block] : nullptr;
  }
  random::Draws draws(random::Stream stream, int key) const {
    return random::Draws({seed, stream, static_cast<int>(block), attempt, key});
  }

  // These functions handle blocks and procedures (director.cpp).
  void enter_block();
  const procedure::Spec* find_spec(const std::string& name) const;
  procedure::Context context_for(const procedure::Spec& spec) const;
  void learn(const TrialEnd& end);
  int block_expected(const protocol::Block& b) const;
  int left_in_block() const;

  // These functions make one trial (director_trials.cpp).
  bool timeouts_are_data() const;
  void set_times(TrialSpec& spec) const;
  protocol::Factors drawn_factors() const;
  protocol::FactorValue drawn_value(const protocol::Factor& factor, int number) const;
  std::optional<int> pick_procedure() const;
  bool catch_due() const;
  TrialSpec blank(terms::TrialType type) const;
  void complete(TrialSpec& spec) const;
  std::optional<SliderSpan> slider(int key) const;
  TrialSpec warmup_trial() const;
  TrialSpec catch_trial() const;
  std::optional<TrialSpec> practice_trial() const;
  std::optional<TrialSpec> strokes_trial() const;
  TrialSpec procedure_trial(int index) const;
  std::optional<TrialSpec> make();
};

}  // namespace turnpoint::trial
