#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "station/procedure/procedure.hpp"
#include "station/session/conversation.hpp"

namespace turnpoint::session {

/// A procedure whose levels a separate program chooses. The program is started when the first level is
/// needed, and ended with this object. If it fails, next() throws core::ProgramFailed once; the next call of
/// ready() or next() starts it again, gives it all answers so far, and insists on the same levels.
class ProgramProcedure final : public procedure::Procedure {
 public:
  /// `path` is the program's file. `greeted` is called whenever the program was started and has greeted.
  ProgramProcedure(const procedure::Spec& spec, const core::DrawKey& key, std::string path,
                   std::function<void(const Identity&)> greeted);

  bool ready() const override;
  std::optional<procedure::Proposal> next() const override;
  void record(procedure::Answer answer) override;
  int recorded() const override { return answered_; }
  int expected() const override;
  /// The estimates that came with the reply to the last answer; empty until that reply is here.
  std::map<std::string, procedure::Estimate> estimates() const override;
  std::uint64_t state_hash() const override;

 private:
  struct Trial {
    double level = 0;
    procedure::Answer answer = procedure::Answer::none;
  };
  /// What is known from the program. next() is const, because it shows what the answers have decided; how far
  /// the exchange with the program has got does not count as a change.
  struct Talk {
    std::unique_ptr<Conversation> with;  ///< null before the start, and after a failure
    bool greeted = false;
    std::size_t compared = 0;  ///< number of levels that the program has given since it was started
    std::optional<double> level;
    bool done = false;
    std::map<std::string, procedure::Estimate> estimates;
    std::optional<std::string> failure;  ///< not yet thrown
  };

  void begin() const;
  void ask_for_level() const;
  void take(const Json& reply) const;
  double level_in(const Json& reply) const;
  bool at_limit() const;

  procedure::Spec spec_;
  core::DrawKey key_;
  std::string path_;
  std::function<void(const Identity&)> greeted_;
  std::vector<Trial> trials_;
  int answered_ = 0;
  std::unique_ptr<Talk> talk_;
};

/// The settings of a protocol as JSON.
Json to_json(const core::Value& value);

}  // namespace turnpoint::session
