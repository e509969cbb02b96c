#include "drawing/analysis_map.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/rows.h"
#include "analysis/singularity.h"
#include "base/error.h"
#include "drawing/map_drawing.h"

namespace freeplay {
namespace {

/// Numbers of the pose of which a grid has more than one value.
std::vector<std::size_t> wide_axes(const std::array<GridValues, most_components>& grid, const PoseForm& form) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < form.size(); ++i) {
    if (grid[i].count > 1) out.push_back(i);
  }
  return out;
}

}  // namespace

std::string analysis_map_svg(const IdealMechanism& mechanism, const AnalysisRequest& request,
                             const RequestedStations& stations, const AnalysisTable& table, bool coloured,
                             const TickOf& tick_of) {
  const Model& model = mechanism.model();
  const PoseForm& form = mechanism.form();
  const auto* grid = stations.grid();
  const bool of_errors = request.kind == AnalysisKind::error;
  const std::vector<std::size_t> runs = grid == nullptr ? std::vector<std::size_t>{} : wide_axes(*grid, form);
  const bool flat = runs.size() == 2 && !form.is_turn(runs[1]);
  if (!flat || request.must_reach()) {
    throw Error(Error::Category::usage, "bad-value",
                fmt::format("--svg draws a map: workspace, singularity or error on a grid of {}, with one value of all "
                            "else",
                            form.lengths == 2 ? "x and y" : "two of x, y and z"));
  }
  const GridValues &across = (*grid)[runs[0]], &up = (*grid)[runs[1]];
  const std::vector<Station>& all = stations.all();
  const std::string column = of_errors ? "position" : "condition";
  const auto place = static_cast<std::size_t>(std::ranges::find(table.columns, column) - table.columns.begin());
  PositionMap map;
  map.title = fmt::format("{}: {}", model.name, of_errors ? "largest position error by clearance" : "condition number");
  for (std::size_t i = 0; i < form.size(); ++i) {
    if ((*grid)[i].count > 1 || !stations.given()[i] || (*grid)[i].value(0) == 0.0) continue;
    map.title += fmt::format(", {} {:.6g} {}", form.words[i], (*grid)[i].value(0), form.is_turn(i) ? "rad" : "m");
  }
  map.coloured = coloured;
  map.quantity = of_errors ? "position error [um]" : "condition number";
  const double unit = of_errors ? 1e6 : 1.0;
  map.x_word = form.words[runs[0]];
  map.y_word = form.words[runs[1]];
  for (long i = 0; i < across.count; ++i) map.x.push_back(across.value(i));
  for (long j = 0; j < up.count; ++j) map.y.push_back(up.value(j));
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double value = std::get<double>(table.rows[k][place]);
    map.values.push_back(unit * value);
    const bool known = of_errors || turns_whole(form, stations.given());
    const bool good =
        all[k].reachable && (!known || (std::isfinite(value) && (of_errors || value * singular_limit < 1.0)));
    map.points.push_back(!all[k].reachable ? MapPoint::unreachable : good ? MapPoint::good : MapPoint::singular);
  }
  if (!std::ranges::is_sorted(map.x) || !std::ranges::is_sorted(map.y)) {
    throw Error(Error::Category::usage, "bad-value",
                fmt::format("--svg needs a grid whose {} and {} grow", map.x_word, map.y_word));
  }
  if (turns_whole(form, stations.given())) {
    map.determinant =
        determinants(mechanism, all, stations.given(), request.threads, tick_of("signs of the map", all.size()));
  }
  const FramePath& path = mechanism.platform().path;
  for (int k = 0; k <= 200 && path.gives(runs[0]) && path.gives(runs[1]); ++k) {
    const Settings& settings = model.settings;
    PathPose pose;
    EvaluationFailure failure;
    const double t = settings.start + (settings.end - settings.start) * k / 200.0;
    if (path.evaluate(t, pose, failure)) map.path.push_back({pose[runs[0]].value, pose[runs[1]].value});
  }
  return map_svg(map);
}

}  // namespace freeplay
