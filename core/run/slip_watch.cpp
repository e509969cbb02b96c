#include "run/slip_watch.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/index.h"
#include "model/element_name.h"
#include "run/context.h"

namespace freeplay {
namespace {

constexpr const char* smoothing = "vs";  // as all laws call it that have one

/// Of a law among the parameters of a joint, or of the joint itself; zero where there is none.
double smoothing_speed(const ParameterBlock& block, bool of_law) {
  double found = 0.0;
  for (const auto& [name, value] : block.values) {
    if (of_law && value.law) found = std::max(found, smoothing_speed(*value.law, false));
    if (!of_law && name == smoothing && std::isfinite(value.number)) found = value.number;
  }
  return found;
}

}  // namespace

SlipWatch::SlipWatch(const System& system, const Channels& channels) {
  const Model& model = system.model();
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointElement& joint = model.joints[at(j)];
    if (!joint.parameters) continue;
    const JointColumns& columns = channels.joints[at(j)];
    const bool own = smoothing_speed(*joint.parameters, false) > 0.0;
    const Coordinate coordinate = joint.ideal_layout().coordinate;
    Sliding one{.joint = j, .turns = own && coordinate == Coordinate::angle};
    one.vs = smoothing_speed(*joint.parameters, !own);
    if (!own) one.slip = columns.slip, one.normal_force = columns.normal_force;
    const bool known = own ? coordinate != Coordinate::none : one.slip >= 0 && one.normal_force >= 0;
    if (known && one.vs > (one.turns ? turning : watched)) slidings_.push_back(one);
  }
}

void SlipWatch::add(std::span<const double> row, const Evaluation& e) {
  for (Sliding& one : slidings_) {
    if (one.normal_force >= 0 && !(row[at(one.normal_force)] > 0.0)) continue;
    const double speed = one.slip >= 0 ? row[at(one.slip)] : e.coordinate_rate[at(one.joint)];
    one.fastest = std::max(one.fastest, std::abs(speed));
  }
}

void SlipWatch::say(RunContext& run) const {
  for (const Sliding& one : slidings_) {
    if (!(one.fastest > 0.0) || one.fastest >= reached * one.vs) continue;
    const std::string joint = written_name(run.model.joints[at(one.joint)]);
    const char* const unit = one.turns ? "rad/s" : "m/s";
    run.outcome.doubts.push_back(
        {.id = "law-range",
         .level = Trust::doubtful,
         .message =
             fmt::format("{}: friction is smoothed over {:.3g} {}, but nothing slips faster than {:.2g} {}, so that "
                         "there is hardly any; check 'vs' and its unit",
                         joint, one.vs, unit, one.fastest, unit),
         .element = joint,
         .value = one.fastest,
         .limit = reached * one.vs});
  }
}

}  // namespace freeplay
