// LoadOptions: what a caller asks of loading, besides changes of the model itself (BuildOptions).
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace freeplay {

struct LoadOptions {
  bool strict = false;               ///< warnings are errors
  std::vector<std::string> plugins;  ///< names or files, besides those that the model names
  /// Get remarks that are about no place of the model, a line each without its end; may be empty.
  std::function<void(const std::string&)> warn{}, note{};
};

}  // namespace freeplay
