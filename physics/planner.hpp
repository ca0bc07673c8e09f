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

// The errors that a scene tolerates. An empty value means that any error is tolerated.
struct Tolerance {
  std::optional<double> boundary_m;
  std::optional<double> amplitude;  // error of |v|, relative to its largest value
  std::optional<double> level_dB;   // error of |v| at the last maximum, relative to |v(0)|
};

// The error bounds of a model for a set of tones. They are estimated before the model is evaluated, except
// that estimate() solves for `modes` twice and compares, and for `mode` of a clamped plate compares it with
// `modes`, and that choose_model() compares with coarser and finer solutions as far as the tolerance demands
// it. For membranes and simply supported plates the errors are differences from the two-dimensional field;
// for clamped plates, from the one-mode equation.
struct RungEstimate {
  Model model = Model::mode;
  bool usable = true;           // false if the model cannot be used here at all (`reason` says why)
  double boundary_bound_m = 0;  // error of the position, for any edge
  double amplitude_bound = 0;   // error of |v|, relative to its largest value
  double level_bound_dB = 0;    // error of |v| at the last maximum, relative to |v(0)|
  double cost_s = 0;            // computing time on one core of a 3 GHz machine
  std::string reason;
};

struct PlanRequest {
  std::vector<Tone> tones;
  int points = 0;  // number of points of the profile; 0 if only positions are needed
  Edge edge = Edge::turning();
  Normalise normalise = Normalise::peak;
  Tolerance tolerance;
  // Set this if another model has already computed the tones' frequencies. The boundary then has the error of
  // that other model, whichever model the planner chooses for the field.
  std::optional<Model> placed_by = {};
  std::vector<Edge> edges = {};  // the edge of each tone; if empty, `edge` is that of all
  Model coarsest = Model::edge;  // coarser models are not considered
};

RungEstimate estimate(const Surface& surface, const PlanRequest& request, Model model);

struct PlanChoice {
  Model model = Model::mode;
  RungEstimate bound;  // error bounds of the chosen model
  // false if no model meets the tolerance; the model with the smallest error is then chosen
  bool inside = true;
  std::string reason;                   // why this model was chosen: one sentence with numbers
  std::optional<RungEstimate> cheaper;  // the most exact one of the cheaper models
  std::vector<RungEstimate> considered;
  // The solutions of the model (of `mode`, if the model is `edge`), if the choice has needed them. evaluate()
  // takes them, so that nothing is solved twice.
  SolvedLines solved;
};

// Takes the cheapest model whose bounds are inside the tolerance. It solves `mode`; if what is known then
// does not decide, `modes` at its coarsest resolution, which takes a tenth of the operations and shows
// whether `mode` suffices; and only if nothing is inside otherwise, `modes` and finer solutions (see
// README.md). What it presents is `mode` or `modes` at the default resolution.
PlanChoice choose_model(const Surface& surface, const PlanRequest& request);

}  // namespace turnpoint::physics
