// Channels: the named numbers of a result row, in the order of the command-line contract.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/model.h"

namespace freeplay {

struct ChannelInfo {
  std::string name;       ///< KIND.NAME.QUANTITY, or "time"
  std::string_view unit;  ///< SI, model-format spelling; of the core or of the joint's type
};

/// Where the columns of one joint stand in a row; -1 where it has none.
struct JointColumns {
  int coordinate = -1, speed = -1;
  int force = -1;  ///< first of the wrench's columns: fx fy torque; in space fx fy fz tx ty tz
  int power = -1;  ///< of an entry of `forces`
  int penetration = -1, normal_force = -1, contact = -1, eccentricity_x = -1, eccentricity_y = -1, eccentricity_z = -1;
  int friction_force = -1, slip = -1;
  int own = -1;  ///< first of the type's own channels
  /// The column of a role, or null for `none`.
  int* of(ChannelRole role);
};
struct DriverColumns {
  int value = -1, effort = -1, power = -1;
};
/// Pose of an inverse-kinematics frame minus its path.
struct PathColumns {
  int error_x = -1, error_y = -1, error_z = -1, error_angle = -1;  ///< z in space, where the angle is not negative
};
struct ForceColumns {
  int force = -1;  ///< as of joints
  int power = -1;
};
struct EnergyColumns {
  int kinetic = -1, potential = -1, dissipated = -1, work = -1, residual = -1;
};

/// A column that a model has only where something asks for it by the name of its quantity, such as "body.*.ax".
struct AskedColumn {
  int column, element;
  int component = 0;  ///< of an acceleration: 0 to 2 linear, 3 to 5 angular
};
/// A column that the model file gives as a formula; its variables are the numbers of a row.
struct FormulaColumn {
  int column;
  Expression formula;
};

/// All columns of a model, fixed before the first row: time; bodies, joints, drivers, forces, frames in declaration
/// order; energy; what is asked for; formulas.
class Channels {
 public:
  /// `all`: whatever can be asked for, and no formulas.
  explicit Channels(const Model& model, bool all = false);

  std::span<const ChannelInfo> all() const { return all_; }
  /// Index of the column with this name, or -1.
  int find(std::string_view name) const;

  int time = 0;
  /// First of the columns x y angle vx vy omega; in space x y z qw qx qy qz vx vy vz wx wy wz.
  std::vector<int> bodies;
  std::vector<JointColumns> joints;
  std::vector<DriverColumns> drivers;
  std::vector<PathColumns> paths;
  std::vector<ForceColumns> forces;  ///< of applied forces
  std::vector<int> frames;           ///< as for bodies
  EnergyColumns energy;
  std::vector<AskedColumn> body_accelerations, frame_accelerations;  ///< element: body, index into Settings::frames
  std::vector<AskedColumn> driver_work, force_work, joint_loss;      ///< of drivers, Model::force_elements, joints
  std::vector<FormulaColumn> formulas;

  /// The formulas of a row whose other numbers are known; NaN where one has no value.
  void fill_formulas(std::span<double> row) const;

 private:
  void add_asked(const Model& model, bool all);
  void add_formulas(const Model& model);
  int add_wrench(const std::string& prefix);
  void add_drivers(const Model& model);
  JointColumns add_joint(const JointElement& joint, const std::string& prefix);
  int add(std::string name, const char* unit);
  bool planar_;
  std::vector<ChannelInfo> all_;
};

}  // namespace freeplay
