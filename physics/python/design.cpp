#include "physics/airborne.hpp"
#include "physics/crest.hpp"
#include "physics/friction.hpp"
#include "physics/python/convert.hpp"
#include "physics/zone.hpp"

namespace turnpoint::physics::python {

namespace {

py::array_t<double> frictions(const FrictionMap& map, const Numbers& displacement_m) {
  std::vector<double> found;
  found.reserve(values(displacement_m).size());
  for (const double value : values(displacement_m)) found.push_back(map.relative_friction(value));
  return array(std::move(found));
}

void add_friction(py::module_& module) {
  py::class_<FrictionMap>(module, "FrictionMap",
                          "Vibration amplitude to friction, relative to the surface at rest.")
      .def(py::init<>(), "The illustrative load-sharing model; live sessions need a measured table.")
      .def(py::init([](const Numbers& displacement_m, const Numbers& relative_friction) {
             if (displacement_m.size() != relative_friction.size())
               throw std::invalid_argument("displacement_m and relative_friction differ in length");
             std::vector<FrictionPoint> table;
             for (py::ssize_t i = 0; i < displacement_m.size(); ++i)
               table.push_back({displacement_m.data()[i], relative_friction.data()[i]});
             return FrictionMap(std::move(table));
           }),
           py::arg("displacement_m"), py::arg("relative_friction"),
           "A measured table that starts at (0, 1) and falls strictly.")
      .def("relative_friction", &frictions, py::arg("displacement_m"),
           "Relative friction for peak displacements in m.")
      .def("displacement_m", &FrictionMap::displacement_m, py::arg("relative_friction"),
           "The displacement that gives this friction, m; None below the lowest friction.")
      .def_property_readonly("lowest_friction", &FrictionMap::lowest_friction)
      .def_property_readonly("illustrative", &FrictionMap::illustrative);
  module.def(
      "fingertip_average",
      [](const Numbers& x_m, const Numbers& quantity, double fingertip_m) {
        return array(fingertip_average(values(x_m), values(quantity), fingertip_m));
      },
      py::arg("x_m"), py::arg("values"), py::arg("fingertip_m"),
      "Averages samples over a fingertip centred at each x; the x must ascend.");
}

void add_zones(py::module_& module) {
  record<ToneBand>(module, "ToneBand", "The frequencies that may be used.")
      .def_readwrite("low_Hz", &ToneBand::low_Hz)
      .def_readwrite("high_Hz", &ToneBand::high_Hz)
      .def_readwrite("spacing_Hz", &ToneBand::spacing_Hz, "smallest difference between two tones, Hz");
  record<ZoneRequest>(module, "ZoneRequest", "A zone of uniform friction.")
      .def_readwrite("from_m", &ZoneRequest::from_m)
      .def_readwrite("boundary_m", &ZoneRequest::boundary_m)
      .def_readwrite("edge", &ZoneRequest::edge)
      .def_readwrite("friction", &ZoneRequest::friction, "mean relative friction")
      .def_readwrite("tones", &ZoneRequest::tones, "largest number of tones")
      .def_readwrite("band", &ZoneRequest::band)
      .def_readwrite("fingertip_m", &ZoneRequest::fingertip_m);
  py::class_<ZoneDesign>(module, "ZoneDesign", "Tones that produce a zone.")
      .def_readonly("tones", &ZoneDesign::tones)
      .def_readonly("boundary_m", &ZoneDesign::boundary_m)
      .def_readonly("friction", &ZoneDesign::friction)
      .def_readonly("residual", &ZoneDesign::residual)
      .def_readonly("node_fill", &ZoneDesign::node_fill)
      .def_readonly("peak_displacement_m", &ZoneDesign::peak_displacement_m)
      .def_readonly("crest_factor", &ZoneDesign::crest_factor)
      .def_readonly("reason", &ZoneDesign::reason)
      .def_readonly("warnings", &ZoneDesign::warnings);
  py::class_<ProfileDesign>(module, "ProfileDesign", "Tones that come closest to a profile of amplitude.")
      .def_readonly("tones", &ProfileDesign::tones)
      .def_readonly("residual", &ProfileDesign::residual)
      .def_readonly("reachable", &ProfileDesign::reachable)
      .def_readonly("verdict", &ProfileDesign::verdict);
  module.def("design_zone", &design_zone, py::arg("surface"), py::arg("friction"), py::arg("request"),
             py::call_guard<py::gil_scoped_release>(), "Finds tones that give a zone of uniform friction.");
  module.def(
      "design_profile",
      [](const Surface& surface, const Numbers& x_m, const Numbers& amplitude_m, const ToneBand& band) {
        if (x_m.size() != amplitude_m.size())
          throw std::invalid_argument("x_m and amplitude_m differ in length");
        std::vector<ProfilePoint> target;
        for (py::ssize_t i = 0; i < x_m.size(); ++i) target.push_back({x_m.data()[i], amplitude_m.data()[i]});
        return design_profile(surface, target, band);
      },
      py::arg("surface"), py::arg("x_m"), py::arg("amplitude_m"), py::arg("band") = ToneBand{},
      "Finds tones that come closest to amplitudes in m at the positions x_m.");
}

}  // namespace

void add_design(py::module_& module) {
  add_friction(module);
  add_zones(module);
  module.def(
      "assign_phases",
      [](std::vector<Tone> tones) {
        assign_phases(tones);
        return tones;
      },
      py::arg("tones"), "The tones with phases that give a low crest factor.");
  module.def(
      "crest_factor", [](const std::vector<Tone>& tones) { return crest_factor(tones); }, py::arg("tones"),
      "Peak of the summed waveform divided by its root mean square.");
  module.def(
      "loudest_sound_dB",
      [](const Surface& surface, const Tone& tone, double distance_m, Model model) {
        return loudest_sound(surface, tone, model, distance_m).level_dB;
      },
      py::arg("surface"), py::arg("tone"), py::arg("distance_m"), py::arg("model") = Model::mode,
      "The highest sound level at this distance from the centre line, dB re 20 uPa rms.");
}

}  // namespace turnpoint::physics::python
