#include "python/binding.h"

#include <string>
#include <utility>

#include <pybind11/stl.h>

namespace freeplay {

bool Pulse::operator()(double t, long steps) {
  std::optional<py::gil_scoped_acquire> held;
  while_interpreter_lives([&] { held.emplace(); });
  if (PyErr_CheckSignals() != 0) {
    raised_.emplace();
    return false;
  }
  if (progress_.is_none()) return true;
  try {
    called(progress_, py::make_tuple(t, steps));
  } catch (py::error_already_set& error) {
    raised_ = std::move(error);
    return false;
  }
  return true;
}

py::object Pulse::raised() {
  if (!raised_) return py::none();
  py::object value = raised_->value();
  raised_.reset();
  return value;
}

py::object called(const py::object& function, const py::tuple& arguments) {
  PyObject* const answer =
      while_interpreter_lives([&] { return PyObject_CallObject(function.ptr(), arguments.ptr()); });
  if (answer == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(answer);
}

py::object python_of(const Json& json) {
  return called(py::module_::import("json").attr("loads"),
                py::make_tuple(json.dump(-1, ' ', false, Json::error_handler_t::replace)));
}

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
  list("plugins", request.load.plugins);
  if (options.contains("strict")) request.load.strict = options["strict"].cast<bool>();
  if (options.contains("allow_plugins")) request.load.allow_plugins = options["allow_plugins"].cast<bool>();
  return request;
}

}  // namespace freeplay
