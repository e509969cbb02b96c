// What the files that bind the core to Python share.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include <cxxabi.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <unistd.h>

#include "base/json_text.h"
#include "python/column_block.h"
#include "python/default_arithmetic.h"
#include "python/opened_model.h"
#include "results/record.h"

namespace freeplay {

namespace py = pybind11;

/// What waits for the interpreter. A thread that it does not wait for at its own end stays here then, until the process
/// ends: the interpreter would take it down through functions of the core, which end the process by that, or touch what
/// is no more.
template <class Call>
auto while_interpreter_lives(const Call& call) {
  try {
    return call();
  } catch (const ::abi::__forced_unwind&) {
    for (;;) ::pause();
  }
}

/// While the core works: other threads of Python go on, and numbers are those of the command line.
class [[gnu::visibility("hidden")]] Away {
 public:
  Away() : thread_(PyEval_SaveThread()), arithmetic_(std::in_place) {}
  ~Away() {
    arithmetic_.reset();
    while_interpreter_lives([&] { PyEval_RestoreThread(thread_); });
  }
  Away(const Away&) = delete;
  Away& operator=(const Away&) = delete;

 private:
  PyThreadState* thread_;
  std::optional<DefaultArithmetic> arithmetic_;
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

/// What a function of Python gives.
py::object called(const py::object& function, const py::tuple& arguments);

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
