#include "system/layout.h"

#include "base/index.h"
#include "system/planar_kinematics.h"
#include "system/spatial_kinematics.h"

namespace freeplay {

Layout::Layout(const Model& model, Variant variant, std::span<const planar::DrivenBody> driven) {
  const bool planar = model.space == Space::planar;
  body_coordinates_ = planar ? planar::coordinates : spatial::coordinates;
  body_velocities_ = planar ? planar::velocities : spatial::velocities;
  std::vector<char> is_driven(model.bodies.size(), 0), holds(model.joints.size(), 0), drives(model.drivers.size(), 0);
  for (const planar::DrivenBody& body : driven) {
    is_driven[at(body.body)] = holds[at(body.joint)] = 1;
    if (body.driver >= 0) drives[at(body.driver)] = 1;
  }
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (is_driven[at(b)] == 0) bodies_.push_back(b);
  }
  free_bodies_ = static_cast<int>(bodies_.size());
  for (const planar::DrivenBody& body : driven) bodies_.push_back(body.body);
  places_.resize(bodies_.size());
  for (std::size_t place = 0; place < bodies_.size(); ++place) places_[at(bodies_[place])] = static_cast<int>(place);
  nq_ = body_coordinates_ * free_bodies_;
  nv_ = body_velocities_ * free_bodies_;
  const auto take = [](int& total, int count) {
    const Slice slice{total, count};
    total += count;
    return slice;
  };
  joints_.resize(model.joints.size());
  drivers_.assign(model.drivers.size(), -1);
  const auto take_rows = [&](bool held) {
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const JointElement& joint = model.joints[j];
      const JointLayout& layout = variant == Variant::closed ? joint.ideal_layout() : joint.layout;
      if ((holds[j] != 0) == held) joints_[j].rows = take(all_rows_, layout.constraint_rows);
    }
    if (!held) first_driver_row_ = all_rows_;
    for (std::size_t d = 0; d < drivers_.size(); ++d) {
      if ((drives[d] != 0) == held && prescribes(model.drivers[d].kind)) drivers_[d] = all_rows_++;
    }
  };
  take_rows(false);
  nc_ = all_rows_;
  take_rows(true);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const JointElement& joint = model.joints[j];
    const JointLayout& layout = variant == Variant::closed ? joint.ideal_layout() : joint.layout;
    joints_[j].internal = take(nz_, layout.internal_variables);
    joints_[j].history = take(nh_, layout.history);
    if (layout.coordinate == Coordinate::angle) joints_[j].turn = take(nh_, 1).offset;
  }
  int switches = 0;
  for_each_motion_formulas(model, [&](const MotionFormulas& formulas) { switches += formulas.switches(); });
  switches_ = take(nh_, switches);
  for (const Driver& driver : model.drivers) take(nh_, driver.input ? static_cast<int>(numbers_of_input) : 0);
}

}  // namespace freeplay
