#pragma once
// NumPy arrays that share memory with C++.
#include <pybind11/numpy.h>

#include <string>
#include <utility>
#include <vector>

namespace turnpoint::physics::python {

namespace py = pybind11;

// Refuses NumPy 2 if this module was built with a pybind11 below 2.12, whose arrays NumPy 2 reads wrongly:
// all elements would have the value of the first one. Throws ImportError. Without NumPy, nothing is refused.
inline void require_suitable_numpy() {
#if PYBIND11_VERSION_HEX < 0x020C0000
  std::string version;
  try {
    version = py::str(py::module_::import("numpy").attr("__version__"));
  } catch (const py::error_already_set&) {
    return;
  }
  if (version.starts_with("0.") || version.starts_with("1.")) return;
  throw py::import_error(
      "this module was built for NumPy 1, and NumPy " + version +
      " would read its arrays wrongly: use NumPy below 2, or a wheel, which is built with pybind11 "
      "2.12 or newer");
#endif
}

// Returns an array that takes over the memory of `values`.
template <class Value>
py::array_t<Value> array(std::vector<Value>&& values) {
  auto* kept = new std::vector<Value>(std::move(values));
  const py::capsule owner(kept, [](void* pointer) { delete static_cast<std::vector<Value>*>(pointer); });
  return py::array_t<Value>(static_cast<py::ssize_t>(kept->size()), kept->data(), owner);
}

// Returns a read-only array that shows `values`, a member of the Python object `owner`, which it keeps alive.
template <class Value>
py::array_t<Value> view(const std::vector<Value>& values, const py::handle& owner) {
  py::array_t<Value> shown(static_cast<py::ssize_t>(values.size()), values.data(), owner);
  shown.attr("setflags")(py::arg("write") = false);
  return shown;
}

}  // namespace turnpoint::physics::python
