#include "physics/planner.hpp"

#include <cmath>

namespace turnpoint::physics {

RungEstimate estimate(const Surface&, const PlanRequest& request, Model model) {
  RungEstimate e;
  e.model = model;
  e.usable =
      model != Model::uniform && model != Model::modes && (model != Model::edge || request.points == 0);
  e.amplitude_bound = model == Model::mode ? 0.06 : model == Model::seed ? 0.4 : 1.3;
  e.boundary_bound_m = model == Model::mode ? 0.3e-3 : 0.5e-3;
  e.cost_s = 35e-6;
  e.reason = "provisional";
  return e;
}

PlanChoice choose_model(const Surface& surface, const PlanRequest& request) {
  PlanChoice choice;
  choice.bound = estimate(surface, request, Model::mode);
  choice.reason = "provisional";
  return choice;
}

}  // namespace turnpoint::physics
