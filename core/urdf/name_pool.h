// UrdfNamePool: names that nothing else in a file has.
#pragma once

#include <string>
#include <unordered_map>
#include <unordered_set>

namespace freeplay::urdf {

/// Gives out names that nothing else has.
class NamePool {
 public:
  void take(const std::string& name) { taken_.insert(name); }
  bool has(const std::string& name) const { return taken_.contains(name); }
  /// The name, with a number behind it where something else has it.
  std::string fresh(const std::string& name) {
    std::string given = name;
    while (!taken_.insert(given).second)
      given = name + "-" + std::to_string(++numbers_.try_emplace(name, 1).first->second);
    return given;
  }

 private:
  std::unordered_set<std::string> taken_;
  std::unordered_map<std::string, int> numbers_;  ///< the last that was given, by name
};

}  // namespace freeplay::urdf
