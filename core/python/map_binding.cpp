// Many runs for Python.
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include "base/number_text.h"
#include "base/processors.h"
#include "python/binding.h"
#include "python/mapped_points.h"
#include "study/axis_value.h"

namespace freeplay {
namespace {

using Clock = std::chrono::steady_clock;

/// What the points came to that were run, and what a signal or `progress` raised.
py::tuple run_points(MappedPoints& points, int workers, const py::object& progress) {
  Pulse pulse(progress);
  {
    const Away away;
    Clock::time_point last{};
    points.run(workers > 0 ? workers : processor_count(), [&](std::size_t done) {
      const Clock::time_point now = Clock::now();
      if (now - last < std::chrono::milliseconds(100)) return true;
      last = now;
      return pulse(static_cast<double>(done), static_cast<long>(points.points()));
    });
  }
  py::list keys, columns, rows;
  for (const MappedPoints::Column& key : points.keys()) keys.append(py::make_tuple(key.name, key.unit, key.words));
  for (const StudyColumn& column : points.columns()) columns.append(py::make_tuple(column.name, column.unit));
  for (std::size_t i = 0; i < points.points(); ++i) {
    const auto& outcome = points.outcomes()[i];
    if (!outcome) continue;
    rows.append(
        py::make_tuple(i, points.cells(i), outcome->exit_code, outcome->error, outcome->message, outcome->values));
  }
  py::dict out;
  out["keys"] = keys;
  out["columns"] = columns;
  out["rows"] = rows;
  return py::make_tuple(out, pulse.raised());
}

py::tuple map_points(const std::shared_ptr<OpenedModel>& model, const std::string& reducers,
                     const std::vector<std::string>& targets, const std::vector<std::vector<std::string>>& values,
                     int workers, const py::object& progress) {
  std::optional<MappedPoints> points;
  {
    const Away away;
    points.emplace(model, reducers, targets, values);
  }
  return run_points(*points, workers, progress);
}

py::tuple map_study(const py::dict& options, const std::string& reducers, int workers, const py::object& progress) {
  const OpenRequest request = request_of_dict(options);
  std::optional<MappedPoints> points;
  {
    const Away away;
    points.emplace(request, reducers);
  }
  return run_points(*points, workers, progress);
}

}  // namespace

void bind_maps(py::module_& module) {
  module.def("map_points", &map_points);
  module.def("map_study", &map_study);
  module.def("cells", [](const std::vector<std::vector<std::string>>& values) {
    std::vector<std::vector<std::string>> cells;
    for (const std::vector<std::string>& texts : values) {
      std::vector<std::string>& shown = cells.emplace_back();
      for (const std::string& text : texts) shown.push_back(AxisValue::of(text).cell());
    }
    return cells;
  });
  module.def("unit_of", [](const OpenedModel& model, const std::string& name) { return model.unit_of(name); });
  module.def("number_text", &number_text);
  module.def("processor_count", &processor_count);
}

}  // namespace freeplay
