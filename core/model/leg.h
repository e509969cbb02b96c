// Leg: closed-form inverse kinematics of a crank and a coupler that carry a platform.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "base/jet.h"
#include "model/model.h"

namespace freeplay {

/// Ground pin A - crank - pin B - coupler - pin C on the platform. The crank's direction A to B follows from C by
///   w1 cos + w2 sin = w3,  (w1, w2) = 2 l1 (C - A),  w3 = |C - A|^2 + l1^2 - l2^2
///   direction = atan2(w2, w1) + elbow atan2(r, w3) = atan2(w2 w3 + elbow r w1, w1 w3 - elbow r w2),
///   r = sqrt(w1^2 + w2^2 - w3^2)
/// Zhang and Zhang 2016, eq. (4), in the atan2 form that keeps its digits near stretch.
struct Leg {
  std::string name;                   ///< of the driven joint
  double ax = 0.0, ay = 0.0;          ///< pin A, world axes [m]
  double crank = 0.0, coupler = 0.0;  ///< lengths l1, l2 [m]
  double cx = 0.0, cy = 0.0;          ///< pin C relative to the path's frame, platform body axes [m]
  double crank_direction = 0.0;       ///< of A to B in the crank's body axes [rad]
  double coupler_direction = 0.0;     ///< of B to C in the coupler's body axes [rad]
  double coordinate_offset = 0.0;     ///< joint coordinate minus the crank's body angle [rad]
  int elbow = 1;
  int crank_body = 0, coupler_body = 0;
  double crank_pin_x = 0.0, crank_pin_y = 0.0;      ///< pin A in the crank's body frame [m]
  double coupler_pin_x = 0.0, coupler_pin_y = 0.0;  ///< pin B in the coupler's body frame [m]
};

/// Pin A - crank - pin B - coupler - pin C on the platform, as markers of the model. The crank hangs on ground or on
/// another body.
struct LegChain {
  int crank_at_a = 0, crank_at_b = 0, coupler_at_b = 0, coupler_at_c = 0, platform_at_c = 0;
};

/// The chain that joint `driven` moves below marker `frame`; nothing when it has another shape.
std::optional<LegChain> find_leg_chain(const Model& model, int driven, int frame);

/// The leg on ground that drives joint `driven` under a path of marker `frame`; nothing when the chain has another
/// shape.
std::optional<Leg> find_leg(const Model& model, int driven, int frame);

/// The leg of a driver by inverse kinematics whose path gives x, y and angle; nothing for other drivers.
std::optional<Leg> closed_form_leg(const Model& model, int driver);

/// Angle of the crank's body [rad], principal value, with derivatives.
struct CrankPose {
  Jet crank;
  bool reachable = true;
  double distance = 0.0;  ///< of A and C [m]
};

/// The same with the angle of the coupler's body.
struct LegPose : CrankPose {
  Jet coupler;
};

/// How the platform's body is turned [rad]: once for all its legs.
struct PlatformTurn {
  PlatformTurn() = default;
  PlatformTurn(const Jet& turned) : angle(turned), cosine(std::cos(turned.value)), sine(std::sin(turned.value)) {}
  Jet angle;
  double cosine = 1.0, sine = 0.0;
};

/// `x`, `y` [m]: position of the path's frame.
CrankPose solve_crank(const Leg& leg, const Jet& x, const Jet& y, const PlatformTurn& platform);
LegPose solve_leg(const Leg& leg, const Jet& x, const Jet& y, const PlatformTurn& platform);

/// Angles of the bodies of crank and coupler [rad], principal values, without derivatives. A leg that is just stretched
/// or folded, up to rounding, is in reach.
struct LegAngles {
  double crank = 0.0, coupler = 0.0;
  bool reachable = true;
  double distance = 0.0;  ///< of A and C [m]
};

/// `x`, `y` [m]: position of the path's frame; cosine and sine of the angle of the platform's body.
LegAngles leg_angles(const Leg& leg, double x, double y, double cosine, double sine);

}  // namespace freeplay
