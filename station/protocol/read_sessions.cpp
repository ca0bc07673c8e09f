#include <algorithm>
#include <set>

#include "station/procedure/description.hpp"
#include "station/protocol/advice_list.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/reading.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/visits.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::TableReader;
using core::Value;

namespace {

constexpr int most_groups = 100;

std::vector<std::string> levels_of_groups(const Protocol& protocol) {
  std::vector<std::string> names;
  for (const auto& factor : protocol.factors)
    for (const auto& level : is_group(factor) ? factor.levels : std::vector<FactorValue>{})
      if (const auto* name = std::get_if<std::string>(&level)) names.push_back(*name);
  return names;
}

void read_session_numbers(TableReader& reader, Audience& audience, const Reading& reading) {
  const auto* list = reader.take("sessions");
  if (!list) return;
  const auto& plan = reading.protocol.sessions;
  if (!plan)
    return reader.problem("sessions", phrase("\"sessions\" is set, but the file has no [sessions]"),
                          phrase("add [sessions] with the number of sessions: %1", {plain("count = 2")}));
  for (const double number : reader.numbers("sessions", {1, static_cast<double>(plan->count)})) {
    const int whole = static_cast<int>(number);
    const auto& before = audience.sessions;
    if (whole != number || std::find(before.begin(), before.end(), whole) != before.end())
      reader.problem("sessions", phrase("\"sessions\" must have whole numbers, each only once"),
                     phrase("such as %1", {plain("[1, " + std::to_string(plan->count) + "]")}));
    audience.sessions.push_back(whole);
  }
}

/// Returns the session and the group of a visit in words, for messages.
core::Phrase visit_words(const Protocol& protocol, const Visit& visit) {
  const auto session = phrase("check.session", {plain(visit.session)});
  const auto name = group_name(protocol, visit);
  if (name.empty()) return protocol.sessions ? session : phrase("the session");
  const auto group = phrase("check.group", {plain(name)});
  return protocol.sessions ? core::Phrase{"", "", {session, plain(", "), group}} : group;
}

/// Reports a planned session in which a group has no block.
void check_blocks(const Reading& reading) {
  const auto& protocol = reading.protocol;
  for (const auto& visit : different_visits(protocol)) {
    const auto mine = [&](const auto& part) { return is_for(block_of(part).audience, protocol, visit); };
    if (protocol.plan.empty() || std::any_of(protocol.plan.begin(), protocol.plan.end(), mine)) continue;
    return reading.findings.add(
        protocol.sessions ? protocol.sessions->place : block_of(protocol.plan.front()).place,
        phrase("%1 has no block", {visit_words(protocol, visit)}),
        phrase("give at least one block or sequence to each session of each group"));
  }
}

/// Reports sequences over a factor of which each participant has only one level, or that a procedure in their
/// blocks sets, and sequences with one level per session if the number of sessions differs from the number of
/// levels.
void check_sequences(const Reading& reading) {
  const auto& protocol = reading.protocol;
  for (const auto& part : protocol.plan) {
    const auto* sequence = std::get_if<Sequence>(&part);
    const auto* factor = sequence ? find_factor(protocol.factors, sequence->over) : nullptr;
    if (!factor) continue;
    const auto place = reading.places.of("sequence." + sequence->name + ".over");
    if (is_group(*factor))
      reading.findings.add(place,
                           phrase("each participant has only one level of \"%1\"", {plain(factor->name)}),
                           phrase("use a factor whose \"draw\" is not \"per-participant\""));
    for (const auto& source : sources_of(protocol))
      if (source.block == &sequence->block && source.spec && source.spec->with.count(factor->name) > 0)
        reading.findings.add(
            place,
            phrase("%1 sets \"%2\" in every block of the sequence, so that its blocks are alike",
                   {source.what, plain(factor->name)}),
            phrase("leave the factor to the sequence, or use a [[block]] instead"));
    if (!sequence->one_per_session) continue;
    const auto& listed = sequence->block.audience.sessions;
    const auto sessions = listed.empty() ? session_count(protocol) : static_cast<int>(listed.size());
    if (sessions != static_cast<int>(factor->levels.size()))
      reading.findings.add(reading.places.of("sequence." + sequence->name + ".each_session"),
                           phrase("\"%1\" has %2 levels, but the sequence has %3 sessions",
                                  {plain(factor->name), plain(factor->levels.size()), plain(sessions)}),
                           phrase("there must be one session for each level"));
  }
}

/// Checks factors with one level for each participant: nothing else may set them, and each level of
/// "instruction" needs a table.
void check_group_factors(const Reading& reading) {
  const auto& protocol = reading.protocol;
  for (const auto& factor : protocol.factors) {
    if (!is_group(factor)) continue;
    for (const auto& source : sources_of(protocol))
      if (source.sets.count(factor.name) > 0 && source.spec)
        return reading.findings.add(
            source.block->place,
            phrase("in block \"%1\", %2 sets \"%3\", of which each participant has only one level",
                   {plain(source.block->name), source.what, plain(factor.name)}),
            phrase("let nothing else set a factor that is drawn per participant"));
    if (factor.name != "instruction") continue;
    for (const auto& level : factor.levels)
      if (const auto* name = std::get_if<std::string>(&level); !name || !protocol.instructions.count(*name))
        return reading.findings.add(
            factor.place, phrase("not every level of \"instruction\" has a table"),
            phrase("add [instructions.NAME] for each level of the factor \"instruction\""));
  }
}

/// Reports rules about an answer or a score that the same session does not have.
void check_rules(const Reading& reading) {
  const auto& protocol = reading.protocol;
  const auto audience_of = [&](const std::string& name) -> const Audience* {
    for (const auto& part : protocol.plan)
      if (block_of(part).name == name) return &block_of(part).audience;
    for (const auto& interlude : protocol.interludes)
      if (interlude.name == name) return &interlude.audience;
    return nullptr;
  };
  const auto check = [&](const Interlude& interlude, const AnswerCondition& rule) {
    const auto* needed = audience_of(rule.about.substr(0, rule.about.find('.')));
    for (const auto& visit : different_visits(protocol))
      if (needed && is_for(interlude.audience, protocol, visit) && !is_for(*needed, protocol, visit))
        return reading.findings.add(rule.place,
                                    phrase("\"%1\" is about something that %2 does not have",
                                           {plain(rule.source), visit_words(protocol, visit)}),
                                    phrase("give both the same \"sessions\" and \"groups\""));
  };
  for (const auto& interlude : protocol.interludes) {
    for (const auto& rule : interlude.pass) check(interlude, rule);
    for (const auto& item : interlude.items)
      for (const auto& rule : item.when) check(interlude, rule);
  }
}

/// On each day, at most one block may run the procedure, and it must limit the trials: otherwise the first
/// day would finish it.
template <class Report>
void check_days_of(const procedure::Spec& spec, const Protocol& protocol, const Report& report) {
  for (const auto& visit : different_visits(protocol)) {
    int blocks = 0;
    for (const auto& block : block_order(protocol, visit)) {
      if (std::find(block.procedures.begin(), block.procedures.end(), spec.name) == block.procedures.end())
        continue;
      if (block.practice)
        return report(phrase("block \"%1\" is practice", {plain(block.name)}),
                      phrase("use it in a block that is no practice"));
      if (!block.trials)
        return report(phrase("block \"%1\" does not say how many trials a day has", {plain(block.name)}),
                      phrase("add \"trials\" to the block"));
      if (++blocks > 1)
        return report(phrase("%1 has two blocks with it", {visit_words(protocol, visit)}),
                      phrase("use it in one block of a session"));
    }
  }
}

/// A procedure that continues needs a session in which to continue, and a block that ends before it is done.
void check_continuing(const Reading& reading) {
  const auto& protocol = reading.protocol;
  // A sequence over a factor without levels has no order of blocks; its mistake has been reported.
  for (const auto& part : protocol.plan)
    if (const auto* sequence = std::get_if<Sequence>(&part)) {
      const auto* factor = find_factor(protocol.factors, sequence->over);
      if (factor == nullptr || factor->levels.empty()) return;
    }
  for (const auto& spec : protocol.procedures) {
    if (!spec.continues) continue;
    const auto report = [&](const core::Phrase& what, const core::Phrase& allowed) {
      reading.findings.add(
          reading.places.of(key_of(spec, "continues")),
          phrase("procedure \"%1\" continues on another day, but %2", {plain(spec.name), what}), allowed);
    };
    const auto choice = procedure::description(spec.kind).choice;
    if (choice != procedure::Choice::track && choice != procedure::Choice::posterior)
      report(phrase("this kind of procedure does not follow from its answers alone"),
             phrase("use a staircase, QUEST+ or another procedure with a posterior"));
    else if (!protocol.sessions)
      report(phrase("the file plans no sessions"), phrase("add [sessions]"));
    else
      check_days_of(spec, protocol, report);
  }
}

void read_assignment(TableReader& file, const Reading& reading) {
  const auto* table = file.maybe_table("assignment");
  if (!table) return;
  TableReader reader(*table, "assignment", reading.findings, file.keys("assignment"));
  reading.protocol.dropout_after_h = reader.number("dropout_after_h");
  reader.finish();
}

/// Reports an [assignment] that has nothing to even out, or that replaces participants before they may come
/// back.
void check_assignment(const Reading& reading) {
  const auto& protocol = reading.protocol;
  if (!protocol.dropout_after_h) return;
  const auto place = reading.places.of("assignment.dropout_after_h");
  if (place_count(protocol) == 1)
    reading.findings.add(place, phrase("all participants have the same blocks in the same order"),
                         phrase("leave [assignment] out, or add a sequence or a factor with %1",
                                {plain("draw = \"per-participant\"")}));
  // The first day on which a participant may come ends at most so many hours after the last session.
  const int min_days = protocol.sessions ? protocol.sessions->min_days : 0;
  const double needed_h = min_days > 0 ? 24.0 * (min_days + 1) : 0;
  if (*protocol.dropout_after_h < needed_h)
    reading.findings.add(
        place,
        phrase("participants would be replaced before the first day on which they may come back is over"),
        phrase("at least %1", {plain(core::number(needed_h))}));
}

}  // namespace

void read_sessions(TableReader& file, Reading& reading) {
  if (group_count(reading.protocol) > most_groups)
    reading.findings.add(reading.protocol.factors.front().place,
                         phrase("%1 groups", {plain(group_count(reading.protocol))}),
                         phrase("at most %1", {plain("100")}));
  read_assignment(file, reading);
  const auto* table = file.maybe_table("sessions");
  if (!table) return;
  TableReader reader(*table, "sessions", reading.findings, file.keys("sessions"));
  SessionPlan plan;
  plan.place = reader.place();
  plan.count = reader.integer("count");
  plan.min_days = reader.integer("min_days");
  plan.incomplete = reader.word("incomplete") == "count" ? Unfinished::count : Unfinished::repeat;
  reader.finish();
  reading.protocol.sessions = plan;
}

void read_audience(TableReader& reader, Audience& audience, const Reading& reading) {
  read_session_numbers(reader, audience, reading);
  audience.groups = reader.maybe_strings("groups");
  const auto known = levels_of_groups(reading.protocol);
  std::set<std::string> seen;
  for (const auto& name : audience.groups) {
    const auto count = std::count(known.begin(), known.end(), name);
    if (count == 0)
      reader.problem("groups", phrase("there is no group \"%1\"", {plain(name)}),
                     known.empty()
                         ? phrase("name levels of a factor with %1", {plain("draw = \"per-participant\"")})
                         : core::suggestion(name, known));
    else if (count > 1)
      reader.problem("groups", phrase("two factors have the level \"%1\"", {plain(name)}),
                     phrase("give the groups different names"));
    else if (!seen.insert(name).second)
      reader.problem("groups", phrase("\"%1\" appears twice", {plain(name)}),
                     phrase("list each group only once"));
  }
}

void check_visits(const Reading& reading) {
  check_blocks(reading);
  check_sequences(reading);
  check_group_factors(reading);
  check_rules(reading);
  check_continuing(reading);
  check_assignment(reading);
}

}  // namespace turnpoint::protocol
