#include "prismatic_clearance_in_space.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "freeplay/kit/contact_events.h"
#include "freeplay/kit/planar_marker.h"
#include "freeplay/kit/wall_play.h"
#include "resting_block.h"

namespace freeplay {
namespace play {
namespace {

constexpr SizeKeys bar_width_keys{"clearance.guide_width", "clearance.width", "clearance.gap", 2.0, 2.0};
constexpr SizeKeys bar_height_keys{"clearance.guide_height", "clearance.height", "clearance.gap_height", 2.0, 2.0};

/// The eight corners of a block l x 2 B x 2 B_z, centred on b, each before two walls of a guide along the x axis of a:
/// that across y, contacts 0 to 7, and that across z, 8 to 15. Front is +x of b, upper +y, right +z; corners are in the
/// order front and rear, upper, lower, right, left.
struct BarInGuide {
  static constexpr std::size_t contacts = 16;
  /// So that a block which stays in the plane is the slider of the plane.
  static constexpr double share = 0.5;
  static double sign(std::size_t bit) { return bit % 2 == 0 ? 1.0 : -1.0; }

  template <class T>
  WallPlace<T> place(const TurnedMotion<T>& m, std::size_t i) const {
    const double end = sign(i), side = sign(i / 2), flank = sign(i / 4);
    const Vec<double> corner{end * half_length, side * half_width, flank * half_height};
    const Vec<T> change = m.turn.change(corner);
    const Vec<T> arm{T(corner.x) + change.x, T(corner.y) + change.y, T(corner.z) + change.z};
    if (i < 8) return {T(side) * (m.d.y + change.y) - T(gap), {0.0, side, 0.0}, arm};
    return {T(flank) * (m.d.z + change.z) - T(gap_height), {0.0, 0.0, flank}, arm};
  }

  static std::array<double, 5> stand(const TurnedMotion<double>& m) { return {m.d.y, m.d.z, m.r.x, m.r.y, m.r.z}; }
  static constexpr bool between_walls() { return true; }
  std::array<double, 3> levers() const { return {half_length, half_width, half_height}; }

  double half_length, half_width, half_height;  ///< [m]
  double gap, gap_height;                       ///< play to each side along y and z [m]
  double play;                                  ///< the smaller one [m]
};

constexpr const char* bar_events[] = {
    "front_upper_right_y_contact_begin", "front_upper_right_y_contact_end",   "rear_upper_right_y_contact_begin",
    "rear_upper_right_y_contact_end",    "front_lower_right_y_contact_begin", "front_lower_right_y_contact_end",
    "rear_lower_right_y_contact_begin",  "rear_lower_right_y_contact_end",    "front_upper_left_y_contact_begin",
    "front_upper_left_y_contact_end",    "rear_upper_left_y_contact_begin",   "rear_upper_left_y_contact_end",
    "front_lower_left_y_contact_begin",  "front_lower_left_y_contact_end",    "rear_lower_left_y_contact_begin",
    "rear_lower_left_y_contact_end",     "front_upper_right_z_contact_begin", "front_upper_right_z_contact_end",
    "rear_upper_right_z_contact_begin",  "rear_upper_right_z_contact_end",    "front_lower_right_z_contact_begin",
    "front_lower_right_z_contact_end",   "rear_lower_right_z_contact_begin",  "rear_lower_right_z_contact_end",
    "front_upper_left_z_contact_begin",  "front_upper_left_z_contact_end",    "rear_upper_left_z_contact_begin",
    "rear_upper_left_z_contact_end",     "front_lower_left_z_contact_begin",  "front_lower_left_z_contact_end",
    "rear_lower_left_z_contact_begin",   "rear_lower_left_z_contact_end"};
constexpr auto all_bar_events = contact_events(bar_events);
constexpr auto all_bar_roles = contact_event_roles<all_bar_events.size()>();

constexpr Channel bar_channels[] = {
    {"shift_y", "m"},
    {"shift_z", "m"},
    {"tilt_x", "rad"},
    {"tilt_y", "rad"},
    {"tilt_z", "rad"},
    {"delta", "m"},
    {"fn", "N"},
    {"ft", "N"},
    {"power", "W"},
    {"contact", "1"},
    {"vt", "m/s"},
    {"front_upper_right_y_delta", "m"},
    {"front_upper_right_y_fn", "N"},
    {"front_upper_right_y_ft", "N"},
    {"rear_upper_right_y_delta", "m"},
    {"rear_upper_right_y_fn", "N"},
    {"rear_upper_right_y_ft", "N"},
    {"front_lower_right_y_delta", "m"},
    {"front_lower_right_y_fn", "N"},
    {"front_lower_right_y_ft", "N"},
    {"rear_lower_right_y_delta", "m"},
    {"rear_lower_right_y_fn", "N"},
    {"rear_lower_right_y_ft", "N"},
    {"front_upper_left_y_delta", "m"},
    {"front_upper_left_y_fn", "N"},
    {"front_upper_left_y_ft", "N"},
    {"rear_upper_left_y_delta", "m"},
    {"rear_upper_left_y_fn", "N"},
    {"rear_upper_left_y_ft", "N"},
    {"front_lower_left_y_delta", "m"},
    {"front_lower_left_y_fn", "N"},
    {"front_lower_left_y_ft", "N"},
    {"rear_lower_left_y_delta", "m"},
    {"rear_lower_left_y_fn", "N"},
    {"rear_lower_left_y_ft", "N"},
    {"front_upper_right_z_delta", "m"},
    {"front_upper_right_z_fn", "N"},
    {"front_upper_right_z_ft", "N"},
    {"rear_upper_right_z_delta", "m"},
    {"rear_upper_right_z_fn", "N"},
    {"rear_upper_right_z_ft", "N"},
    {"front_lower_right_z_delta", "m"},
    {"front_lower_right_z_fn", "N"},
    {"front_lower_right_z_ft", "N"},
    {"rear_lower_right_z_delta", "m"},
    {"rear_lower_right_z_fn", "N"},
    {"rear_lower_right_z_ft", "N"},
    {"front_upper_left_z_delta", "m"},
    {"front_upper_left_z_fn", "N"},
    {"front_upper_left_z_ft", "N"},
    {"rear_upper_left_z_delta", "m"},
    {"rear_upper_left_z_fn", "N"},
    {"rear_upper_left_z_ft", "N"},
    {"front_lower_left_z_delta", "m"},
    {"front_lower_left_z_fn", "N"},
    {"front_lower_left_z_ft", "N"},
    {"rear_lower_left_z_delta", "m"},
    {"rear_lower_left_z_fn", "N"},
    {"rear_lower_left_z_ft", "N"},
};
constexpr auto bar_roles = [] {
  std::array<ChannelRole, std::size(bar_channels)> roles{};
  roles.fill(ChannelRole::none);
  constexpr std::size_t stand_channels = 5;
  roles[stand_channels] = ChannelRole::penetration;
  roles[stand_channels + 1] = ChannelRole::normal_force;
  roles[stand_channels + 2] = ChannelRole::friction_force;
  roles[stand_channels + 4] = ChannelRole::in_contact;
  roles[stand_channels + 5] = ChannelRole::slip_speed;
  return roles;
}();

/// Slider with play in its guide, in space: a block (marker b in its middle, its edges along the axes of b) between two
/// pairs of walls, y = +-(B + g) and z = +-(B_z + g_z) of marker a. No constraint rows. Each of its eight corners may
/// touch the wall of its side across y and across z; with s the corner in the axes of b, R_b its turn against a, sigma
/// the sign of the wall and d = P_b - P_a, all in the axes of a,
///
///   delta = sigma (d + R_b s - s)_y - g        and the same with z
///
/// Every contact has half of the laws' forces, so that a block which stays in the plane feels what the planar one does.
/// `wall_contacts.h` and `contacts.h` have what follows from it. Flores, Ambrosio, Claro and Lankarani 2008, J Comput
/// Nonlinear Dyn 3, 011007; Qi, Luo and Huang 2011, Multibody Syst Dyn 26.
class BarWithPlay final : public WallContacts<BarInGuide> {
 public:
  explicit BarWithPlay(const Parameters& p) : BarWithPlay(p, read_bar(p)) {}

  void declare(JointLayout& layout) const override {
    declare_contacts(layout);
    layout.coordinate = Coordinate::position;
    layout.play_shape = PlayShape::walls;
    layout.clearance = std::max(geometry().gap, geometry().gap_height);
    layout.contact_length = 2.0 * geometry().half_length;
    layout.play_bounds = {bounds_.data(), bounds_.size()};
    layout.events = {all_bar_events.data(), all_bar_events.size()};
    layout.event_roles = {all_bar_roles.data(), all_bar_roles.size()};
    layout.channels = bar_channels;
    layout.channel_roles = {bar_roles.data(), bar_roles.size()};
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    space::Separation(in).write_coordinate(space::axis(*in.a, 0), row);
  }
  bool place(double position, Pose& b_in_a) const override {
    b_in_a = planar::pose(position, 0.0);
    return true;
  }
  /// Loaded, the corners carry force and moment together.
  void initial_offset(Span<const double> reaction, InitialOffset& out) const override {
    clear_start(out);
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    if (out.rotation != nullptr) axes = Eigen::Map<const RowMajor3>(out.rotation);
    BlockStand stand{Eigen::Vector3d(0.0, shift_[0], shift_[1]), Eigen::Map<const Eigen::Vector3d>(tilt_.tilt.data())};
    if (loaded_) {
      const auto load = [&](std::size_t first) -> Eigen::Vector3d {
        if (first + 3 > reaction.size) return Eigen::Vector3d::Zero();
        return axes.transpose() * Eigen::Map<const Eigen::Vector3d>(reaction.data + first);
      };
      stand = RestingBlock(geometry(), laws().normal, load(0), load(3)).stand();
    }
    Eigen::Map<Eigen::Vector3d>(out.position) = axes * stand.shift;
    Eigen::Map<Eigen::Vector3d>(out.tilt) = axes * stand.turn;
    Eigen::Map<Eigen::Vector3d>(out.velocity) = axes * Eigen::Vector3d(0.0, shift_rate_[0], shift_rate_[1]);
    Eigen::Map<Eigen::Vector3d>(out.tilt_rate) = axes * Eigen::Map<const Eigen::Vector3d>(tilt_.tilt_rate.data());
  }

 private:
  BarWithPlay(const Parameters& p, const BarInGuide& bar)
      : WallContacts(bar, SpatialLaws(p, surfaces(p, bar), true)), loaded_(WallStart(p).loaded), tilt_(p) {
    set_bounds();
    for (const char* turned : {"clearance.initial.angle", "clearance.initial.speed"})
      if (p.given(turned))
        throw BadParameter(turned, "type-space",
                           "a slider in a spatial model may turn about three axes: give 'tilt' and 'tilt_speed'");
    if (p.word("clearance.initial") >= 0) return;
    read_start(p, "clearance.initial.eccentricity", shift_);
    read_start(p, "clearance.initial.velocity", shift_rate_);
    RelativeMotion<double> motion{};
    motion.d = {0.0, shift_[0], shift_[1]};
    motion.r = {tilt_.tilt[0], tilt_.tilt[1], tilt_.tilt[2]};
    const TurnedMotion<double> start(motion);
    for (std::size_t i = 0; i < BarInGuide::contacts; ++i) {
      // The sizes are rounded numbers: a corner at the wall is none in it.
      if (!(dot(motion.r, motion.r) < 1.0) || bar.place(start, i).penetration > 1e-9 * bar.play)
        throw BadParameter("clearance.initial", "out-of-range",
                           "a corner of the slider would start in the wall: what shift and tilt move it by must stay "
                           "within the gap to each side together");
    }
  }
  /// Of one pair of walls, with the signs of the corners: |y + l theta_z - B_z theta_x| <= g and |z - l theta_y +
  /// B theta_x| <= g_z.
  void set_bounds() {
    const BarInGuide& bar = geometry();
    double* to = bounds_.data();
    for (const double end : {1.0, -1.0}) {
      for (const double side : {1.0, -1.0}) {
        const double across[] = {bar.gap, 0.0, 1.0, 0.0, -side * bar.half_height, 0.0, end * bar.half_length},
                     up[] = {bar.gap_height, 0.0, 0.0, 1.0, side * bar.half_width, -end * bar.half_length, 0.0};
        to = std::copy(std::begin(across), std::end(across), to);
        to = std::copy(std::begin(up), std::end(up), to);
      }
    }
  }
  static void read_start(const Parameters& p, const char* path, std::array<double, 2>& across) {
    across = {WallStart::across(p, path), p.vector(path)[2]};
  }
  static ContactPair surfaces(const Parameters& p, const BarInGuide& bar) {
    ContactPair pair = at_wall(SurfaceShape::corner, bar.play);
    pair.face_length = p.number("clearance.length");
    read_materials(p, pair);
    return pair;
  }
  static BarInGuide read_bar(const Parameters& p) {
    const Radii widths = read_radii(p, bar_width_keys);
    const Radii heights = read_heights(p, widths.clearance);
    if (!widths.known() || !heights.known())
      throw BadParameter("clearance", "missing-key",
                         "a slider in a spatial model needs its 'width' and its 'height': its corners keep it from "
                         "turning about the guide");
    check(widths, "clearance.gap", "'gap' must be below 'width': the play is wider than the slider", p);
    check(heights, "clearance.gap_height", "'gap_height' must be below 'height': the play is wider than the slider", p);
    return {0.5 * p.number("clearance.length"),
            widths.journal,
            heights.journal,
            widths.clearance,
            heights.clearance,
            std::min(widths.clearance, heights.clearance)};
  }
  /// One size alone: with as much play as across the width.
  static Radii read_heights(const Parameters& p, double gap) {
    const bool guide = p.given(bar_height_keys.outer), own = p.given(bar_height_keys.inner),
               play = p.given(bar_height_keys.play);
    if (!guide && !own && !play) return {not_a_number, not_a_number, gap};
    if (play || guide == own) return read_radii(p, bar_height_keys);
    const double half = own ? 0.5 * p.number(bar_height_keys.inner) : 0.5 * p.number(bar_height_keys.outer) - gap;
    if (!(half > 0.0))
      throw BadParameter(bar_height_keys.outer, "out-of-range", "'gap' must be below half of 'guide_height'");
    return {half + gap, half, gap};
  }
  static void check(const Radii& sizes, const char* path, const char* wide, const Parameters& p) {
    if (!(sizes.clearance < 2.0 * sizes.journal)) throw BadParameter(path, "out-of-range", wide);
    if (!(sizes.clearance < 0.5 * p.number("clearance.length")))
      throw BadParameter(path, "out-of-range",
                         "the play must be below half of 'length', or the slider turns over in its guide");
  }

  bool loaded_;
  TiltStart tilt_;
  std::array<double, 2> shift_{}, shift_rate_{};  ///< along y and z [m], [m/s]
  std::array<double, 56> bounds_{};               ///< JointLayout::play_bounds
};

}  // namespace
}  // namespace play

JointFace prismatic_clearance_in_space() { return joint_face<play::BarWithPlay>(); }

}  // namespace freeplay
