#include <cmath>
#include <limits>

#include "physics/boundary_fit.hpp"
#include "physics/boundary_map.hpp"
#include "physics/plate_theory.hpp"
#include "physics/python/convert.hpp"

namespace turnpoint::physics::python {

namespace {

MapOptions options(const Edge& edge, std::optional<Model> model, std::optional<double> tolerance_m,
                   std::optional<FrictionContext> friction,
                   std::optional<std::pair<double, double>> band_Hz) {
  MapOptions made{edge, model, tolerance_m, std::move(friction), {}};
  if (band_Hz) made.band = MapOptions::Band{band_Hz->first, band_Hz->second};
  return made;
}

// Looks up one number (None if there is no result), or an array (NaN where there is none).
template <class LookUp>
py::object look_up(const py::object& query, const LookUp& at) {
  if (py::isinstance<py::float_>(query) || py::isinstance<py::int_>(query))
    return py::cast(at(query.cast<double>()));
  const auto numbers = Numbers::ensure(query);
  if (!numbers) throw py::error_already_set();
  std::vector<double> found;
  found.reserve(values(numbers).size());
  for (const double value : values(numbers))
    found.push_back(at(value).value_or(std::numeric_limits<double>::quiet_NaN()));
  return array(std::move(found));
}

void add_answer(py::module_& module) {
  record<FrictionContext>(module, "FrictionContext", "What a friction edge needs in addition to the surface.")
      .def_readwrite("friction", &FrictionContext::friction)
      .def_readwrite("displacement_m", &FrictionContext::displacement_m,
                     "peak amplitude at the last maximum, m")
      .def_readwrite("fingertip_m", &FrictionContext::fingertip_m, "m");
  py::class_<MapAnswer>(module, "MapAnswer",
                        "The result of a look-up, with error bound, uncertainty, reason and warnings.")
      .def_readonly("boundary_m", &MapAnswer::boundary_m)
      .def_readonly("frequency_Hz", &MapAnswer::frequency_Hz)
      .def_readonly("edge", &MapAnswer::edge)
      .def_readonly("model", &MapAnswer::model)
      .def_readonly("error_bound_m", &MapAnswer::error_bound_m, "error of the model, m")
      .def_readonly("uncertainty_m", &MapAnswer::uncertainty_m,
                    "standard deviation that the surface's parameters cause, m")
      .def_readonly("m_per_Hz", &MapAnswer::m_per_Hz)
      .def_readonly("shear_shift_m", &MapAnswer::shear_shift_m)
      .def_readonly("reason", &MapAnswer::reason)
      .def_readonly("warnings", &MapAnswer::warnings);
}

void add_uncertainty(py::module_& module) {
  py::class_<Contribution>(module, "Contribution",
                           "What one uncertain parameter contributes to the uncertainty of a boundary.")
      .def_readonly("parameter", &Contribution::parameter)
      .def_readonly("sd", &Contribution::sd, "standard deviation of the parameter, SI units")
      .def_readonly("moved_m", &Contribution::moved_m, "how far one standard deviation moves the boundary, m")
      .def_readonly("left_m", &Contribution::left_m,
                    "the boundary's standard deviation if this parameter were known exactly, m");
  py::class_<BoundaryBudget>(module, "BoundaryBudget",
                             "How uncertain a boundary is, and which parameters cause this.")
      .def_readonly("contributions", &BoundaryBudget::contributions)
      .def_readonly("total_m", &BoundaryBudget::total_m, "one standard deviation, m");
  module.def("boundary_budget", &boundary_budget, py::arg("surface"), py::arg("frequency_Hz"),
             py::arg("boundary_m"),
             "What each uncertain parameter contributes to the uncertainty of a boundary, largest first.");
  module.def("shear_shift_m", &shear_shift_m, py::arg("surface"), py::arg("frequency_Hz"),
             "Distance by which the next better plate theory would move the turning point, m.");
  record<MeasuredBoundary>(module, "MeasuredBoundary", "The measured position of an edge at one frequency.")
      .def_readwrite("frequency_Hz", &MeasuredBoundary::frequency_Hz)
      .def_readwrite("boundary_m", &MeasuredBoundary::boundary_m)
      .def_readwrite("sd_m", &MeasuredBoundary::sd_m, "precision of the measurement, m");
  py::class_<FittedParameter>(module, "FittedParameter", "One parameter of a fit.")
      .def_readonly("parameter", &FittedParameter::parameter)
      .def_readonly("change", &FittedParameter::change, "estimate minus the value in the surface, SI units")
      .def_readonly("sd", &FittedParameter::sd)
      .def_readonly("prior_sd", &FittedParameter::prior_sd);
  py::class_<BoundaryFit>(module, "BoundaryFit", "Parameters estimated from measured boundaries.")
      .def_readonly("parameters", &BoundaryFit::parameters)
      .def_readonly("residuals_m", &BoundaryFit::residuals_m, "measured minus fitted, m")
      .def_readonly("deviations", &BoundaryFit::deviations)
      .def_readonly("outliers", &BoundaryFit::outliers)
      .def_readonly("left_out", &BoundaryFit::left_out)
      .def(
          "applied_to",
          [](const BoundaryFit& self, const Surface& surface) {
            return with_fit(surface, self.parameters, self.correlations);
          },
          py::arg("surface"), "The surface with the fitted parameters and their standard deviations.");
  module.def(
      "fit_boundaries",
      [](const Surface& surface, const std::vector<MeasuredBoundary>& measured, const Edge& edge) {
        return fit_boundaries(surface, {edge, {}, {}, {}}, measured);
      },
      py::arg("surface"), py::arg("measured"), py::arg("edge") = Edge::turning(),
      "Fits the surface's uncertain parameters to measured boundaries.");
}

}  // namespace

void add_map(py::module_& module) {
  add_answer(module);
  add_uncertainty(module);
  py::class_<BoundaryMap>(module, "BoundaryMap",
                          "The map between boundary and frequency for one surface and one edge.")
      .def(py::init([](const Surface& surface, const Edge& edge, std::optional<Model> model,
                       std::optional<double> tolerance_m, std::optional<FrictionContext> friction,
                       std::optional<std::pair<double, double>> band_Hz) {
             const auto chosen = options(edge, model, tolerance_m, std::move(friction), band_Hz);
             const py::gil_scoped_release other_threads_run;
             return BoundaryMap(surface, chosen);
           }),
           py::arg("surface"), py::arg("edge") = Edge::turning(), py::kw_only(),
           py::arg("model") = py::none(), py::arg("tolerance_m") = py::none(),
           py::arg("friction") = py::none(), py::arg("band_Hz") = py::none(),
           "edge: \"turning\", \"peak\", \"p70\", \"friction=0.7\".")
      .def_property_readonly("model", &BoundaryMap::model)
      .def(
          "boundary_m",
          [](const BoundaryMap& self, const py::object& frequency_Hz) {
            return look_up(frequency_Hz, [&](double query) { return self.boundary_m(query); });
          },
          py::arg("frequency_Hz"),
          "The boundary in m. If there is none: None for one frequency, NaN in an array.")
      .def(
          "frequency_Hz",
          [](const BoundaryMap& self, const py::object& boundary_m) {
            return look_up(boundary_m, [&](double query) { return self.frequency_Hz(query); });
          },
          py::arg("boundary_m"),
          "The frequency in Hz. If there is none: None for one boundary, NaN in an array.")
      .def("at_frequency", &BoundaryMap::at_frequency, py::arg("frequency_Hz"))
      .def("at_boundary", &BoundaryMap::at_boundary, py::arg("boundary_m"));
  module.def(
      "solve_frequency_Hz",
      [](const Surface& surface, double boundary_m, const Edge& edge, std::optional<Model> model,
         std::optional<FrictionContext> friction) {
        return solve_frequency_Hz(surface, options(edge, model, {}, std::move(friction), {}), boundary_m);
      },
      py::arg("surface"), py::arg("boundary_m"), py::arg("edge") = Edge::turning(), py::kw_only(),
      py::arg("model") = py::none(), py::arg("friction") = py::none(),
      py::call_guard<py::gil_scoped_release>(),
      "The frequency that puts the edge at boundary_m, without a map; None if the search fails.");
}

}  // namespace turnpoint::physics::python
