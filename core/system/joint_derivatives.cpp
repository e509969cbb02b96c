#include "system/joint_derivatives.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/index.h"
#include "system/planar_kinematics.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

constexpr double part = 6e-6;               // step over what it differentiates
constexpr double smallest_speed = 1e-3;     // that friction laws distinguish from rest [m/s]
constexpr double smallest_internal = 1e-3;  // unless the joint has a smaller clearance
constexpr double of_coordinates = 1e-11;    // below that rounding of positions and speeds shows
constexpr double smallest_angle = 1e-10;    // [rad]
constexpr int most_reductions = 4;          // of a step that leaves its phase on both sides
constexpr double reduction = 1.0 / 16.0;

double distance(const double* a, const double* b) {
  return std::hypot(std::hypot(b[0] - a[0], b[1] - a[1]), b[2] - a[2]);
}
double length(const double* x) { return std::hypot(std::hypot(x[0], x[1]), x[2]); }

// Rotates the axes of a marker by `angle` about the world axis.
void turn(int axis, double angle, MarkerKinematics& k) {
  const double c = std::cos(angle), s = std::sin(angle);
  double* const first = k.rotation + 3 * ((axis + 1) % 3);
  double* const second = k.rotation + 3 * ((axis + 2) % 3);
  for (int column = 0; column < 3; ++column) {
    const double x = first[column], y = second[column];
    first[column] = c * x - s * y;
    second[column] = s * x + c * y;
  }
}

// Moves the pose (component 0..5) or the twist (6..11) of a marker.
void move(int component, double by, MarkerKinematics& k) {
  const int axis = component % 3;
  switch (component / 3) {
    case 0:
      k.position[axis] += by;
      break;
    case 1:
      turn(axis, by, k);
      break;
    case 2:
      k.velocity[axis] += by;
      break;
    default:
      k.angular_velocity[axis] += by;
      break;
  }
}

/// The steps of one joint at one instant.
struct Steps {
  Steps(const DifferencedJoint& differenced, const JointInput& in) {
    const double gap = differenced.layout.clearance, size = differenced.size;
    const double apart = distance(in.a->position, in.b->position);
    const double way = gap > 0.0 ? gap : std::max(apart, 0.01 * size);
    const double speed = std::max(distance(in.a->velocity, in.b->velocity), smallest_speed);
    const double spin = distance(in.a->angular_velocity, in.b->angular_velocity);
    const double far = std::max(length(in.a->position), length(in.b->position));
    const double fast = std::max(length(in.a->velocity), length(in.b->velocity));
    by_kind[0] = std::max(part * way, of_coordinates * far);
    by_kind[1] = std::clamp(part * way / size, smallest_angle, part);
    by_kind[2] = std::max(part * speed, of_coordinates * fast);
    by_kind[3] = part * std::max(spin, smallest_speed / size);
    internal = gap > 0.0 ? std::min(smallest_internal, gap) : smallest_internal;
  }
  double of(int component) const { return by_kind[component / 3]; }
  double of_internal(double z) const { return part * std::max(std::abs(z), internal); }

  double by_kind[4];  // position, rotation, velocity, angular velocity
  double internal;
};

class Differences {
 public:
  Differences(const DifferencedJoint& differenced, const JointInput& in, const JointForces& here,
              std::span<double> derivatives, Message& message)
      : differenced_(differenced),
        in_(in),
        here_(here),
        derivatives_(derivatives),
        message_(message),
        nz_(in.internal.size),
        events_(differenced.layout.events.size),
        moved_(differenced.work.first(nz_)),
        rates_{differenced.work.subspan(nz_, nz_), differenced.work.subspan(2 * nz_, nz_)},
        functions_(differenced.work.subspan(3 * nz_, events_)),
        functions_there_(differenced.work.subspan(3 * nz_ + events_, events_)),
        function_rates_(differenced.work.subspan(3 * nz_ + 2 * events_, events_)) {}

  bool fill() {
    std::ranges::fill(derivatives_, 0.0);
    if (events_ > 0 && !event_functions(in_, functions_)) return false;
    const Steps steps(differenced_, in_);
    const bool planar = differenced_.layout.space == Space::planar;
    const std::span<const int> components =
        planar ? std::span<const int>(planar::components) : std::span<const int>(spatial::components);
    for (const bool second : {false, true}) {
      for (const int twist : {0, 6}) {
        for (const int component : components) {
          const auto move_marker = [&](double by, JointInput& in, MarkerKinematics& k) {
            k = second ? *in_.b : *in_.a;
            move(component + twist, by, k);
            (second ? in.b : in.a) = &k;
            return follow(in);
          };
          const std::size_t column = at(component + 2 * twist + (second ? 6 : 0));
          if (!difference(steps.of(component + twist), column, move_marker)) return false;
        }
      }
    }
    for (std::size_t i = 0; i < nz_; ++i) {
      const auto move_internal = [&](double by, JointInput& in, MarkerKinematics&) {
        std::ranges::copy(in_.internal, moved_.begin());
        moved_[i] += by;
        in.internal = {moved_.data(), nz_};
        return true;
      };
      if (!difference(steps.of_internal(in_.internal[i]), 24 + i, move_internal)) return false;
    }
    return true;
  }

 private:
  /// The joint's answer at a moved state, where it is allowed to be differenced.
  struct Side {
    JointForces forces{};
    bool allowed = false;
  };

  // A joint that refuses one side may still be differenced on the other.
  template <class Move>
  void look(double by, const Move& move_to, bool any_phase, std::span<double> rate, Side& side) {
    JointInput in = in_;
    MarkerKinematics k;
    side.allowed = move_to(by, in, k) && (any_phase || stays(in));
    if (!side.allowed) return;
    side.forces = {};
    std::ranges::fill(rate, 0.0);
    side.forces.internal_rate = {rate.data(), nz_};
    side.allowed = differenced_.joint.apply(in, side.forces, message_);
  }

  template <class Move>
  bool difference(double step, std::size_t column, const Move& move_to) {
    Side low, high;
    for (int i = 0; i <= most_reductions; ++i, step *= reduction) {
      const bool any_phase = i == most_reductions;  // it stands at two zeros
      look(-step, move_to, any_phase, rates_[0], low);
      look(step, move_to, any_phase, rates_[1], high);
      if (!low.allowed && !high.allowed) continue;
      const JointForces& from = low.allowed ? low.forces : here_;
      const JointForces& to = high.allowed ? high.forces : here_;
      write(column, from, to, low.allowed && high.allowed ? 2.0 * step : step);
      return true;
    }
    return false;
  }

  void write(std::size_t column, const JointForces& from, const JointForces& to, double width) {
    const std::size_t columns = 24 + nz_;
    for (std::size_t i = 0; i < 6; ++i) {
      derivatives_[i * columns + column] = (to.wrench_a[i] - from.wrench_a[i]) / width;
      derivatives_[(6 + i) * columns + column] = (to.wrench_b[i] - from.wrench_b[i]) / width;
    }
    for (std::size_t i = 0; i < nz_; ++i) {
      derivatives_[(12 + i) * columns + column] = (to.internal_rate[i] - from.internal_rate[i]) / width;
    }
  }

  bool event_functions(const JointInput& in, std::span<double> g) {
    return differenced_.joint.events(in, {g.data(), g.size()}, {function_rates_.data(), events_}, message_);
  }

  /// Whether no event lies between the joint's place and that of `in`. At the very zero of a function it stands where
  /// the event has yet to happen.
  bool stays(const JointInput& in) {
    if (events_ == 0) return true;
    if (!event_functions(in, functions_there_)) return false;
    for (std::size_t i = 0; i < events_; ++i) {
      const double sign = differenced_.layout.events[i].crossing == Crossing::rising ? 1.0 : -1.0;
      if (std::isnan(functions_[i]) != std::isnan(functions_there_[i])) return false;
      if ((sign * functions_[i] > 0.0) != (sign * functions_there_[i] > 0.0)) return false;
    }
    return true;
  }

  /// The joint's coordinate at moved markers, in the turn in which it is.
  bool follow(JointInput& in) {
    if (differenced_.layout.coordinate == Coordinate::none) return true;
    CoordinateRow row{};
    if (!differenced_.joint.coordinate(in, row, message_)) return false;
    const bool angle = differenced_.layout.coordinate == Coordinate::angle;
    in.coordinate = row.value;
    if (angle) in.coordinate = nearest_turn(row.value, in_.coordinate);
    in.coordinate_rate = 0.0;
    for (int i = 0; i < 3; ++i) {
      in.coordinate_rate += row.jacobian[i] * in.a->velocity[i] + row.jacobian[3 + i] * in.a->angular_velocity[i] +
                            row.jacobian[6 + i] * in.b->velocity[i] + row.jacobian[9 + i] * in.b->angular_velocity[i];
    }
    return true;
  }

  const DifferencedJoint& differenced_;
  const JointInput& in_;
  const JointForces& here_;
  std::span<double> derivatives_;
  Message& message_;
  std::size_t nz_, events_;
  std::span<double> moved_, rates_[2], functions_, functions_there_, function_rates_;
};

}  // namespace

bool difference_forces(const DifferencedJoint& differenced, const JointInput& input, const JointForces& here,
                       std::span<double> derivatives, Message& message) {
  return Differences(differenced, input, here, derivatives, message).fill();
}

}  // namespace freeplay
