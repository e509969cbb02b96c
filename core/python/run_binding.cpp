// Runs for Python: from begin to end, and step by step.
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include "python/binding.h"
#include "python/resumed_run.h"
#include "python/stepped_run.h"
#include "python/stored_result.h"
#include "report/report.h"

namespace freeplay {
namespace {

using Opened = std::shared_ptr<OpenedModel>;
using Kept = std::shared_ptr<KeptRun>;

RunRequest request_of(const py::dict& words) {
  RunRequest request;
  const auto text = [&](const char* name, std::string& to) {
    if (words.contains(name)) to = words[name].cast<std::string>();
  };
  const auto flag = [&](const char* name, bool& to) {
    if (words.contains(name)) to = words[name].cast<bool>();
  };
  if (words.contains("out")) request.out = words["out"].cast<std::string>();
  if (words.contains("state")) request.state = words["state"].cast<std::string>();
  text("call", request.call);
  text("inputs", request.inputs);
  text("repeat", request.repeat);
  text("seed", request.seed);
  text("checkpoint", request.checkpoint);
  flag("force", request.force);
  flag("profile", request.profile);
  flag("verify", request.verify);
  flag("twin", request.twin);
  flag("report", request.report);
  return request;
}

/// The page of a result, at `file` or in its directory.
std::string write_page(const std::string& result, const std::string& file, const LoadOptions& load) {
  ReportRequest page;
  page.results = {result};
  page.out = file;
  page.build = FREEPLAY_BUILD;
  page.load = load;
  return write_report(page).file;
}

Kept run_whole(const Opened& model, const RunRequest& request, const RunTick& tick) {
  OngoingRun run(model, request, tick);
  run.run_to_end();
  Kept ended = run.finish();
  if (request.report && ended->exit_code != 6) {
    write_page(request.out->string(), "", {model->request().load});
  }
  return ended;
}

py::tuple run_kept(const Opened& model, const py::dict& words, const py::object& progress) {
  const RunRequest request = request_of(words);
  Pulse pulse(progress);
  Kept ended;
  {
    const Away away;
    ended = run_whole(model, request, [&](double t, long steps) { return pulse(t, steps); });
  }
  return py::make_tuple(ended, pulse.raised());
}

/// None where there is nothing to do. `begun` gets the end of the run [s].
py::tuple resume_kept(const std::string& path, const std::string& end, bool allow_plugins, const py::dict& words,
                      const py::object& begun, const py::object& progress) {
  RunRequest request = request_of(words);
  Pulse pulse(progress);
  Kept ended;
  Resumption resumption;
  Opened model;
  {
    const Away away;
    resumption = read_resumption(path, end);
    if (resumption.nothing_to_do.empty()) model = model_of(resumption, allow_plugins);
  }
  if (model) {
    begun(model->model().settings.end);
    go_on_with(resumption, path, request);
    const Away away;
    ended = run_whole(model, request, [&](double t, long steps) { return pulse(t, steps); });
  }
  return py::make_tuple(ended, pulse.raised());
}

std::string report_on(const std::string& result, const std::string& file) {
  const Away away;
  return write_page(result, file, {});
}

/// None where no word says it.
std::optional<ResultFormat> format_of(const std::optional<std::string>& word) {
  if (!word) return std::nullopt;
  const auto found = std::ranges::find(result_formats, *word, [](const char* known) { return std::string(known); });
  if (found == std::end(result_formats)) {
    throw Error(Error::Category::usage, "bad-value",
                "bad value '" + *word + "' of --format: it must be csv, hdf5 or both");
  }
  return static_cast<ResultFormat>(found - std::begin(result_formats));
}

void save_kept(const KeptRun& run, const std::string& path, bool force, const std::optional<std::string>& format) {
  const Away away;
  save_run(run, path, force, format_of(format).value_or(run.model->model().settings.format));
}

void save_again(const StoredResult& result, const std::string& path, bool force,
                const std::optional<std::string>& format) {
  const Away away;
  save_stored(result, path, force, format_of(format));
}

/// A run step by step with the caller's function. For one thread at a time.
class [[gnu::visibility("hidden")]] BoundRun {
 public:
  BoundRun(const Opened& model, const RunRequest& request, py::object progress) : pulse_(std::move(progress)) {
    const Away away;
    run_.emplace(model, request, [this](double t, long steps) { return pulse_(t, steps); });
  }

  /// The time reached; NaN once the run is over.
  double advance(double until, long rows, long steps) {
    const Turn turn(*run_);
    const Away away;
    const bool going = run_->advance({.until = until, .rows = rows, .steps = steps});
    return going ? run_->run().time() : std::numeric_limits<double>::quiet_NaN();
  }

  void close() {
    const Turn turn(*run_);
    const Away away;
    run_->close();
  }

  py::bytes checkpoint() {
    const Turn turn(*run_);
    std::string bytes;
    {
      const Away away;
      bytes = run_->checkpoint();
    }
    return bytes;
  }

  void interrupt() { run_->interrupt(); }

  void set(std::size_t input, double effort) {
    const Turn turn(*run_);
    const Away away;
    run_->set(input, effort);
  }

  double value(std::size_t place) {
    const Turn turn(*run_);
    const DefaultArithmetic arithmetic;
    return run_->row(false).at(place);
  }

  static py::array row(const py::object& self) {
    auto& bound = self.cast<BoundRun&>();
    const Turn turn(*bound.run_);
    const DefaultArithmetic arithmetic;
    const std::vector<double>& row = bound.run_->row(true);
    return numbers(row.data(), {static_cast<py::ssize_t>(row.size())}, {sizeof(double)}, self);
  }

  double time() {
    const Turn turn(*run_);
    return run_->run().time();
  }

  long steps() {
    const Turn turn(*run_);
    return run_->run().steps();
  }

  std::vector<double> efforts() {
    const Turn turn(*run_);
    return run_->run().efforts();
  }

  /// None until the run is over.
  Kept ended() {
    const Turn turn(*run_);
    return run_->ended();
  }

  py::object raised() { return pulse_.raised(); }

  /// Rows and events up to now, as of a result.
  py::dict record() {
    const Turn turn(*run_);
    const auto record = std::make_shared<KeptRecord>(run_->run().record());
    const py::capsule owner(new std::shared_ptr<KeptRecord>(record),
                            [](void* held) { delete static_cast<std::shared_ptr<KeptRecord>*>(held); });
    py::dict out = layout_of(record->layout);
    out["data"] = block_of(record->block, owner);
    out["event_numbers"] = events_of(record->events, record->layout, owner);
    return out;
  }

  py::dict layout() { return layout_of(run_->run().record().layout); }

 private:
  /// Raises RuntimeError where another thread is at work with it.
  struct Turn : SteppedRun::Turn {
    explicit Turn(SteppedRun& run) : SteppedRun::Turn(run) {
      if (good()) return;
      PyErr_SetString(PyExc_RuntimeError, "another thread, or a function called during a step, uses this simulation");
      throw py::error_already_set();
    }
  };

  Pulse pulse_;
  std::optional<SteppedRun> run_;
};

}  // namespace

void bind_runs(py::module_& module) {
  py::class_<KeptRun, Kept>(module, "KeptRun")
      .def("data", [](const py::object& self) { return block_of(self.cast<const KeptRun&>().record.block, self); })
      .def("event_numbers",
           [](const py::object& self) {
             const KeptRecord& record = self.cast<const KeptRun&>().record;
             return events_of(record.events, record.layout, self);
           })
      .def("layout", [](const KeptRun& run) { return layout_of(run.record.layout); })
      .def("summary", [](const KeptRun& run) { return python_of(run.summary); })
      .def_readonly("status", &KeptRun::status)
      .def_readonly("reason", &KeptRun::reason)
      .def_readonly("exit_code", &KeptRun::exit_code)
      .def_readonly("warnings", &KeptRun::warnings)
      .def("profile", [](const KeptRun& run) {
        py::dict out;
        for (const KeptRun::PhaseTime& time : run.profile) {
          out[py::str(time.phase)] = py::make_tuple(time.seconds, time.count);
        }
        return out;
      });
  py::class_<BoundRun>(module, "SteppedRun")
      .def("advance", &BoundRun::advance)
      .def("close", &BoundRun::close)
      .def("checkpoint", &BoundRun::checkpoint)
      .def("interrupt", &BoundRun::interrupt)
      .def("set", &BoundRun::set)
      .def("value", &BoundRun::value)
      .def("row", &BoundRun::row)
      .def("time", &BoundRun::time)
      .def("steps", &BoundRun::steps)
      .def("efforts", &BoundRun::efforts)
      .def("ended", &BoundRun::ended)
      .def("raised", &BoundRun::raised)
      .def("record", &BoundRun::record)
      .def("layout", &BoundRun::layout);
  module.def("run", &run_kept);
  module.def("resume", &resume_kept);
  module.def("report", &report_on);
  module.def("begin", [](const Opened& model, const py::dict& words, const py::object& progress) {
    RunRequest request = request_of(words);
    request.stepped = true;
    return std::make_unique<BoundRun>(model, request, progress);
  });
  module.def("save", &save_kept);
  module.def("save", &save_again);
}

}  // namespace freeplay
