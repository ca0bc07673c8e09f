#pragma once
// NumPy arrays that share memory with C++.
#include <pybind11/numpy.h>

#include <utility>
#include <vector>

namespace turnpoint::physics::python {

namespace py = pybind11;

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
