#include "physics/field.hpp"

#include <memory>

#include "physics/finger.hpp"
#include "physics/planner.hpp"
#include "physics/python/convert.hpp"

namespace turnpoint::physics::python {

namespace {

using Tones = std::vector<Tone>;

std::unique_ptr<Field> evaluated(const Surface& surface, const Tones& tones, const Numbers& x_m, Model model,
                                 Normalise normalise) {
  const auto points = values(x_m);
  const py::gil_scoped_release other_threads_run;
  return std::make_unique<Field>(evaluate(surface, tones, points, model, normalise));
}

py::array_t<double> profile(const Surface& surface, const Tones& tones, const Numbers& x_m, Model model) {
  const auto points = values(x_m);
  std::vector<double> amplitudes;
  {
    const py::gil_scoped_release other_threads_run;
    amplitudes = amplitude_profile(surface, tones, points, model);
  }
  return array(std::move(amplitudes));
}

// Returns the mobility and displacements of finger_load(), one array for each quantity.
py::dict load(const Surface& surface, double frequency_Hz, const Numbers& x_m, const Finger& finger) {
  const auto points = values(x_m);
  std::vector<FingerLoad> loads;
  {
    const py::gil_scoped_release other_threads_run;
    loads = finger_load(surface, frequency_Hz, {points.begin(), points.end()}, finger);
  }
  std::vector<std::complex<double>> unloaded, loaded, mobility;
  std::vector<double> share;
  for (const auto& one : loads) {
    unloaded.push_back(one.unloaded);
    loaded.push_back(one.loaded);
    mobility.push_back(one.mobility_m_per_Ns);
    share.push_back(one.share(finger));
  }
  py::dict result;
  result["unloaded"] = array(std::move(unloaded));
  result["loaded"] = array(std::move(loaded));
  result["mobility_m_per_Ns"] = array(std::move(mobility));
  result["share"] = array(std::move(share));
  return result;
}

void add_results(py::module_& module) {
  py::class_<ToneInfo>(module, "ToneInfo",
                       "What a model predicts for one tone. A position is None if it does not exist.")
      .def_readonly("frequency_Hz", &ToneInfo::frequency_Hz)
      .def_readonly("turning_point_m", &ToneInfo::turning_point_m,
                    "where the local cut-off equals the frequency, m")
      .def_readonly("last_peak_m", &ToneInfo::last_peak_m, "outermost maximum of |v|, m")
      .def_readonly("gain", &ToneInfo::gain, "|v| at the last maximum divided by |v(0)|")
      .def_readonly("conditioning", &ToneInfo::conditioning,
                    "factor by which the division by v(0) amplifies rounding errors")
      .def_readonly("nearest_resonance_Hz", &ToneInfo::nearest_resonance_Hz, "set only by tone_info()")
      .def_readonly("no_peak_reason", &ToneInfo::no_peak_reason);
  py::class_<ToneField>(module, "ToneField", "The field of one tone at the points x_m of the call.")
      .def_readonly("info", &ToneField::info)
      .def_property_readonly(
          "v", [](const py::object& self) { return view(self.cast<const ToneField&>().v, self); },
          "complex displacement; the time factor is exp(+i omega t)")
      .def_property_readonly(
          "ln_amplitude",
          [](const py::object& self) { return view(self.cast<const ToneField&>().ln_amplitude, self); },
          "ln|v|, correct also where v underflows");
  py::class_<Field>(module, "Field", "The fields of all tones, and their sum.")
      .def_readonly("model", &Field::model)
      .def_readonly("normalise", &Field::normalise)
      .def_property_readonly(
          "tones",
          [](const py::object& self) {
            py::list tones;
            for (const auto& tone : self.cast<const Field&>().tones)
              tones.append(py::cast(&tone, py::return_value_policy::reference_internal, self));
            return tones;
          })
      .def_property_readonly(
          "amplitude", [](const py::object& self) { return view(self.cast<const Field&>().amplitude, self); },
          "root of the summed squares of |v| over tones")
      .def_property_readonly("ln_amplitude", [](const py::object& self) {
        return view(self.cast<const Field&>().ln_amplitude, self);
      });
  py::class_<FieldNotes>(module, "FieldNotes", "How far a field can be trusted.")
      .def_readonly("error_bound", &FieldNotes::error_bound, "error of |v|, relative to its largest value")
      .def_readonly("validity", &FieldNotes::validity)
      .def_readonly("warnings", &FieldNotes::warnings);
}

void add_planner(py::module_& module) {
  py::class_<RungEstimate>(module, "RungEstimate",
                           "The error bounds of a model, estimated before it is evaluated.")
      .def_readonly("model", &RungEstimate::model)
      .def_readonly("usable", &RungEstimate::usable)
      .def_readonly("boundary_bound_m", &RungEstimate::boundary_bound_m)
      .def_readonly("amplitude_bound", &RungEstimate::amplitude_bound)
      .def_readonly("level_bound_dB", &RungEstimate::level_bound_dB)
      .def_readonly("cost_s", &RungEstimate::cost_s)
      .def_readonly("reason", &RungEstimate::reason);
  py::class_<PlanChoice>(module, "PlanChoice", "The cheapest model within the tolerance.")
      .def_readonly("model", &PlanChoice::model)
      .def_readonly("bound", &PlanChoice::bound)
      .def_readonly("inside", &PlanChoice::inside)
      .def_readonly("reason", &PlanChoice::reason)
      .def_readonly("considered", &PlanChoice::considered);
  module.def(
      "choose_model",
      [](const Surface& surface, const Tones& tones, int points, const Edge& edge, Normalise normalise,
         std::optional<double> boundary_m, std::optional<double> amplitude, std::optional<double> level_dB) {
        return choose_model(surface, {tones, points, edge, normalise, {boundary_m, amplitude, level_dB}});
      },
      py::arg("surface"), py::arg("tones"), py::kw_only(), py::arg("points") = 0,
      py::arg("edge") = Edge::turning(), py::arg("normalise") = Normalise::peak,
      py::arg("boundary_m") = py::none(), py::arg("amplitude") = py::none(), py::arg("level_dB") = py::none(),
      "Chooses the cheapest model whose error bounds are within the tolerances: the error of the boundary "
      "(m), of |v|\n"
      "relative to its largest value, and of the level at the last maximum (dB). None tolerates any error.");
}

}  // namespace

void add_field(py::module_& module) {
  add_results(module);
  add_planner(module);
  module.def("evaluate", &evaluated, py::arg("surface"), py::arg("tones"), py::arg("x_m"),
             py::arg("model") = Model::mode, py::arg("normalise") = Normalise::drive,
             "The centre-line displacement at the points x_m, in any order. See Field.");
  module.def(
      "describe",
      [](const Surface& surface, const Tones& tones, const Field& field) {
        return describe(surface, tones, field);
      },
      py::arg("surface"), py::arg("tones"), py::arg("field"), py::call_guard<py::gil_scoped_release>(),
      "Error bound, validity and warnings of a field.");
  module.def("amplitude_profile", &profile, py::arg("surface"), py::arg("tones"), py::arg("x_m"),
             py::arg("model") = Model::mode,
             "Amplitude in m at each point: the root of the sum of |v|^2 over the tones.");
  module.def("tone_info", &tone_info, py::arg("surface"), py::arg("frequency_Hz"),
             py::arg("model") = Model::mode, "Positions and gain for one frequency, without a profile.");
  module.def("drive_amplitude_m", &drive_amplitude_m, py::arg("surface"), py::arg("frequency_Hz"),
             py::arg("displacement_m"), py::arg("model") = Model::mode,
             "The amplitude at the drive edge that gives this displacement at the last maximum, m.");
  record<Finger>(module, "Finger", "A fingertip as a mechanical impedance that presses evenly on a disc.")
      .def_readwrite("impedance_Ns_per_m", &Finger::impedance_Ns_per_m,
                     "force divided by velocity, N s/m, complex")
      .def_readwrite("contact_radius_m", &Finger::contact_radius_m, "m")
      .def_readwrite("beside_m", &Finger::beside_m, "distance of the disc's centre from the centre line, m");
  module.def("finger_load", &load, py::arg("surface"), py::arg("frequency_Hz"), py::arg("x_m"),
             py::arg("finger"),
             "Means over the disc under the finger, as arrays: unloaded, loaded (v(0) = 1), "
             "mobility_m_per_Ns, and share,\n"
             "the fraction of the amplitude that remains under the finger.");
}

}  // namespace turnpoint::physics::python
