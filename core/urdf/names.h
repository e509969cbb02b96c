// UrdfNames: names of a URDF file as a model file may have them.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "urdf/element.h"

namespace freeplay::urdf {

/// The name with each character that no name may have replaced by '_', and `x-` in front, which marks notes, by `x_`.
std::string model_name(const std::string& name);

/// Gives out names of one kind and reports those that are changed (`urdf-renamed`), too long (`bad-name`) or taken
/// (`duplicate-name`).
class NameGiver {
 public:
  NameGiver(std::string kind, Messages& messages) : kind_(std::move(kind)), messages_(messages) {}
  std::string give(const std::string& name, const Spot& spot);
  /// For one whose own name has a meaning here that it does not have: `name`, followed by '_' while it is taken.
  std::string give_other(std::string name, const Spot& spot);

 private:
  std::string kind_;
  Messages& messages_;
  std::unordered_map<std::string, int> lines_;
};

/// The names of a robot's links and joints in the model. Also of one that has errors already, so that all are reported
/// together; what exists twice in the file has been reported by the reader.
class Names {
 public:
  Names(const Robot& robot, Messages& messages);
  /// For a joint that is not in the file.
  std::string add_joint(const std::string& name, const Spot& spot);

  /// For a frame that is not in the file: the name, followed by '_' as long as a link or joint has it.
  std::string fresh_frame(std::string name) const;

  std::vector<std::string> links, joints;  ///< of each in the robot

 private:
  void refuse_own_frame(const char* kind, const std::string& name, const Spot& spot);

  NameGiver links_, joints_;
  Messages& messages_;
};

}  // namespace freeplay::urdf
