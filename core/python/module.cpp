// The extension freeplay._core: what the Python files of the package stand on. Nothing in it computes.
#include <algorithm>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "base/caught_error.h"
#include "base/option_value.h"
#include "base/processors.h"
#include "base/version.h"
#include "component/json_schema.h"
#include "contract/sample_layout.h"
#include "contract/type_list.h"
#include "freeplay/plugin.h"
#include "load/plugins.h"
#include "python/asked_analysis.h"
#include "python/default_arithmetic.h"
#include "python/kept_run.h"
#include "python/opened_model.h"
#include "python/refusal.h"
#include "python/stored_result.h"

namespace freeplay {
namespace {

namespace py = pybind11;
using Opened = std::shared_ptr<OpenedModel>;
using Kept = std::shared_ptr<KeptRun>;

/// While the core works: other threads of Python go on, and numbers are those of the command line.
struct Away {
  py::gil_scoped_release released;
  DefaultArithmetic arithmetic;
};

/// Signals and the caller's function, between steps. What these raise waits until the core has come back.
class Pulse {
 public:
  explicit Pulse(py::object progress) : progress_(std::move(progress)) {}

  bool operator()(double t, long steps) {
    const py::gil_scoped_acquire held;
    if (PyErr_CheckSignals() != 0) {
      raised_.emplace();
      return false;
    }
    if (progress_.is_none()) return true;
    try {
      progress_(t, steps);
    } catch (py::error_already_set& error) {
      raised_ = std::move(error);
      return false;
    }
    return true;
  }

  /// Null where nothing was raised.
  py::object raised() const { return raised_ ? py::object(raised_->value()) : py::object(py::none()); }

 private:
  py::object progress_;
  std::optional<py::error_already_set> raised_;
};

py::object python_of(const Json& json) {
  return py::module_::import("json").attr("loads")(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

/// Raises the class of the exit code, with messages and text.
void raise(const Refusal& refusal) {
  const py::object error = py::module_::import("freeplay._errors")
                               .attr("refused")(refusal.exit_code(), python_of(refusal.messages()), refusal.text());
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
}

void translate(std::exception_ptr pointer) {
  try {
    std::rethrow_exception(pointer);
  } catch (const Refusal& refusal) {
    raise(refusal);
  } catch (const Error& error) {
    raise(Refusal(error));
  } catch (const std::bad_alloc&) {
    throw;  // MemoryError
  } catch (const py::builtin_exception&) {
    throw;
  } catch (const std::exception& exception) {
    raise(Refusal(error_of(exception)));
  }
}

/// Read-only, and alive as long as `owner` is needed.
py::array numbers(const double* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
                  const py::object& owner) {
  py::array_t<double> array(std::move(shape), std::move(strides), data, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

py::array block_of(const ColumnBlock& block, const py::object& owner) {
  constexpr auto size = static_cast<py::ssize_t>(sizeof(double));
  return numbers(block.data(), {static_cast<py::ssize_t>(block.rows()), static_cast<py::ssize_t>(block.columns())},
                 {size, size * static_cast<py::ssize_t>(block.room())}, owner);
}

/// Names, units, words of events.
py::dict layout_of(const RecordLayout& layout) {
  py::list names, units, events;
  for (const RecordColumn& column : layout.columns) {
    names.append(column.name);
    units.append(column.unit);
  }
  for (const RecordColumn& column : layout.events) events.append(column.name);
  py::dict out;
  out["names"] = names;
  out["units"] = units;
  out["events"] = events;
  out["joints"] = layout.joints;
  out["kinds"] = layout.kinds;
  return out;
}

/// (count, columns), read-only.
py::array events_of(const std::vector<double>& events, const RecordLayout& layout, const py::object& owner) {
  const auto width = static_cast<py::ssize_t>(layout.events.size());
  constexpr auto size = static_cast<py::ssize_t>(sizeof(double));
  const py::ssize_t count = width > 0 ? static_cast<py::ssize_t>(events.size()) / width : 0;
  return numbers(events.data(), {count, width}, {size * width, size}, owner);
}

OpenRequest request_of_dict(const py::dict& options) {
  OpenRequest request;
  const auto text = [&](const char* name, std::string& to) {
    if (options.contains(name)) to = options[name].cast<std::string>();
  };
  const auto list = [&](const char* name, std::vector<std::string>& to) {
    if (options.contains(name)) to = options[name].cast<std::vector<std::string>>();
  };
  if (options.contains("text")) request.text = options["text"].cast<std::string>();
  text("file", request.file);
  text("end", request.words.end);
  text("step", request.words.step);
  text("accuracy", request.words.accuracy);
  text("interval", request.words.interval);
  text("integrator", request.words.integrator);
  text("format", request.words.format);
  list("channels", request.words.channels);
  list("set", request.words.model_options.set);
  list("ideal", request.words.model_options.ideal);
  list("plugins", request.plugins);
  if (options.contains("strict")) request.strict = options["strict"].cast<bool>();
  if (options.contains("allow_plugins")) request.allow_plugins = options["allow_plugins"].cast<bool>();
  return request;
}

Opened open_model(const py::dict& options) {
  OpenRequest request = request_of_dict(options);
  const Away away;
  return std::make_shared<OpenedModel>(std::move(request));
}

py::object check_model(const py::dict& options) {
  OpenRequest request = request_of_dict(options);
  Json messages;
  {
    const Away away;
    messages = OpenedModel::check(std::move(request));
  }
  return python_of(messages);
}

template <class Result>
auto answer(Result (OpenedModel::*question)() const) {
  return [question](const OpenedModel& model) {
    std::optional<Result> result;
    {
      const Away away;
      result.emplace((model.*question)());
    }
    if constexpr (std::is_same_v<Result, Json>) {
      return python_of(*result);
    } else {
      return std::move(*result);
    }
  };
}

py::dict facts_of(const OpenedModel& opened) {
  const Model& model = opened.model();
  const auto names = [](const auto& elements) {
    py::list list;
    for (const auto& element : elements) list.append(element.name);
    return py::tuple(list);
  };
  py::list channels;
  for (const ChannelInfo& channel : opened.channels().all()) {
    channels.append(py::make_tuple(channel.name, std::string(channel.unit)));
  }
  py::dict out;
  out["name"] = model.name;
  out["file"] = model.file;
  out["text"] = py::bytes(model.text);
  out["space"] = model.space == Space::planar ? "planar" : "spatial";
  out["bodies"] = names(model.bodies);
  py::list joints;
  for (const JointElement& joint : model.joints) {
    if (!joint.is_force) joints.append(joint.name);
  }
  out["joints"] = py::tuple(joints);
  out["drivers"] = names(model.drivers);
  py::dict parameters;
  for (const auto& pair : model.parameters) parameters[py::str(pair.first)] = pair.second.value;
  out["parameters"] = parameters;
  out["channels"] = channels;
  out["format"] = model.settings.format == ResultFormat::csv    ? "csv"
                  : model.settings.format == ResultFormat::hdf5 ? "hdf5"
                                                                : "both";
  out["end"] = model.settings.end;
  out["messages"] = python_of(opened.messages());
  out["remarks"] = opened.remarks();
  return out;
}

py::tuple run_kept(const Opened& model, const py::object& out, bool force, bool profile, const std::string& call,
                   const py::object& progress) {
  RunRequest request{.out = std::nullopt, .force = force, .profile = profile, .call = call};
  if (!out.is_none()) request.out = out.cast<std::string>();
  Pulse pulse(progress);
  Kept run;
  {
    const Away away;
    run = run_model(model, request, [&](double t, long steps) { return pulse(t, steps); });
  }
  return py::make_tuple(run, pulse.raised());
}

void save_kept(const KeptRun& run, const std::string& path, bool force, const std::string& format) {
  const Away away;
  const auto found = std::ranges::find(result_formats, format, [](const char* word) { return std::string(word); });
  if (found == std::end(result_formats)) {
    throw Error(Error::Category::usage, "bad-value",
                "bad value '" + format + "' of --format: it must be csv, hdf5 or both");
  }
  save_run(run, path, force, static_cast<ResultFormat>(found - std::begin(result_formats)));
}

py::dict read_stored(const std::string& path, const std::vector<std::string>& channels) {
  auto stored = std::make_shared<StoredResult>();
  {
    const Away away;
    *stored = read_result(path, channels);
  }
  const py::capsule owner(new std::shared_ptr<StoredResult>(stored),
                          [](void* held) { delete static_cast<std::shared_ptr<StoredResult>*>(held); });
  py::dict out = layout_of(stored->layout);
  out["data"] = block_of(*stored->block, owner);
  out["event_numbers"] = events_of(stored->events, stored->layout, owner);
  out["summary"] = python_of(stored->summary);
  out["directory"] = stored->directory;
  return out;
}

py::dict compare_stored(const std::string& a, const std::string& b, double tolerance, double absolute,
                        const std::vector<std::string>& channels, double from, double until) {
  std::vector<std::string> notes;
  Comparison comparison;
  {
    const Away away;
    comparison = compare_results(
        a, b, {.relative = tolerance, .absolute = absolute, .channels = channels, .from = from, .until = until}, notes);
  }
  py::list rows;
  const auto add = [&](const Difference& d) {
    rows.append(py::make_tuple(d.name, d.largest, d.relative, d.rms, d.at_time, d.agrees ? 1.0 : 0.0));
  };
  for (const Difference& difference : comparison.channels) add(difference);
  for (const Difference& difference : comparison.distances) add(difference);
  py::dict out;
  out["rows"] = rows;
  out["agree"] = comparison.agree();
  out["compared"] = comparison.rows;
  out["notes"] = notes;
  return out;
}

py::tuple analyse_words(const Opened& model, const py::dict& options) {
  AnalysisWords words;
  const auto text = [&](const char* name, std::string& to) {
    if (options.contains(name)) to = options[name].cast<std::string>();
  };
  const auto list = [&](const char* name, std::vector<std::string>& to) {
    if (options.contains(name)) to = options[name].cast<std::vector<std::string>>();
  };
  text("kind", words.kind);
  text("frame", words.frame);
  text("time", words.time);
  text("elbow", words.elbow);
  text("samples", words.samples);
  text("seed", words.seed);
  text("distribution", words.distribution);
  text("preload", words.preload);
  list("grid", words.grid);
  list("pose", words.pose);
  list("input", words.input);
  if (options.contains("sensitivity")) words.sensitivity = options["sensitivity"].cast<bool>();
  if (options.contains("branches")) words.branches = options["branches"].cast<bool>();
  Pulse pulse{py::none()};
  std::optional<AskedAnalysis> result;
  std::string csv;
  try {
    const Away away;
    result = analyse_model(*model, words, processor_count(), [&] { return pulse(0.0, 0); });
    csv = result->table.csv();
  } catch (const AnalysisStopped&) {
    return py::make_tuple(py::none(), pulse.raised());
  }
  py::list columns;
  for (std::size_t i = 0; i < result->table.columns.size(); ++i) {
    py::list cells;
    for (const auto& row : result->table.rows) cells.append(py::cast(row[i]));
    columns.append(cells);
  }
  py::dict out;
  out["names"] = result->table.columns;
  out["columns"] = columns;
  out["rows"] = result->table.rows.size();
  out["summary"] = python_of(result->table.summary);
  out["warnings"] = result->warnings;
  out["csv"] = csv;
  return py::make_tuple(out, py::none());
}

/// What `describe`, `list` and `schema` print, of the built-in types and of installed plugins.
py::object of_types(const std::function<Json(const Registry&)>& question) {
  Json json;
  {
    const Away away;
    json = question(load_registry({}, nullptr));
  }
  return python_of(json);
}

py::object list_types(const std::string& kind) {
  require_listed(kind);
  return of_types([&](const Registry& registry) { return type_entries(registry, kind); });
}

py::object describe_type(const std::string& name) {
  return of_types([&](const Registry& registry) {
    const Json found = described_types(registry, name);
    return found.size() == 1 ? found.front() : found;
  });
}

py::object schema_of(const std::string& kind) {
  require_word("schema", kind, {"model", "summary", "study"});
  if (kind == "summary") return python_of(summary_schema());
  return of_types([&](const Registry& registry) {
    const Json model = model_schema(registry, force_types(registry));
    return kind == "study" ? study_schema(model) : model;
  });
}

}  // namespace
}  // namespace freeplay

PYBIND11_MODULE(_core, module) {
  using namespace freeplay;
  py::register_local_exception_translator(&translate);
  module.attr("version") = program_version;
  module.attr("schema") = schema_version;
  module.attr("plugin_abi") = abi_version;
  module.attr("compiler") = compiler;
  module.attr("build") = FREEPLAY_BUILD;
  py::class_<OpenedModel, Opened>(module, "OpenedModel")
      .def("known", &facts_of)
      .def("facts", answer(&OpenedModel::facts))
      .def("start", answer(&OpenedModel::start))
      .def("tree", answer(&OpenedModel::tree))
      .def("svg", answer(&OpenedModel::svg));
  py::class_<KeptRun, Kept>(module, "KeptRun")
      .def("data", [](const py::object& self) { return block_of(self.cast<const KeptRun&>().rows->block(), self); })
      .def("event_numbers",
           [](const py::object& self) {
             const KeptRows& rows = *self.cast<const KeptRun&>().rows;
             return events_of(rows.events(), rows.layout(), self);
           })
      .def("layout", [](const KeptRun& run) { return layout_of(run.rows->layout()); })
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
  module.def("open_model", &open_model);
  module.def("check_model", &check_model);
  module.def("run", &run_kept);
  module.def("save", &save_kept);
  module.def("read", &read_stored);
  module.def("compare", &compare_stored);
  module.def("analyse", &analyse_words);
  module.def("types", &list_types);
  module.def("describe", &describe_type);
  module.def("schema_of", &schema_of);
}
