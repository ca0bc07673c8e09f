#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "physics/python/array.hpp"
#include "station/collector/postgres.hpp"
#include "station/python/tables.hpp"
#include "station/store/error.hpp"

namespace turnpoint::python {

namespace py = pybind11;

namespace {

using physics::python::array;
using store::Cell;
using Cells = std::vector<Cell>;

bool missing(const Cell& cell) { return std::holds_alternative<std::monostate>(cell); }
bool whole(const Cell& cell) { return std::holds_alternative<std::int64_t>(cell); }
bool text(const Cell& cell) { return std::holds_alternative<std::string>(cell); }

double number(const Cell& cell) {
  if (const auto* integer = std::get_if<std::int64_t>(&cell)) return static_cast<double>(*integer);
  if (const auto* real = std::get_if<double>(&cell)) return *real;
  return std::numeric_limits<double>::quiet_NaN();
}

py::object python_object(const Cell& cell) {
  if (missing(cell)) return py::none();
  return std::visit(
      [](const auto& value) -> py::object {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::monostate>)
          return py::none();
        else
          return py::cast(value);
      },
      cell);
}

/// Converts a column: to a list if it contains a text, to an array of integers if no value is missing,
/// otherwise to an array of doubles.
py::object column(const Cells& cells) {
  if (std::any_of(cells.begin(), cells.end(), text)) {
    py::list objects;
    for (const auto& cell : cells) objects.append(python_object(cell));
    return objects;
  }
  if (!cells.empty() && std::all_of(cells.begin(), cells.end(), whole)) {
    std::vector<std::int64_t> integers;
    for (const auto& cell : cells) integers.push_back(std::get<std::int64_t>(cell));
    return array(std::move(integers));
  }
  std::vector<double> numbers;
  for (const auto& cell : cells) numbers.push_back(number(cell));
  return array(std::move(numbers));
}

py::dict columns(const MemoryTable& table) {
  py::dict all;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    all[py::str(table.columns[c])] = column(table.cells[c]);
  return all;
}

py::list tables(const std::string& database, const std::string& session, const std::string& participant,
                const std::string& protocol) {
  std::vector<ProtocolTables> read;
  {
    const py::gil_scoped_release other_threads_run;
    read = read_tables(database, {session, participant, protocol});
  }
  py::list list;
  for (const auto& one : read) {
    py::dict named;
    named["trials"] = columns(one.trials);
    named["intervals"] = columns(one.intervals);
    named["events"] = columns(one.events);
    named["sessions"] = columns(one.sessions);
    named["self_tests"] = columns(one.self_tests);
    named["answers"] = columns(one.answers);
    named["friction_tables"] = columns(one.friction_tables);
    named["programs"] = columns(one.programs);
    named["estimates"] = columns(one.estimates);
    list.append(named);
  }
  return list;
}

py::list signals(const std::string& database, const std::string& session, const std::string& participant,
                 const std::string& protocol, const std::string& stream) {
  std::vector<SignalTable> read;
  {
    const py::gil_scoped_release other_threads_run;
    read = read_signals(database, {session, participant, protocol}, stream);
  }
  py::list list;
  for (auto& one : read) {
    py::dict named;
    named["session_id"] = one.session_id;
    named["stream"] = one.stream;
    named["trial_index"] = array(std::move(one.trial_index));
    named["segment_id"] = array(std::move(one.segment_id));
    named["time_s"] = array(std::move(one.time_s));
    for (std::size_t c = 0; c < one.channels.size(); ++c)
      named[py::str(one.channels[c])] = array(std::move(one.values[c]));
    list.append(named);
  }
  return list;
}

}  // namespace

}  // namespace turnpoint::python

PYBIND11_MODULE(_store, module) {
  namespace py = pybind11;
  turnpoint::physics::python::require_suitable_numpy();
  module.doc() =
      "Reads databases of stations and collectors. Use turnpoint.read() and turnpoint.read_signals().";
  static const py::exception<turnpoint::store::StoreError> store_error(module, "StoreError",
                                                                       PyExc_RuntimeError);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const turnpoint::store::StoreError& error) {
      const bool missing = error.kind() == turnpoint::store::ErrorKind::missing;
      PyErr_SetString(missing ? PyExc_LookupError : store_error.ptr(), error.what());
    } catch (const turnpoint::collector::ServerError& error) {
      PyErr_SetString(store_error.ptr(), error.what());
    }
  });
  const auto define = [&](const char* name, auto function, const auto&... more) {
    module.def(name, function, py::arg("database"), py::arg("session"), py::arg("participant"),
               py::arg("protocol"), more...);
  };
  define("tables", &turnpoint::python::tables);
  define("signals", &turnpoint::python::signals, py::arg("stream"));
}
