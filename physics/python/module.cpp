#include "physics/python/convert.hpp"

// std::invalid_argument and std::domain_error both become ValueError, the second one as its subclass
// Unreachable.
PYBIND11_MODULE(physics, module) {
  namespace py = pybind11;
  turnpoint::physics::python::require_suitable_numpy();
  module.doc() =
      "Waves on tapered friction displays: the physics library of Turnpoint. SI units; positions from the "
      "drive edge.";
  py::register_exception<std::domain_error>(module, "Unreachable", PyExc_ValueError).doc() =
      "A target that this surface cannot present, or a model that does not apply to it.";
  turnpoint::physics::python::add_surface(module);
  turnpoint::physics::python::add_field(module);
  turnpoint::physics::python::add_design(module);
  turnpoint::physics::python::add_map(module);
}
