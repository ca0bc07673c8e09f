#include "physics/python/convert.hpp"
#include "physics/taper.hpp"
#include "physics/warning.hpp"

namespace turnpoint::physics::python {

namespace {

void add_tapers(py::module_& module) {
  record<LinearTaper>(module, "LinearTaper",
                      "Half-width W(x) = half_width_m - slope x. The sides meet at the apex.")
      .def_readwrite("half_width_m", &LinearTaper::half_width_m, "half-width at the drive edge, m")
      .def_readwrite("slope", &LinearTaper::slope, "fall of the half-width per length, no unit");
  record<ExponentialTaper>(module, "ExponentialTaper",
                           "Half-width W(x) = half_width_m exp(-x / decay_length_m).")
      .def_readwrite("half_width_m", &ExponentialTaper::half_width_m, "half-width at the drive edge, m")
      .def_readwrite("decay_length_m", &ExponentialTaper::decay_length_m, "m");
  py::class_<TabulatedTaper>(
      module, "TabulatedTaper",
      "Measured half-widths, joined by monotone cubics. The first point is at x = 0, the last at or "
      "beyond the surface's length; half-widths fall strictly.")
      .def(py::init([](const Numbers& x_m, const Numbers& half_width_m) {
             if (x_m.size() != half_width_m.size())
               throw std::invalid_argument("x_m has " + std::to_string(x_m.size()) +
                                           " values, half_width_m has " +
                                           std::to_string(half_width_m.size()));
             TabulatedTaper taper;
             for (py::ssize_t i = 0; i < x_m.size(); ++i)
               taper.points.push_back({x_m.data()[i], half_width_m.data()[i]});
             return taper;
           }),
           py::arg("x_m"), py::arg("half_width_m"));
}

void add_standard_deviations(py::module_& module) {
  record<ParameterSd>(module, "ParameterSd",
                      "Standard deviations of a surface's parameters; 0 means that a parameter is exact.")
      .def_readwrite("density_kg_m3", &ParameterSd::density_kg_m3)
      .def_readwrite("tension_Pa", &ParameterSd::tension_Pa)
      .def_readwrite("thickness_m", &ParameterSd::thickness_m)
      .def_readwrite("modulus_Pa", &ParameterSd::modulus_Pa)
      .def_readwrite("half_width_m", &ParameterSd::half_width_m)
      .def_readwrite("slope", &ParameterSd::slope)
      .def_readwrite("decay_length_m", &ParameterSd::decay_length_m)
      .def_readwrite("clamp_line_m", &ParameterSd::clamp_line_m)
      .def_readwrite("temperature_K", &ParameterSd::temperature_K)
      .def_readwrite("quality_factor", &ParameterSd::quality_factor);
}

py::array_t<double> half_widths(const Surface& surface, const Numbers& x_m) {
  validate(surface);
  const Taper taper(surface);
  std::vector<double> widths;
  widths.reserve(values(x_m).size());
  for (const double x : values(x_m)) {
    if (!(x >= 0 && x <= surface.length_m))
      throw std::invalid_argument("x_m: " + physics::StatementValue(x).text + " is outside 0 to " +
                                  physics::StatementValue(surface.length_m).text);
    widths.push_back(taper.half_width_m(x));
  }
  return array(std::move(widths));
}

}  // namespace

void add_surface(py::module_& module) {
  add_tapers(module);
  add_standard_deviations(module);
  record<Surface>(module, "Surface",
                  "The tapered surface: material, taper, tension, loss and supports. SI units.")
      .def_readwrite("density_kg_m3", &Surface::density_kg_m3, "density, kg/m3")
      .def_readwrite("tension_Pa", &Surface::tension_Pa, "tension as a stress, Pa; 0 means a plate")
      .def_readwrite("thickness_m", &Surface::thickness_m, "thickness, m")
      .def_readwrite("length_m", &Surface::length_m, "distance from the drive edge to the clamped end, m")
      .def_readwrite("quality_factor", &Surface::quality_factor, "Q; infinity means no loss")
      .def_property(
          "taper", [](const Surface& self) { return self.taper; },
          [](Surface& self, const TaperForm& taper) { self.taper = taper; },
          "LinearTaper, ExponentialTaper or TabulatedTaper; reading returns a copy")
      .def_readwrite("edges", &Surface::edges, "how the sides are held: \"supported\" or \"clamped\"")
      .def_readwrite("bending", &Surface::bending, "\"auto\", \"on\" or \"off\"")
      .def_readwrite("drive", &Surface::drive, "motion across the drive edge: \"cosine\" or \"piston\"")
      .def_readwrite("modulus_Pa", &Surface::modulus_Pa,
                     "Young's modulus, Pa; needed where bending is modelled")
      .def_readwrite("poisson", &Surface::poisson, "Poisson's ratio")
      .def_readwrite("theory", &Surface::theory, "\"kirchhoff\", \"mindlin\" or \"elastic\"")
      .def_readwrite("yield_strength_Pa", &Surface::yield_strength_Pa, "Pa")
      .def_readwrite("expansion_per_K", &Surface::expansion_per_K, "relative change of every length, 1/K")
      .def_readwrite("modulus_per_K", &Surface::modulus_per_K, "relative change of Young's modulus, 1/K")
      .def_readwrite("sd", &Surface::sd, "standard deviations of the parameters");
  record<Tone>(module, "Tone",
               "A tone: the drive edge moves by amplitude_m cos(2 pi frequency_Hz t + phase_rad).")
      .def_readwrite("frequency_Hz", &Tone::frequency_Hz, "Hz")
      .def_readwrite("amplitude_m", &Tone::amplitude_m, "peak displacement of the drive edge's centre, m")
      .def_readwrite("phase_rad", &Tone::phase_rad, "rad");
  py::class_<Warning>(module, "Warning", "A warning: a stable code for programs and a sentence for people.")
      .def_readonly("code", &Warning::code)
      .def_readonly("text", &Warning::text);
  module.def("seed_brass", &seed_brass, "The brass membrane of the 1998 paper.");
  module.def("aluminium_plate", &aluminium_plate, "A clamped aluminium plate, 2 mm thick.");
  module.def("validate", &validate, py::arg("surface"),
             "Raises ValueError if a quantity is outside its physical range.");
  module.def("half_width_m", &half_widths, py::arg("surface"), py::arg("x_m"), "Half-widths W(x) in m.");
  module.def("surface_warnings", &surface_warnings, py::arg("surface"),
             "Warnings about the surface itself, such as a tension above the yield strength.");
}

}  // namespace turnpoint::physics::python
