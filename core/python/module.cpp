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
#include <pybind11/stl.h>

#include "base/caught_error.h"
#include "base/option_value.h"
#include "base/processors.h"
#include "base/version.h"
#include "component/json_schema.h"
#include "contract/sample_layout.h"
#include "contract/type_list.h"
#include "freeplay/plugin.h"
#include "load/input_file.h"
#include "load/plugins.h"
#include "python/asked_analysis.h"
#include "python/before_forks.h"
#include "python/binding.h"
#include "python/opened_model.h"
#include "python/refusal.h"
#include "python/stored_result.h"

namespace freeplay {
namespace {

using Opened = std::shared_ptr<OpenedModel>;

/// Raises the class of the exit code, with messages and text.
void raise(const Refusal& refusal) {
  const py::object error = called(py::module_::import("freeplay._errors").attr("refused"),
                                  py::make_tuple(refusal.exit_code(), python_of(refusal.messages()), refusal.text()));
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
}

void translate(std::exception_ptr pointer) {
  try {
    std::rethrow_exception(std::move(pointer));
  } catch (const Refusal& refusal) {
    raise(refusal);
  } catch (const Error& error) {
    raise(Refusal(error));
  } catch (const std::bad_alloc&) {
    PyErr_SetString(
        PyExc_MemoryError,
        "there is not enough memory: rows of a run take less with a longer interval or with fewer channels");
  } catch (const py::builtin_exception&) {
    throw;
  } catch (const std::exception& exception) {
    raise(Refusal(error_of(exception)));
  }
}

Opened open_model(const py::dict& options) {
  OpenRequest request = request_of_dict(options);
  const Away away;
  return std::make_shared<OpenedModel>(std::move(request));
}

py::object check_model(const py::dict& options) {
  const OpenRequest request = request_of_dict(options);
  Json messages;
  {
    const Away away;
    messages = OpenedModel::check(request);
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
  py::list inputs;  // names and units
  for (const int d : inputs_of(model)) {
    const Driver& driver = model.drivers[static_cast<std::size_t>(d)];
    inputs.append(py::make_tuple(driver.name, driver.kind == DriverKind::torque ? "N*m" : "N"));
  }
  out["inputs"] = inputs;
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

py::dict read_stored(const std::string& path, const std::vector<std::string>& channels) {
  auto stored = std::make_shared<StoredResult>();
  {
    const Away away;
    *stored = read_result(path, channels);
  }
  const py::object owner = py::cast(stored);
  py::dict out = layout_of(stored->layout);
  out["stored"] = owner;
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
  std::string drawn;
  text("map", drawn);
  const AskedMap map = drawn.empty() ? AskedMap::none : drawn == "grey" ? AskedMap::grey : AskedMap::coloured;
  Pulse pulse{py::none()};
  std::optional<AskedAnalysis> result;
  try {
    const Away away;
    result = analyse_model(*model, words, map, processor_count(), [&] { return pulse(0.0, 0); });
  } catch (const AnalysisStopped&) {
    return py::make_tuple(py::none(), pulse.raised());
  }
  auto* const held = new std::vector<AnalysedColumn>(std::move(result->columns));
  const py::capsule owner(held, [](void* pointer) { delete static_cast<std::vector<AnalysedColumn>*>(pointer); });
  py::dict columns;
  for (const AnalysedColumn& column : *held) {
    if (column.words.empty()) {
      columns[py::str(column.name)] =
          numbers(column.numbers.data(), {static_cast<py::ssize_t>(result->rows)}, {sizeof(double)}, owner);
    } else {
      columns[py::str(column.name)] = column.words;
    }
  }
  py::dict out;
  out["columns"] = columns;
  out["rows"] = result->rows;
  out["summary"] = python_of(result->summary);
  out["warnings"] = result->warnings;
  out["csv"] = result->csv;
  out["map"] = result->map;
  return py::make_tuple(out, py::none());
}

/// A quantity of the unit, in SI.
double quantity_of(const std::string& name, const std::string& text, const std::string& unit) {
  return signed_quantity(name, text, parse_unit(unit).dimension);
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
  prepare_for_forks();
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
  const py::class_<StoredResult, std::shared_ptr<StoredResult>> stored(module, "StoredResult");
  bind_runs(module);
  bind_maps(module);
  module.def("open_model", &open_model);
  module.def("check_model", &check_model);
  module.def("read", &read_stored);
  module.def("compare", &compare_stored);
  module.def("analyse", &analyse_words);
  module.def("quantity", &quantity_of);
  module.def("types", &list_types);
  module.def("describe", &describe_type);
  module.def("schema_of", &schema_of);
}
