// UrdfNames: names of a URDF file as a model file may have them.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "io/urdf_element.h"

namespace freeplay::urdf {

/// The name with each character that no name may have replaced by '_', and `x-` in front, which marks notes, by `x_`.
std::string model_name(const std::string& name);

/// Gives out names of one kind and reports those that are changed (`urdf-renamed`) or taken (`duplicate-name`).
class NameGiver {
 public:
  NameGiver(std::string kind, Messages& messages) : kind_(std::move(kind)), messages_(messages) {}
  std::string give(const std::string& name, const Spot& spot);

 private:
  std::string kind_;
  Messages& messages_;
  std::unordered_map<std::string, int> lines_;
};

}  // namespace freeplay::urdf
