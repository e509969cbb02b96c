#include "system/layout.h"

#include "system/planar_kinematics.h"
#include "system/spatial_kinematics.h"

namespace freeplay {

Layout::Layout(const Model& model, Variant variant) {
  const bool planar = model.space == Space::planar;
  body_coordinates_ = planar ? planar::coordinates : spatial::coordinates;
  body_velocities_ = planar ? planar::velocities : spatial::velocities;
  nq_ = body_coordinates_ * static_cast<int>(model.bodies.size());
  nv_ = body_velocities_ * static_cast<int>(model.bodies.size());
  const auto take = [](int& total, int count) {
    const Slice slice{total, count};
    total += count;
    return slice;
  };
  for (const JointElement& joint : model.joints) {
    const JointLayout& layout = variant == Variant::closed ? joint.ideal_layout : joint.layout;
    JointSlices slices;
    slices.rows = take(nc_, layout.constraint_rows);
    slices.internal = take(nz_, layout.internal_variables);
    slices.history = take(nh_, layout.history);
    if (layout.coordinate == Coordinate::angle) slices.turn = take(nh_, 1).offset;
    joints_.push_back(slices);
  }
  first_driver_row_ = nc_;
  for (const Driver& driver : model.drivers) drivers_.push_back(prescribes(driver.kind) ? nc_++ : -1);
}

}  // namespace freeplay
