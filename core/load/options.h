// LoadWords, LoadOptions: what a caller asks of loading, besides changes of the model itself (BuildOptions).
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace freeplay {

/// The same words on the command line and of a script.
struct LoadWords {
  bool strict = false;               ///< warnings are errors
  std::vector<std::string> plugins;  ///< names or files, besides those that the model names
  bool allow_plugins = false;        ///< run the code of libraries that only a model or a result names
  /// Files that a result which goes on or is made again was made with; loaded as those that a model names.
  std::vector<std::string> recorded_plugins{};
};

struct LoadOptions : LoadWords {
  /// Get remarks that are about no place of the model, a line each without its end; may be empty.
  std::function<void(const std::string&)> warn{}, note{};
};

}  // namespace freeplay
