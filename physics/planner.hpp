#pragma once
// Chooses the cheapest model whose error bound meets the tolerance of a scene.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/edge.hpp"
#include "physics/field.hpp"
#include "physics/model.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"

namespace turnpoint::physics {

// The accuracy that a scene requires. An empty value means no requirement.
struct Tolerance {
  std::optional<double> boundary_m;
  std::optional<double> amplitude;  // of |v|, relative to its largest value
  std::optional<double> level_dB;   // of the last maximum
};

// The error bounds of a model for a set of tones, before it is evaluated. They are relative to the
// two-dimensional field for membranes and simply supported plates, and to the one-mode equation for clamped
// plates.
struct RungEstimate {
  Model model = Model::mode;
  bool usable = true;           // false: it cannot answer this at all (reason says why)
  double boundary_bound_m = 0;  // of any edge position
  double amplitude_bound = 0;   // of |v|, relative to its largest value
  double level_bound_dB = 0;    // of the last maximum
  double cost_s = 0;            // on one core of a 3 GHz machine
  std::string reason;
};

struct PlanRequest {
  std::vector<Tone> tones;
  int points = 0;  // 0: positions only
  Edge edge = Edge::turning();
  Normalise normalise = Normalise::peak;
  Tolerance tolerance;
  // The model by which the tones' frequencies were found, if that is not the one to be chosen: the boundary
  // then has its error, whichever model describes the field.
  std::optional<Model> placed_by = {};
};

RungEstimate estimate(const Surface& surface, const PlanRequest& request, Model model);

struct PlanChoice {
  Model model = Model::mode;
  RungEstimate bound;  // of the chosen rung
  bool inside = true;  // false: no model meets the tolerance; this one comes closest
  std::string reason;  // one sentence, with numbers
  std::vector<RungEstimate> considered;
};

PlanChoice choose_model(const Surface& surface, const PlanRequest& request);

}  // namespace turnpoint::physics
