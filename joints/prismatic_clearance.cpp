#include <algorithm>
#include <cmath>
#include <utility>

#include "freeplay/kit/planar_slide.h"
#include "freeplay/kit/wall_play.h"
#include "freeplay/plugin.h"
#include "prismatic_clearance_in_space.h"

namespace freeplay {
namespace play {
namespace {

constexpr SizeKeys width_keys{"clearance.guide_width", "clearance.width", "clearance.gap", 2.0, 2.0};

/// The four corners of a block of length l and width 2 B, centred on b, between walls at +-(B + g) along the x axis of
/// a. In the order front and rear upper, front and rear lower; front is +x of b.
struct BlockInGuide {
  static constexpr std::size_t contacts = 4;
  static double side(std::size_t i) { return i < 2 ? 1.0 : -1.0; }
  static double end(std::size_t i) { return i % 2 == 0 ? 1.0 : -1.0; }

  template <class T>
  ContactPlace<T> place(const PlanarMotion<T>& m, std::size_t i) const {
    const double along = end(i) * half_length, across = side(i) * half_width;
    const T rise = T(along) * m.s;
    return {T(side(i)) * (m.d.y + rise) - T(half_width) * sag(m) - T(play),
            {T(0.0), T(side(i))},
            {T(along) * m.c - T(across) * m.s, rise + T(across) * m.c},
            -side(i)};
  }
  /// 1 - cos without the loss of digits of a difference; past a quarter turn the block is none.
  template <class T>
  static T sag(const PlanarMotion<T>& m) {
    return space::value_of(m.c) > 0.0 ? (m.s * m.s) / (T(1.0) + m.c) : T(1.0) - m.c;
  }

  static std::array<double, 2> stand(const PlanarMotion<double>& m) { return {m.d.y, std::atan2(m.s, m.c)}; }
  static constexpr bool between_walls() { return true; }
  /// Of a corner from the middle.
  double reach() const { return std::hypot(half_length, half_width); }

  double half_length, half_width;  ///< [m]
  double play;                     ///< g, to each side [m]
};

constexpr const char* corner_events[] = {
    "front_upper_contact_begin", "front_upper_contact_end", "rear_upper_contact_begin", "rear_upper_contact_end",
    "front_lower_contact_begin", "front_lower_contact_end", "rear_lower_contact_begin", "rear_lower_contact_end"};
constexpr auto all_events = contact_events(corner_events);
constexpr auto all_event_roles = contact_event_roles<all_events.size()>();

constexpr Channel slide_channels[] = {{"shift", "m"},
                                      {"tilt", "rad"},
                                      {"delta", "m"},
                                      {"fn", "N"},
                                      {"ft", "N"},
                                      {"power", "W"},
                                      {"contact", "1"},
                                      {"vt", "m/s"},
                                      {"front_upper_delta", "m"},
                                      {"front_upper_fn", "N"},
                                      {"front_upper_ft", "N"},
                                      {"rear_upper_delta", "m"},
                                      {"rear_upper_fn", "N"},
                                      {"rear_upper_ft", "N"},
                                      {"front_lower_delta", "m"},
                                      {"front_lower_fn", "N"},
                                      {"front_lower_ft", "N"},
                                      {"rear_lower_delta", "m"},
                                      {"rear_lower_fn", "N"},
                                      {"rear_lower_ft", "N"}};
constexpr ChannelRole slide_roles[] = {
    ChannelRole::none,           ChannelRole::none, ChannelRole::penetration, ChannelRole::normal_force,
    ChannelRole::friction_force, ChannelRole::none, ChannelRole::in_contact,  ChannelRole::slip_speed,
    ChannelRole::none,           ChannelRole::none, ChannelRole::none,        ChannelRole::none,
    ChannelRole::none,           ChannelRole::none, ChannelRole::none,        ChannelRole::none,
    ChannelRole::none,           ChannelRole::none, ChannelRole::none,        ChannelRole::none};

/// Where the block starts in its guide: besides its shift its tilt, and how fast that grows.
struct SlideStart : WallStart {
  explicit SlideStart(const Parameters& p) : WallStart(p) {
    if (p.given("clearance.initial.angle")) tilt = p.number("clearance.initial.angle");
    if (p.given("clearance.initial.speed")) tilt_rate = p.number("clearance.initial.speed");
  }
  double tilt = 0.0, tilt_rate = 0.0;  // [rad], [rad/s]
};

/// Slider with play in its guide, in the plane: a block of length l and width 2 B (marker b in its middle) between two
/// walls at +-(B + g) along the x axis h of marker a, n normal to it. No constraint rows. Its four corners touch by a
/// contact law and a friction law, each by itself; corner i has s_i = (+-l/2, sigma B) in the axes of b, sigma = +1 for
/// the upper two, and meets its own wall only. With the angle Theta of b against a and d = P_b - P_a
///
///   delta_i = sigma (n.d + s_x sin(Theta)) - B (1 - cos(Theta)) - g
///
/// `planar_contacts.h` has what follows from it. One corner, two on a side or two opposite ones are not distinguished;
/// as the block lays itself flat, its two corners tend to the same force. Where only g is known, B counts as zero:
/// friction is then inert. Flores, Ambrosio, Claro and Lankarani 2008, J Comput Nonlinear Dyn 3, 011007; Flores, Leine
/// and Glocker 2010, Multibody Syst Dyn 23.
class PrismaticClearance final : public PlanarContacts<BlockInGuide> {
 public:
  explicit PrismaticClearance(const Parameters& p) : PrismaticClearance(p, read_radii(p, width_keys)) {}

  void declare(JointLayout& layout) const override {
    declare_contacts(layout);
    layout.coordinate = Coordinate::position;
    layout.planar_coordinate = 1;
    layout.play_shape = PlayShape::walls;
    layout.contact_reach = geometry().reach();
    layout.contact_length = 2.0 * geometry().half_length;
    layout.events = {all_events.data(), all_events.size()};
    layout.event_roles = {all_event_roles.data(), all_event_roles.size()};
    layout.channels = slide_channels;
    layout.channel_roles = slide_roles;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override { planar::Slide(in).write_along(row); }
  /// Loaded, one corner at each end rests where static contact carries the force across and the moment together.
  void initial_offset(Span<const double> reaction, InitialOffset& out) const override {
    const Eigen::Vector2d n = across_walls(out);
    Stand stand{start_.shift, start_.tilt};
    if (start_.loaded)
      stand = rest(n.dot(Eigen::Vector2d(reaction[0], reaction[1])), reaction.size > 5 ? reaction[5] : 0.0);
    write_start(n, stand.shift, start_.shift_rate, out);
    out.turn = stand.tilt;
    out.turn_rate = start_.tilt_rate;
  }

 private:
  static ContactPair corner_at_wall(double play, double length) {
    ContactPair pair = at_wall(SurfaceShape::corner, play);
    pair.face_length = length;
    return pair;
  }
  PrismaticClearance(const Parameters& p, const Radii& widths)
      : PlanarContacts({0.5 * p.number("clearance.length"), widths.known() ? widths.journal : 0.0, widths.clearance},
                       wall_laws(p, corner_at_wall(widths.clearance, p.number("clearance.length")))),
        start_(p) {
    for (const char* height : {"clearance.guide_height", "clearance.height", "clearance.gap_height"})
      if (p.given(height))
        throw BadParameter(height, "type-space", "a slider has a height in spatial models only; its width is 'width'");
    refuse_tilt(p, "a slider of a planar model turns about one axis: give 'angle' and 'speed'");
    const BlockInGuide& block = geometry();
    if (widths.known() && !(block.play < 2.0 * widths.journal))
      throw BadParameter("clearance.gap", "out-of-range",
                         "'gap' must be below 'width': the play is wider than the slider");
    if (!(block.play < block.half_length))
      throw BadParameter("clearance.gap", "out-of-range",
                         "'gap' must be below half of 'length', or the slider turns over in its guide");
    if (!widths.known() && !is_inert(laws().friction))
      throw BadParameter("clearance", "missing-key", "friction needs 'guide_width' or 'width'");
    PlanarMotion<double> motion{};
    motion.d.y = start_.shift;
    motion.c = std::cos(start_.tilt);
    motion.s = std::sin(start_.tilt);
    for (std::size_t i = 0; i < BlockInGuide::contacts; ++i) {
      // The sizes are rounded numbers: a corner at the wall is none in it.
      if (!(motion.c > 0.0) || block.place(motion, i).penetration > 1e-9 * block.play)
        throw BadParameter("clearance.initial", "out-of-range",
                           "a corner would start in the wall: shift and half the length times the sine of the angle "
                           "must stay within 'gap' together");
    }
  }
  struct Stand {
    double shift, tilt;  // [m], [rad]
  };
  /// Static equilibrium under a force along n and a moment on b. The tilt moves the corners, by which arms and depths
  /// change a little: a few rounds settle it.
  Stand rest(double across, double moment) const {
    const BlockInGuide& block = geometry();
    const double half = block.half_length;
    double shift = 0.0, c = 1.0, s = 0.0, front = 0.5 * (across + moment / half), rear = 0.5 * (across - moment / half);
    for (int i = 0; i < 50; ++i) {
      const double arm_front = half * c + std::copysign(block.half_width, front) * s,
                   arm_rear = -half * c + std::copysign(block.half_width, rear) * s;
      front = (moment - arm_rear * across) / (arm_front - arm_rear);
      rear = across - front;
      const double sag = block.half_width * (s * s) / (1.0 + c);
      const double end_front = rest_at_wall(laws().normal, block.play, front, sag),
                   end_rear = rest_at_wall(laws().normal, block.play, rear, sag);
      const double last = std::exchange(s, std::clamp(0.5 * (end_front - end_rear) / half, -0.9, 0.9));
      shift = 0.5 * (end_front + end_rear);
      c = std::sqrt(1.0 - s * s);
      if (s == last) break;
    }
    return {shift, std::asin(s)};
  }
  SlideStart start_;
};

constexpr Parameter width_rows[] = {
    length("clearance.guide_width", "Distance of the walls of the guide on the first body."),
    length("clearance.width", "Width of the slider across the guide."),
    length("clearance.gap", "Play to each side: half of the guide's width minus the slider's."),
    length("clearance.guide_height", "Spatial models: distance of the walls across z of the first frame."),
    length("clearance.height", "Spatial models, where it is needed: size of the slider along z of its frame."),
    length("clearance.gap_height", "Spatial models: play to each side across z; `gap` unless given."),
    {.name = "clearance.length",
     .unit = "m",
     .default_value = required,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Length of the slider along the guide; its middle is the second frame."},
};
constexpr Parameter tilt_rows[] = {
    {.name = "clearance.initial.angle",
     .unit = "rad",
     .default_value = optional,
     .summary = "Planar models: angle of the slider against the guide at the start."},
    {.name = "clearance.initial.speed",
     .unit = "rad/s",
     .default_value = optional,
     .summary = "Planar models: angular velocity of the slider against the guide at the start."},
    {.name = "clearance.initial.tilt",
     .kind = ParameterKind::vector,
     .unit = "rad",
     .default_value = optional,
     .summary = "Spatial models: rotation vector of the slider in its guide at the start, in the axes of the guide."},
    {.name = "clearance.initial.tilt_speed",
     .kind = ParameterKind::vector,
     .unit = "rad/s",
     .default_value = optional,
     .summary = "Spatial models: angular velocity of the slider in its guide at the start, in the axes of the guide."},
};
constexpr auto prismatic_clearance_parameters = joined(width_rows, law_rows, wall_start_rows, tilt_rows);

}  // namespace
}  // namespace play

Component prismatic_clearance() {
  using namespace play;
  return joint<PrismaticClearance>(
      {.name = "prismatic-clearance",
       .space = Space::both,
       .summary = "Slider with play: a block between walls, which its corners touch by a contact law.",
       .formula =
           "corner i at (+-length/2, sigma width/2) of the slider, sigma = +1 above and -1 below: delta = sigma (n.d + "
           "s_x sin(Theta)) - width/2 (1 - cos(Theta)) - gap, d = P_b - P_a, n normal to the guide, Theta the angle "
           "between both; force on the slider -sigma F_N n + F_T h at the corner for delta > 0, each corner by itself. "
           "In "
           "space eight corners at (+-length/2, +-width/2, +-height/2), each before a wall across y and one across z, "
           "with half of the force at each.",
       .validity = "Gap small against the length; a guide without ends; rigid faces apart from the corners.",
       .references = "Flores, Ambrosio, Claro and Lankarani 2008, J Comput Nonlinear Dyn 3, 011007; Flores, Leine and "
                     "Glocker 2010, Multibody Syst Dyn 23, 165-190",
       .parameters = {prismatic_clearance_parameters.data(), prismatic_clearance_parameters.size()},
       .ideal = "prismatic",
       .block = "clearance",
       .axis = MarkerAxis::x,
       .in_space = prismatic_clearance_in_space()});
}

}  // namespace freeplay
