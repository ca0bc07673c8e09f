#pragma once
// Conversions between Python and the physics library: texts for enumerations and edges, arrays of numbers,
// and records whose fields are given by name.
#include <pybind11/complex.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "physics/boundary_budget.hpp"
#include "physics/edge.hpp"
#include "physics/field.hpp"
#include "physics/model.hpp"
#include "physics/python/array.hpp"
#include "physics/surface.hpp"

namespace turnpoint::physics::python {

// Numbers of the type double in one contiguous block. An array of this kind is used as it is; other numbers
// are copied.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

inline std::span<const double> values(const Numbers& numbers) {
  return {numbers.data(), static_cast<std::size_t>(numbers.size())};
}

template <class Value>
using Names = std::span<const std::pair<std::string_view, Value>>;

inline constexpr std::pair<std::string_view, Edges> edges_names[]{{"supported", Edges::supported},
                                                                  {"clamped", Edges::clamped}};
inline constexpr std::pair<std::string_view, Bending> bending_names[]{
    {"auto", Bending::automatic}, {"on", Bending::on}, {"off", Bending::off}};
inline constexpr std::pair<std::string_view, DriveShape> drive_names[]{{"cosine", DriveShape::cosine},
                                                                       {"piston", DriveShape::piston}};

template <class Value>
std::string_view name_in(Names<Value> names, Value value) {
  for (const auto& [text, known] : names)
    if (known == value) return text;
  throw std::logic_error("a value without a name");
}
template <class Value>
Value value_in(Names<Value> names, std::string_view text) {
  std::string allowed;
  for (const auto& [known, value] : names) {
    if (known == text) return value;
    allowed += (allowed.empty() ? "\"" : ", \"") + std::string(known) + "\"";
  }
  throw std::invalid_argument("\"" + std::string(text) + "\" is not one of " + allowed);
}

// Converts a value to the text that stands for it in Python (write), and back (read).
template <class Value>
struct Text;
template <>
struct Text<Edges> {
  static std::string write(Edges value) { return std::string(name_in<Edges>(edges_names, value)); }
  static Edges read(const std::string& text) { return value_in<Edges>(edges_names, text); }
};
template <>
struct Text<Bending> {
  static std::string write(Bending value) { return std::string(name_in<Bending>(bending_names, value)); }
  static Bending read(const std::string& text) { return value_in<Bending>(bending_names, text); }
};
template <>
struct Text<DriveShape> {
  static std::string write(DriveShape value) { return std::string(name_in<DriveShape>(drive_names, value)); }
  static DriveShape read(const std::string& text) { return value_in<DriveShape>(drive_names, text); }
};
template <>
struct Text<PlateTheory> {
  static std::string write(PlateTheory value) { return std::string(name(value)); }
  static PlateTheory read(const std::string& text) { return parse_plate_theory(text); }
};
template <>
struct Text<Model> {
  static std::string write(Model value) { return std::string(name(value)); }
  static Model read(const std::string& text) { return parse_model(text); }
};
template <>
struct Text<Normalise> {
  static std::string write(Normalise value) { return std::string(name(value)); }
  static Normalise read(const std::string& text) { return parse_normalise(text); }
};
template <>
struct Text<Parameter> {
  static std::string write(Parameter value) { return std::string(name(value)); }
  static Parameter read(const std::string& text) {
    if (const auto found = find_parameter(text)) return *found;
    throw std::invalid_argument("\"" + text +
                                "\" is not the name of a parameter, such as \"modulus\" or \"clamp line\"");
  }
};
template <>
struct Text<Edge> {
  static std::string write(const Edge& value) { return format(value); }
  static Edge read(const std::string& text) { return parse_edge(text); }
};

template <class Value>
struct TextCaster {
  PYBIND11_TYPE_CASTER(Value, py::detail::const_name("str"));
  bool load(py::handle source, bool) {
    if (!py::isinstance<py::str>(source)) return false;
    value = Text<Value>::read(source.cast<std::string>());
    return true;
  }
  static py::handle cast(const Value& from, py::return_value_policy, py::handle) {
    return py::str(Text<Value>::write(from)).release();
  }
};

// Defines a Python class whose fields can be given by name: Surface(density_kg_m3=8400, ...).
template <class Record>
py::class_<Record> record(py::module_& module, const char* type_name, const char* documentation) {
  const std::string type = type_name;
  return py::class_<Record>(module, type_name, documentation)
      .def(py::init([type](const py::kwargs& fields) {
        auto made = py::cast(Record{});
        for (const auto& [field, value] : fields) {
          if (!py::hasattr(made, field))
            throw py::type_error(type + " has no field " + std::string(py::repr(field)));
          py::setattr(made, field, value);
        }
        return made.template cast<Record>();
      }))
      .def("__copy__", [](const Record& self) { return Record(self); })
      .def("__deepcopy__", [](const Record& self, const py::dict&) { return Record(self); });
}

void add_surface(py::module_& module);
void add_field(py::module_& module);
void add_map(py::module_& module);
void add_design(py::module_& module);

}  // namespace turnpoint::physics::python

namespace pybind11::detail {
template <>
struct type_caster<turnpoint::physics::Edges>
    : turnpoint::physics::python::TextCaster<turnpoint::physics::Edges> {};
template <>
struct type_caster<turnpoint::physics::Bending>
    : turnpoint::physics::python::TextCaster<turnpoint::physics::Bending> {};
template <>
struct type_caster<turnpoint::physics::DriveShape>
    : turnpoint::physics::python::TextCaster<turnpoint::physics::DriveShape> {};
template <>
struct type_caster<turnpoint::physics::PlateTheory>
    : turnpoint::physics::python::TextCaster<turnpoint::physics::PlateTheory> {};
template <>
struct type_caster<turnpoint::physics::Model>
    : turnpoint::physics::python::TextCaster<turnpoint::physics::Model> {};
template <>
struct type_caster<turnpoint::physics::Normalise>
    : turnpoint::physics::python::TextCaster<turnpoint::physics::Normalise> {};
template <>
struct type_caster<turnpoint::physics::Parameter>
    : turnpoint::physics::python::TextCaster<turnpoint::physics::Parameter> {};
template <>
struct type_caster<turnpoint::physics::Edge>
    : turnpoint::physics::python::TextCaster<turnpoint::physics::Edge> {};
}  // namespace pybind11::detail
