#include "physics/zone.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "physics/centre_line.hpp"
#include "physics/crest.hpp"
#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/gate.hpp"
#include "physics/statement.hpp"
#include "physics/zone_profile.hpp"

namespace turnpoint::physics {
namespace {

[[noreturn]] void refuse(const char* code, const char* sentence,
                         std::initializer_list<StatementValue> values) {
  throw Refused(make_statement(code, sentence, values));
}

// Returns a first guess of the highest tone's frequency: the one whose turning point is where the zone must
// end.
double first_guess(const Surface& surface, const ZoneRequest& request) {
  return cut_off_frequency_Hz(surface, std::max(1e-6, half_width_m(surface, request.boundary_m)));
}

void check(const Surface& surface, const FrictionMap& friction, const ZoneRequest& r) {
  validate(surface);
  validate(r.edge);
  require_size_or_0("fingertip_m", r.fingertip_m);
  for (const double one : {r.band.low_Hz, r.band.high_Hz, r.band.spacing_Hz}) require_size("zone band", one);
  if (!(r.from_m >= 0 && r.from_m < r.boundary_m && r.boundary_m <= surface.length_m))
    refuse("zone-place", "zone from %1 to %2 mm; allowed: inside 0 to %3 mm, ascending",
           {r.from_m * 1e3, r.boundary_m * 1e3, surface.length_m * 1e3});
  if (!(r.friction < 1) || r.friction <= friction.lowest_friction())
    refuse("zone-friction", "zone friction %1 is not reachable; allowed: above %2, below 1",
           {r.friction, friction.lowest_friction()});
  require(r.tones >= 1 && r.tones <= 40, "zone tones", r.tones, "1 to 40");
  if (!(r.band.low_Hz > 0 && r.band.low_Hz < r.band.high_Hz && r.band.spacing_Hz > 0)) {
    throw std::invalid_argument("zone band: low_Hz below high_Hz and spacing_Hz above 0 are needed");
  }
  if (r.edge.kind == Edge::Kind::friction && !(r.edge.level > r.friction && r.edge.level < 1))
    refuse("zone-edge", "zone edge at friction %1; allowed: above the friction in the zone, %2, and below 1",
           {r.edge.level, r.friction});
}

// Shifts the frequencies of all tones together, by the secant method, until the zone's edge is at the wanted
// boundary.
void place(ZoneProfile& profile, const ZoneRequest& r, double tolerance_m) {
  double f = profile.highest_Hz();
  double slope = 0;
  double previous_f = 0, previous_x = 0;
  for (int i = 0; i < 25; ++i) {
    profile.scale_to_friction();
    const auto x = profile.edge_m();
    if (!x)
      refuse("zone-without-edge", "the zone's profile has no edge %1 near %2 mm",
             {format(r.edge), r.boundary_m * 1e3});
    if (std::abs(*x - r.boundary_m) < tolerance_m) return;
    slope = i == 0 || f == previous_f || *x == previous_x ? profile.edge_slope_m_per_Hz()
                                                          : (*x - previous_x) / (f - previous_f);
    if (!(slope > 0)) slope = profile.edge_slope_m_per_Hz();
    previous_f = f;
    previous_x = *x;
    const double step = std::clamp((r.boundary_m - *x) / slope, -0.1 * f, 0.1 * f);
    f += step;
    profile.shift_to(f);
  }
}

void require_band(const ZoneProfile& profile, const ZoneRequest& r) {
  const double f = profile.highest_Hz();
  if (f <= r.band.high_Hz && f >= r.band.low_Hz) return;
  refuse("zone-band", "zone boundary %1 mm needs %2 Hz; allowed: %3 to %4 Hz",
         {r.boundary_m * 1e3, f, r.band.low_Hz, r.band.high_Hz});
}

}  // namespace

// The two profiles of a solved zone: with one tone, and with all. The key is what they were solved for: the
// request, with a friction only if the edge depends on it.
struct ZoneDesigner::Solved {
  ZoneRequest key;
  ZoneProfile alone, all;
  std::vector<Warning> warnings = {};  // of the tones, which depend on their frequencies only
};

ZoneDesigner::ZoneDesigner(const Surface& surface, const FrictionMap& friction)
    : surface_(surface), friction_(friction) {}
ZoneDesigner::~ZoneDesigner() = default;

const ZoneDesigner::Solved& ZoneDesigner::solve(const ZoneRequest& request) {
  constexpr std::size_t most = 16;
  ZoneRequest key = request;
  if (key.edge.kind != Edge::Kind::friction) key.friction = 0;
  for (auto& one : solved_) {
    if (one->key != key) continue;
    one->alone.rescale_to_friction(request.friction);
    one->all.rescale_to_friction(request.friction);
    return *one;
  }
  // First design the zone with a single tone. This shows roughly where the highest tone must be before the
  // other tones are chosen.
  ZoneRequest single = request;
  single.tones = 1;
  ZoneProfile alone(surface_, friction_, single, first_guess(surface_, request));
  place(alone, single, 2e-5);
  require_band(alone, request);
  ZoneProfile all(surface_, friction_, request, alone.highest_Hz());
  place(all, request, 2e-7);
  require_band(all, request);
  if (solved_.size() == most) solved_.erase(solved_.begin());
  auto warnings = tone_warnings(surface_, all.tones());
  solved_.push_back(
      std::make_unique<Solved>(Solved{key, std::move(alone), std::move(all), std::move(warnings)}));
  return *solved_.back();
}

ZoneDesign design_zone(const Surface& surface, const FrictionMap& friction, const ZoneRequest& request) {
  return ZoneDesigner(surface, friction).design(request);
}

ZoneDesign ZoneDesigner::design(const ZoneRequest& request) {
  check(surface_, friction_, request);
  const Solved& solved = solve(request);
  const ZoneProfile& profile = solved.all;
  ZoneDesign design;
  design.tones = profile.tones();
  assign_phases(design.tones);
  design.crest_factor = crest_factor(design.tones);
  profile.measure(design);
  std::ostringstream reason;
  reason << design.tones.size() << (design.tones.size() == 1 ? " tone" : " tones") << " from "
         << design.tones.back().frequency_Hz / 1e3 << " to " << design.tones.front().frequency_Hz / 1e3
         << " kHz; friction inside varies by " << design.residual << " rms";
  if (static_cast<int>(design.tones.size()) < request.tones) {
    reason << "; further tones would lie below " << request.band.low_Hz / 1e3 << " kHz or add nothing";
  }
  design.reason = reason.str();
  design.warnings = surface_warnings(surface_);
  design.warnings.insert(design.warnings.end(), solved.warnings.begin(), solved.warnings.end());
  return design;
}

}  // namespace turnpoint::physics
