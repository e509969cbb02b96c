// PluginExamination: what `freeplay check-plugin` finds out about a library, without ever loading it into this process.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "contract/finding.h"

namespace freeplay {

struct ExaminationOptions {
  std::vector<std::filesystem::path> companions;  ///< libraries that are loaded first
  std::uint64_t seed = 1;
  double time_limit = 60.0;  ///< of all together [s]
};

/// One type of the library. It keeps its contract if all rules are held and nothing failed.
struct ExaminedType {
  std::string name, kind;
  Json parameters;             ///< as `freeplay describe --json` shows them
  std::vector<Finding> rules;  ///< in the order of examination; after a failure those that were reached
  std::string failure;         ///< that it crashed, left or did not return, and in which function; else empty
  std::string printed;         ///< what the library wrote to stdout and stderr
  bool held() const;
};

struct Examination {
  std::string library, name, version, compiler;
  int abi = 0;
  std::vector<ExaminedType> types;
  std::string printed;  ///< while it was loaded
  bool held() const;
};

/// The types that are built in stand under this word.
inline constexpr const char* builtin_word = "built-in";

/// Loads the library and runs the contract of each of its types, each in a process of its own, all at the same time.
/// Throws Error{plugin}: what refuses the library, or "plugin-failed" when it crashes, leaves or hangs while it is
/// loaded.
Examination examine_plugin(const std::filesystem::path& library, const ExaminationOptions& options);

}  // namespace freeplay
