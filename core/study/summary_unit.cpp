#include "study/summary_unit.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/name_pattern.h"

namespace freeplay {
namespace {

struct FigureUnit {
  std::string_view figure, unit;
};
/// Of joints, forces, bodies, paths and energies: these words have one meaning wherever they stand.
constexpr std::array figures = {FigureUnit{"max_force", "N"},
                                FigureUnit{"rms_force", "N"},
                                FigureUnit{"max_fn", "N"},
                                FigureUnit{"mean_fn", "N"},
                                FigureUnit{"max_torque", "N*m"},
                                FigureUnit{"max_delta", "m"},
                                FigureUnit{"max_eccentricity", "m"},
                                FigureUnit{"dissipated", "J"},
                                FigureUnit{"work", "J"},
                                FigureUnit{"carried_in", "J"},
                                FigureUnit{"carried_out", "J"},
                                FigureUnit{"sliding", "m"},
                                FigureUnit{"max_approach_speed", "m/s"},
                                FigureUnit{"max_impulse", "N*s"},
                                FigureUnit{"load_angle", "rad"},
                                FigureUnit{"load_elevation", "rad"},
                                FigureUnit{"pv_mean", "Pa*m/s"},
                                FigureUnit{"pv_max", "Pa*m/s"},
                                FigureUnit{"radial_clearance", "m"},
                                FigureUnit{"gap", "m"},
                                FigureUnit{"length", "m"},
                                FigureUnit{"bearing_radius", "m"},
                                FigureUnit{"journal_radius", "m"},
                                FigureUnit{"x", "m"},
                                FigureUnit{"y", "m"},
                                FigureUnit{"z", "m"},
                                FigureUnit{"angle", "rad"},
                                FigureUnit{"max_speed", "m/s"},
                                FigureUnit{"max_position", "m"},
                                FigureUnit{"rms_position", "m"},
                                FigureUnit{"max_angle", "rad"},
                                FigureUnit{"rms_angle", "rad"},
                                FigureUnit{"kinetic", "J"},
                                FigureUnit{"potential", "J"},
                                FigureUnit{"residual", "J"},
                                FigureUnit{"position_max", "m"},
                                FigureUnit{"velocity_max", "m/s"},
                                FigureUnit{"energy_max", "J"},
                                FigureUnit{"reached", "s"},
                                FigureUnit{"smallest_step", "s"},
                                FigureUnit{"largest_step", "s"},
                                FigureUnit{"from", "s"},
                                FigureUnit{"to", "s"},
                                FigureUnit{"start", "s"},
                                FigureUnit{"end", "s"},
                                FigureUnit{"interval", "s"},
                                FigureUnit{"discard", "s"},
                                FigureUnit{"step", "s"},
                                FigureUnit{"size", "s"}};

/// Of a driver: that of its torque or force.
std::string unit_of_drivers(std::string_view path, const Model& model, const Channels& channels) {
  std::string unit;
  for (std::size_t d = 0; d < model.drivers.size(); ++d) {
    if (!matches(path, "drivers." + model.drivers[d].name)) continue;
    const std::string own(channels.all()[static_cast<std::size_t>(channels.drivers[d].effort)].unit);
    if (!unit.empty() && own != unit) return "1";
    unit = own;
  }
  return unit.empty() ? "1" : unit;
}

}  // namespace

std::string summary_unit(const std::string& path, const Model& model, const Channels& channels) {
  std::string_view rest = path;
  for (const std::string_view before : {"noise.", "statistics.before."}) {  // these have the figures again
    if (rest.starts_with(before)) rest.remove_prefix(before.size());
  }
  const std::size_t dot = rest.rfind('.');
  if (dot == rest.npos) return "1";
  const std::string_view figure = rest.substr(dot + 1), owner = rest.substr(0, dot);
  if (owner.starts_with("drivers.") && (figure == "max_abs" || figure == "rms")) {
    return unit_of_drivers(owner, model, channels);
  }
  const auto known = std::ranges::find(figures, figure, &FigureUnit::figure);
  return known == figures.end() ? "1" : std::string(known->unit);
}

}  // namespace freeplay
