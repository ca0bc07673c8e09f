#pragma once
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/records/records.hpp"
#include "station/report/session_data.hpp"

namespace turnpoint::report {

/// Recomputes the final estimates of adaptive procedures from the stored answers of these blocks, and adds
/// them to `data`. `data.seed`, `data.alternatives` and `data.level_unit` must be set.
void add_estimates(const std::vector<const records::BlockRecord*>& blocks, const protocol::Protocol& protocol,
                   SessionData& data);

/// An axis label: "Contrast (dB)" for the name "contrast" and the unit "dB".
std::string axis_label(std::string name, const std::string& unit);

/// Unit of a procedure's parameter, made from the units of its level and of its second dimension: "dB/mm" for
/// a gradient; "" if it has none.
std::string unit_of(const std::string& parameter, const procedure::Spec& spec);

}  // namespace turnpoint::report
