#include "drawing/analysis_map.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/rows.h"
#include "analysis/singularity.h"
#include "base/error.h"
#include "drawing/map_drawing.h"

namespace freeplay {

std::string analysis_map_svg(const IdealMechanism& mechanism, const AnalysisRequest& request,
                             const RequestedStations& stations, const AnalysisTable& table, bool coloured,
                             const TickOf& tick_of) {
  const Model& model = mechanism.model();
  const PoseForm& form = mechanism.form();
  const auto* grid = stations.grid();
  const bool of_errors = request.kind == AnalysisKind::error;
  bool flat = grid != nullptr && (*grid)[0].count > 1 && (*grid)[1].count > 1;
  for (std::size_t i = 2; i < form.size(); ++i) flat = flat && (*grid)[i].count == 1;
  if (!flat || request.must_reach()) {
    throw Error(Error::Category::usage, "bad-value",
                "--svg draws a map: workspace, singularity or error on a grid of x and y, with one value of all else");
  }
  const std::vector<Station>& all = stations.all();
  const std::string column = of_errors ? "position" : "condition";
  const auto place = static_cast<std::size_t>(std::ranges::find(table.columns, column) - table.columns.begin());
  PositionMap map;
  map.title = fmt::format("{}: {}", model.name, of_errors ? "largest position error by clearance" : "condition number");
  for (std::size_t i = 2; i < form.size(); ++i) {
    if (!stations.given()[i] || (*grid)[i].value(0) == 0.0) continue;
    map.title += fmt::format(", {} {:.6g} {}", form.words[i], (*grid)[i].value(0), form.is_turn(i) ? "rad" : "m");
  }
  map.coloured = coloured;
  map.quantity = of_errors ? "position error [um]" : "condition number";
  const double unit = of_errors ? 1e6 : 1.0;
  for (long i = 0; i < (*grid)[0].count; ++i) map.x.push_back((*grid)[0].value(i));
  for (long j = 0; j < (*grid)[1].count; ++j) map.y.push_back((*grid)[1].value(j));
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double value = std::get<double>(table.rows[k][place]);
    map.values.push_back(unit * value);
    const bool good = all[k].reachable && std::isfinite(value) && (of_errors || value * singular_limit < 1.0);
    map.points.push_back(!all[k].reachable ? MapPoint::unreachable : good ? MapPoint::good : MapPoint::singular);
  }
  if (!std::ranges::is_sorted(map.x) || !std::ranges::is_sorted(map.y)) {
    throw Error(Error::Category::usage, "bad-value", "--svg needs a grid whose x and y grow");
  }
  map.determinant =
      determinants(mechanism, all, stations.given(), request.threads, tick_of("signs of the map", all.size()));
  const FramePath& path = mechanism.platform().path;
  for (int k = 0; k <= 200 && path.gives_all(2); ++k) {
    const Settings& settings = model.settings;
    PathPose pose;
    EvaluationFailure failure;
    const double t = settings.start + (settings.end - settings.start) * k / 200.0;
    if (path.evaluate(t, pose, failure)) map.path.push_back({pose[0].value, pose[1].value});
  }
  return map_svg(map);
}

}  // namespace freeplay
