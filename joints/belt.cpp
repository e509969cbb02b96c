#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "freeplay/kit/planar_marker.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

using namespace planar;

/// Elastic belt or chain on two pulleys that does not slip. With d = P_b - P_a, u = d/|d| at the angle phi, the angles
/// theta of the markers, all counted over turns, and seen from the first pulley to the second, the strands on the left
/// (s = 1) and on the right (s = -1) are longer than at the start by
///
///   x_s = s (R_a (theta_a - phi) - q R_b (theta_b - phi)) + g(|d|), less what that is at the start
///   g' = cos(gamma), sin(gamma) = (R_b - q R_a)/|d|: the part of the strand along u
///
/// with q = 1 for an open belt and -1 for one whose strands cross. Both pulleys feel
///
///   T_s = max(0, T_0 + k x_s + c x_s')      stored: (T_0 + k x_s)^2/(2 k), of strands that are not slack
///
/// along the strand. Its gradients are x_s by the places and angles of the markers, so that work and stored energy
/// agree.
class Belt final : public Joint {
 public:
  explicit Belt(const Parameters& p)
      : radius_{p.number("first_radius"), p.number("second_radius")},
        sense_(p.word("strands") == 0 ? 1.0 : -1.0),
        stiffness_(p.number("stiffness")),
        damping_(p.number("damping")),
        pretension_(p.number("pretension")) {}

  void declare(JointLayout& layout) const override {
    static constexpr Channel tensions[] = {{"left_tension", "N"}, {"right_tension", "N"}};
    layout.time_scale = unbounded;
    layout.forces = 1;
    layout.history = history_size;
    layout.channels = tensions;
    layout.kinks = 2;
  }
  void initialize(const JointInput& in, Span<double>, Span<double> history) const override {
    std::ranges::copy(angles(in), history.begin() + turns);
    refuse_impossible((position(*in.b) - position(*in.a)).norm());
    const Pair pair(*this, in, history);
    for (std::size_t s = 0; s < 2; ++s) history[start + s] = pair.strand[s].x;
    history[started] = 1.0;
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    std::ranges::copy(counted(in, history), history.begin() + turns);
  }
  void apply(const JointInput& in, JointForces& out) const override {
    const Pair pair(*this, in, in.history);
    out.potential = out.potential_rate = 0.0;
    for (std::size_t s = 0; s < 2; ++s) {
      const Strand& strand = pair.strand[s];
      const double elastic = elastic_part(pair, s, in.history);
      if (elastic > 0.0) {
        out.potential += 0.5 * elastic * elastic / stiffness_;
        out.potential_rate += elastic * strand.rate;
      }
      const double pull = tension(pair, s, in.history);
      for (int i = 0; i < 2; ++i) {
        out.wrench_a[i] += pull * strand.by_place[i];
        out.wrench_b[i] -= pull * strand.by_place[i];
      }
      out.wrench_a[5] -= pull * strand.by_first;
      out.wrench_b[5] -= pull * strand.by_second;
    }
  }
  void kinks(const JointInput& in, Span<double> g) const override {
    const Pair pair(*this, in, in.history);
    for (std::size_t s = 0; s < 2; ++s) g[s] = elastic_part(pair, s, in.history) + damping_ * pair.strand[s].rate;
  }
  const char* warning(const JointInput& in) const override {
    const double length = (position(*in.b) - position(*in.a)).norm();
    if (!(length > std::abs(across()))) return "The pulleys are closer than their belt allows.";
    return length > radius_[0] + radius_[1] ? nullptr : "The pulleys reach into each other.";
  }
  void observe(const JointInput& in, Span<const double>, Span<double> channels) const override {
    const Pair pair(*this, in, in.history);
    for (std::size_t s = 0; s < 2; ++s) channels[s] = tension(pair, s, in.history);
  }

 private:
  static constexpr double smallest_length = 1e-12;  // [m]
  enum History : std::size_t { turns, start = turns + 3, started = start + 2, history_size };

  struct Strand {
    double x = 0.0, rate = 0.0;              ///< x: from any length
    double by_first = 0.0, by_second = 0.0;  ///< by the angles of the pulleys
    Eigen::Vector2d by_place;                ///< by the place of b
  };
  struct Pair {
    Pair(const Belt& belt, const JointInput& in, Span<const double> history) {
      const Eigen::Vector2d d = position(*in.b) - position(*in.a), v = velocity(*in.b) - velocity(*in.a);
      const double length = std::max(d.norm(), smallest_length), across = belt.across();
      const Eigen::Vector2d u = d / length, t = turned(u);
      const double along = std::sqrt(std::max(0.0, (length - across) * (length + across)));
      const auto [first, second, line] = belt.counted(in, history);
      for (std::size_t i = 0; i < 2; ++i) {
        const double s = i == 0 ? 1.0 : -1.0;
        strand[i].by_first = s * belt.radius_[0];
        strand[i].by_second = -s * belt.sense_ * belt.radius_[1];
        const double by_line = -strand[i].by_first - strand[i].by_second;
        strand[i].x = strand[i].by_first * first + strand[i].by_second * second + by_line * line + along +
                      across * std::asin(std::clamp(across / length, -1.0, 1.0));
        strand[i].by_place = by_line / length * t + along / length * u;
        strand[i].rate = strand[i].by_place.dot(v) + strand[i].by_first * angular_velocity(*in.a) +
                         strand[i].by_second * angular_velocity(*in.b);
      }
    }
    std::array<Strand, 2> strand;
  };

  /// Strands touch both pulleys where these are farther apart than by |across|.
  void refuse_impossible(double distance) const {
    if (distance > std::abs(across())) return;
    std::array<char, 256> text{};
    const bool open = sense_ > 0.0;
    std::snprintf(
        text.data(), text.size(),
        "no %s belt fits on its pulleys: their centres are %.4g m apart, and it needs more than %.4g m, the %s "
        "of their radii, as %s; move them apart%s",
        open ? "open" : "crossed", distance, std::abs(across()), open ? "difference" : "sum",
        open ? "one stands inside the other" : "they overlap", open ? "" : ", or take open strands");
    throw BadParameter("", "starts-inside", text.data());
  }
  double across() const { return radius_[1] - sense_ * radius_[0]; }
  /// What the stretch alone makes of the tension of strand s; before the start, and in analyses, the pretension.
  double elastic_part(const Pair& pair, std::size_t s, Span<const double> history) const {
    if (history[started] == 0.0) return pretension_;
    return pretension_ + stiffness_ * (pair.strand[s].x - history[start + s]);
  }
  double tension(const Pair& pair, std::size_t s, Span<const double> history) const {
    const double elastic = elastic_part(pair, s, history);
    return elastic > 0.0 ? std::max(0.0, elastic + damping_ * pair.strand[s].rate) : 0.0;
  }

  static std::array<double, 3> angles(const JointInput& in) {
    const Eigen::Vector2d a = x_axis(*in.a), b = x_axis(*in.b), d = position(*in.b) - position(*in.a);
    return {std::atan2(a.y(), a.x()), std::atan2(b.y(), b.x()), std::atan2(d.y(), d.x())};
  }
  /// In the turns nearest to those at the begin of the step.
  std::array<double, 3> counted(const JointInput& in, Span<const double> history) const {
    constexpr double turn = 2.0 * std::numbers::pi;
    std::array<double, 3> all = angles(in);
    for (std::size_t i = 0; i < 3; ++i) all[i] += turn * std::round((history[turns + i] - all[i]) / turn);
    return all;
  }

  double radius_[2], sense_, stiffness_, damping_, pretension_;
};

constexpr Parameter belt_parameters[] = {
    {.name = "first_radius", .unit = "m", .minimum = 0.0, .open = Open::minimum, .summary = "Of the first pulley."},
    {.name = "second_radius", .unit = "m", .minimum = 0.0, .open = Open::minimum, .summary = "Of the second pulley."},
    {.name = "strands",
     .kind = ParameterKind::choice,
     .default_value = 0,
     .choices = "open|crossed",
     .summary = "Crossed strands turn the pulleys against each other."},
    {.name = "stiffness",
     .unit = "N/m",
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Of one strand: E A/L with its free length L."},
    {.name = "damping", .unit = "N*s/m", .default_value = 0.0, .minimum = 0.0, .summary = "Of one strand."},
    {.name = "pretension",
     .unit = "N",
     .default_value = 0.0,
     .minimum = 0.0,
     .summary = "Tension of both strands at the start, where the pulleys stand then."}};

}  // namespace

Component belt() {
  return joint<Belt>(
      {.name = "belt",
       .space = Space::planar,
       .summary = "Force element: an elastic belt or chain on two pulleys, whose centres are the two origins; a slack "
                  "strand does not push.",
       .formula = "T_s = max(0, pretension + stiffness x_s + damping x_s') in the strands s = 1, left of the line from "
                  "the first to the second pulley, and s = -1; x_s = s (R_a (theta_a - phi) - q R_b (theta_b - phi)) + "
                  "g(|d|) less what it is at the start, phi the angle of d = P_b - P_a, q = 1 (open) or -1 (crossed), "
                  "g' the part of the strand along d.",
       .validity = "No slip, no mass of the belt; the stiffness of a strand does not change with its length.",
       .parameters = belt_parameters});
}

}  // namespace freeplay
