// AppliedForces: what drivers by an effort and the forces of the model (Model::forces) exert, and the parameters of
// joints that depend on the motion.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "system/motion_channels.h"

namespace freeplay {

struct BodyPair;

class AppliedForces {
 public:
  AppliedForces(const Model& model, const Layout& layout, const Markers& markers, const Joints& joints);

  bool empty() const { return effort_drivers_.empty() && model_.forces.empty() && loads_.empty(); }
  /// Adds the pairs of bodies by which forces that depend on the motion change (Forces::pairs). Once, when all others
  /// are in the list.
  void add_pairs(std::vector<BodyPair>& pairs);
  /// Numbers of ForceValues::channel_space.
  std::size_t channel_numbers() const { return 2 * most_channels_ + most_formulas_; }
  /// Adds them to ForceValues::force and fills ForceValues::applied and, with `derivatives`, the part of force_q and
  /// force_v that belongs to its pairs. False with Evaluation::fault where an expression has no value.
  bool add(const Point& point, bool derivatives, Evaluation& e) const;

  /// ForceValues::functions where markers and coordinates are. False with Evaluation::fault where one has no value.
  bool set_functions(const Point& point, Evaluation& e) const;

  /// What decides the switches of all formulas (Layout::switches) and its rate for the accelerations `a` of the
  /// unknowns, at an evaluated point (forces or events); NaN where it has none. `room`: switch_numbers() numbers.
  void decide(const Point& point, std::span<const double> a, const Evaluation& e, std::span<double> room,
              std::span<double> values, std::span<double> rates) const;
  /// The values alone.
  void decide(const Point& point, const Evaluation& e, std::span<double> room, std::span<double> values) const;
  /// By how much what decides them changes, in all, where positions change by 1 m, angles by 1 m at the distance
  /// `size`, velocities by as much in 1 s, and time by 1 s.
  void scale(const Point& point, double size, const Evaluation& e, std::span<double> room,
             std::span<double> scales) const;
  /// The side of each at this point, by its value; at zero, or without a value, it stays, and one that was not known
  /// (0) goes by the rate. Returns whether one changes, or is decided by its rate.
  bool take_sides(const Point& point, std::span<const double> a, const Evaluation& e, std::span<double> room,
                  std::span<double> sides) const;
  std::size_t switch_numbers() const { return 2 * (most_channels_ + switches_); }
  /// "force 'x'", "joint 'x'" or "driver 'x'", of whose formula a switch is.
  std::string words_of_switch(int index) const;

 private:
  /// Derivatives of the generalised force on a body by the motion of a body: where they stand in force_q and force_v.
  struct Block {
    BodyId row = ground, column = ground;
    std::size_t offset = 0;
  };
  /// A force, the effort of a driver, or the parameters of a joint, that depend on the motion.
  struct Load {
    const MotionFormulas* formulas = nullptr;
    int force = -1, driver = -1, joint = -1;  ///< one of them
    int first_switch = 0;
    BodyId own[2] = {ground, ground};  ///< unknowns that it acts on
    std::vector<Block> blocks{};
    std::size_t first_number = 0, numbers = 0;  ///< of all its pairs in force_q and force_v
  };

  void add_load(const MotionFormulas& formulas, const Load& of);
  void own_joint(Load& load, int joint) const;
  void add_pairs(Load& load, std::vector<BodyPair>& pairs) const;
  bool add_effort(int driver, const Point& point, Evaluation& e) const;
  bool add_force(std::size_t index, const Point& point, Evaluation& e) const;
  bool values(const Load& load, const Point& point, Evaluation& e, double* value) const;
  void wrench_of(const AppliedForce& force, const MarkerKinematics& k, const double* value, double* wrench) const;
  void on_bodies(const Load& load, const double* value, const Evaluation& e,
                 double (&forces)[2][spatial::velocities]) const;
  bool add_derivatives(const Load& load, const Point& point, Evaluation& e) const;
  bool find_slopes(const Load& load, const Point& point, Evaluation& e) const;
  void add_own_turn(const Load& load, Evaluation& e) const;
  StateFormula::Input input(const Load& load, const Point& point, const Evaluation& e, std::span<double> room) const;
  void take_inputs(const Point& point, Evaluation& e) const;

  const Model& model_;
  const Layout& layout_;
  const Markers& markers_;
  const Joints& joints_;
  MotionChannels channels_;
  std::vector<int> effort_drivers_;
  std::vector<Load> loads_;
  std::vector<int> load_of_force_, load_of_driver_;  // -1: it depends on time alone
  std::size_t most_channels_ = 0, most_formulas_ = 3, switches_ = 0;
  bool has_functions_ = false;
};

}  // namespace freeplay
