// What the files that bind the core to Python share.
#pragma once

#include <optional>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "base/json_text.h"
#include "python/column_block.h"
#include "python/default_arithmetic.h"
#include "python/opened_model.h"
#include "results/record.h"

namespace freeplay {

namespace py = pybind11;

/// While the core works: other threads of Python go on, and numbers are those of the command line.
struct [[gnu::visibility("hidden")]] Away {
  py::gil_scoped_release released;
  DefaultArithmetic arithmetic;
};

/// Signals and the caller's function, between steps. What these raise waits until the core has come back.
class [[gnu::visibility("hidden")]] Pulse {
 public:
  explicit Pulse(py::object progress) : progress_(std::move(progress)) {}

  bool operator()(double t, long steps);
  /// What was raised, once; None where nothing was.
  py::object raised();

 private:
  py::object progress_;
  std::optional<py::error_already_set> raised_;
};

py::object python_of(const Json& json);

/// Read-only, and alive as long as `owner` is needed.
py::array numbers(const double* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
                  const py::object& owner);
py::array block_of(const ColumnBlock& block, const py::object& owner);
/// Names, units, words of events.
py::dict layout_of(const RecordLayout& layout);
/// (count, columns), read-only.
py::array events_of(const std::vector<double>& events, const RecordLayout& layout, const py::object& owner);

/// What a dictionary of words asks for.
OpenRequest request_of_dict(const py::dict& options);

/// Runs, from begin to end and step by step.
void bind_runs(py::module_& module);
/// Many of them.
void bind_maps(py::module_& module);

}  // namespace freeplay
