// DrivenMotion: bodies whose motion is a function of time, and the loads of the rows that hold them.
#pragma once

#include <span>
#include <vector>

#include "system/constraints.h"
#include "system/driven_bodies.h"
#include "system/inertia.h"

namespace freeplay {

/// Driven bodies at one time, besides their places in MarkerValues.
struct DrivenValues {
  explicit DrivenValues(std::size_t bodies);

  std::vector<double> driven_a;     ///< accelerations
  std::vector<double> driven_load;  ///< work space: loads on them
  double driven_time;               ///< that they are placed for; NaN: none
};

class DrivenMotion {
 public:
  /// `bodies`: planar::driven_bodies(), or none.
  DrivenMotion(std::span<const planar::DrivenBody> bodies, const Layout& layout, const Markers& markers,
               const Joints& joints, const Constraints& constraints, const Inertia& inertia, const Motions& motions);

  bool empty() const { return bodies_.empty(); }
  std::size_t count() const { return bodies_.size(); }

  /// Places them and their markers for the motions of drivers in `e`.
  void place(const Point& point, Evaluation& e) const;
  /// Angles are known from the joints up to whole turns: they become those nearest to the angles in `q`, the
  /// coordinates of all bodies in the order of the model.
  void count_turns(std::span<const double> q, const Point& point, Evaluation& e);

  /// Adds the loads of driven bodies after the multipliers of the unknowns: `lambda` has Layout::all_rows() numbers.
  /// `e` holds all forces.
  void recover_loads(Evaluation& e, std::span<double> lambda) const;
  /// The same for impulses: rows of free bodies have given `impulse`, and driven bodies changed their velocities (3
  /// numbers each) by `change`.
  void recover_impulses(Evaluation& e, std::span<const double> change, std::span<double> impulse) const;
  /// Power of the rows of joints between free and driven bodies on the driven ones, with the opposite sign [W].
  double power(const Evaluation& e, std::span<const double> lambda) const;
  /// The row that holds a driven body last: that of its driver, if it has one.
  int last_row(std::size_t driven) const { return bodies_[driven].rows[2]; }

 private:
  /// How a driven body is held: one marker of its own at one of its parent.
  struct Body {
    BodyId place = ground, parent = ground;
    int joint = -1, driver = -1, own_marker = 0, parent_marker = 0;
    double sign = 1.0;   // of the coordinate: 1 for the joint's second body
    double angle = 0.0;  // of the body beyond its parent's and the coordinate [rad]
    bool slides = false, modulo_turns = false;
    int turn_row = 2;  // of a pin or a weld, in `rows`; the others are of its x and y
    int turn = -1;     // into h
    int rows[3] = {};
    int offsets[3] = {};                   // of these rows in its own columns
    int parent_offsets[3] = {-1, -1, -1};  // and in those of its parent, where that is driven, too
  };
  void add(const planar::DrivenBody& body, const Joints& joints, const Motions& motions);
  /// From the last body to the first: what the rows of one do not take from `force`, three numbers for each driven
  /// body, is taken by nothing.
  void solve_for_loads(Evaluation& e, std::span<double> force, std::span<double> lambda) const;
  void solve_slide(const Body& body, const Evaluation& e, const double* force, double* on_parent,
                   std::span<double> lambda) const;

  const Layout& layout_;
  const Markers& markers_;
  const Constraints& constraints_;
  const Inertia& inertia_;
  std::vector<Body> bodies_;  // in the order of their places
  bool has_slides_ = false;   // among them
};

}  // namespace freeplay
