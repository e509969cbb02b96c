// IdealMechanism: a model with every clearance closed and its inputs free, and how it falls apart into legs.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "analysis/platform.h"
#include "analysis/play_hull.h"
#include "model/leg.h"
#include "system/system.h"

namespace freeplay {

/// Where all bodies are.
struct Posture {
  std::vector<double> q;  ///< coordinates of all bodies, as System has them
  std::vector<double> h;  ///< history of the closed system: turns that angles are counted in
};

/// Bodies that hang together when platform and ground are taken away, with what ties them: a leg, mostly. A joint
/// between platform and ground is a part without bodies.
struct Limb {
  std::vector<BodyId> bodies;
  std::vector<int> rows;    ///< of the closed system
  std::vector<int> inputs;  ///< places in Platform::inputs
  std::vector<int> plays;   ///< places in IdealMechanism::plays()
  std::optional<Leg> leg;   ///< its closed form: crank and coupler on pins, driven at ground
};

/// What the play of a joint lets its second marker do: displacements sum of twist_k delta_k with |delta| <= radius. In
/// the plane a disc: a massless link of length `radius` between the two markers. In space a ball; or, of a bearing that
/// has a length, two discs and a segment: the eccentricities of the axis at both ends of the bearing (their mean is a
/// shift, their difference over the length a tilt) and the shift along the axis. Of a joint that declares bounds of its
/// play a polytope.
struct Play {
  int joint = 0;          ///< index into Model::joints
  double radius = 0.0;    ///< [m]
  int size = 2;           ///< numbers of delta: 1, 2 or 3, of a polytope up to 6
  bool own_axes = false;  ///< twists are along the axes of the first marker, else along those of the world
  std::vector<std::array<double, 6>> twist{};  ///< by number: shift [m/m], rotation vector [rad/m]
  const char* part = "";                   ///< of several of one joint: ".upper", ".lower" (ends), ".axial", ".front"
  int place = 0;                           ///< of its first number among those of all plays
  std::shared_ptr<const PlayHull> hull{};  ///< of a polytope: all delta/radius
};

class IdealMechanism {
 public:
  /// Drivers of joints that are no inputs stay at work. `model` must outlive the mechanism. Throws what assemble()
  /// throws where a start is needed: when some leg has no closed form.
  IdealMechanism(const Model& model, Platform platform);
  IdealMechanism(const IdealMechanism&) = delete;
  IdealMechanism& operator=(const IdealMechanism&) = delete;

  /// The model without the drivers of inputs; bodies, markers and joints have the numbers of the original.
  const Model& model() const { return *model_; }
  /// Closed; its rows are joints, then drivers that stay.
  const System& system() const { return *system_; }
  const Platform& platform() const { return platform_; }
  BodyId platform_body() const { return body_; }
  std::span<const Limb> parts() const { return parts_; }
  /// By joint, radius greater than 0: of joints with clearance, or as `analysis: {error: {clearance}}` says.
  std::span<const Play> plays() const { return plays_; }
  /// Numbers of all plays together.
  int play_numbers() const { return plays_.empty() ? 0 : plays_.back().place + plays_.back().size; }
  const PoseForm& form() const { return pose_form(model_->space); }
  /// Error of each input [rad or m].
  double input_error() const { return model_->analysis.input; }
  bool is_angle(int input) const;
  /// Length L that makes angles comparable with positions: from the frame to the farthest joint of the platform [m].
  double length() const { return length_; }
  /// Of an angle: distance on the driven body from the input to that body's next joint [m]; 1 for a slide.
  double crank_length(int input) const { return cranks_[static_cast<std::size_t>(input)]; }

  /// Are all bodies found in closed form from the pose of the platform?
  bool closed_form() const { return closed_form_; }
  /// The assembled start with closed clearances; the mechanism is assembled when it is first asked for.
  const Posture& start();
  /// What drivers prescribe for the inputs at time t [rad or m, with derivatives]. Throws Error{input} "missing-key"
  /// when an input has no such driver, Error{numerical} where one has no value.
  std::vector<Jet> driven_inputs(double t);

 private:
  bool ties(int joint) const;
  std::vector<BodyId> bodies_of(int joint) const;
  void find_parts();
  void find_legs();
  void find_plays();
  void add_play(int joint, double radius);
  void find_lengths();
  void assemble_start();

  const Model& original_;
  Platform platform_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<System> system_;
  BodyId body_ = ground;
  std::vector<Limb> parts_;
  std::vector<Play> plays_;
  std::vector<double> cranks_;
  double length_ = 1.0;
  bool closed_form_ = false;
  std::optional<Posture> start_;
  std::unique_ptr<System> released_;  ///< of the original model, assembled; with start_
};

}  // namespace freeplay
