// What a joint says of its own dependence on time: time_scale and next_corner().
#include <cmath>

#include <fmt/format.h>

#include "contract/joint_contract.h"
#include "contract/joint_words.h"

namespace freeplay {
namespace {

void check_scale(const JointProbe& probe, const std::vector<JointMoment>& moments, RandomNumbers& random,
                 Findings& findings) {
  const double scale = probe.layout().time_scale;
  findings.expect("time-scale", scale >= 0.0, [&] { return fmt::format("it declares {} s", scale); });
  if (scale != unbounded) return;
  for (const JointMoment& moment : moments) {
    JointMoment later = moment;
    later.t += random.between(1e-3, 10.0);
    const ProbedRows rows = probe.rows(moment), rows_later = probe.rows(later);
    bool same = same_bits(rows.phi, rows_later.phi);
    if (probe.layout().forces != 0) {
      const ProbedForces forces = probe.forces(moment), forces_later = probe.forces(later);
      same = same && same_bits(forces.wrench, forces_later.wrench) && same_bits(forces.z_rate, forces_later.z_rate);
    }
    findings.expect("time-scale", same, [&] {
      return fmt::format("it declares that nothing depends on time, but forces or rows {} are others at t = {:.6g} s",
                         words_of(moment), later.t);
    });
  }
}

void check_corners(const JointProbe& probe, Findings& findings) {
  constexpr int most = 100;
  double t = 0.0;
  for (int i = 0; i < most && t < unbounded; ++i) {
    const double corner = probe.next_corner(t), again = probe.next_corner(t);
    findings.expect("next-corner", corner > t,
                    [&] { return fmt::format("next_corner({:.17g}) gives {:.17g} s", t, corner); });
    findings.expect("next-corner", corner == again || std::isnan(corner), [&] {
      return fmt::format("next_corner({:.17g}) gives {:.17g} s and then {:.17g} s", t, corner, again);
    });
    if (!(corner > t)) return;
    const double between = t + 0.5 * (corner - t);
    const double from_there = corner < unbounded && between < corner ? probe.next_corner(between) : corner;
    findings.expect("next-corner", from_there == corner, [&] {
      return fmt::format("next_corner({:.17g}) gives {:.17g} s, but from {:.17g} s it is {:.17g} s", t, corner, between,
                         from_there);
    });
    t = corner;
  }
}

}  // namespace

void check_time(const JointProbe& probe, const std::vector<JointMoment>& moments, RandomNumbers& random,
                Findings& findings) {
  check_scale(probe, moments, random, findings);
  check_corners(probe, findings);
}

}  // namespace freeplay
