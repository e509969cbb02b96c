// Version: of the program and of the formats that it writes.
#pragma once

namespace freeplay {

inline constexpr const char* program_version = FREEPLAY_VERSION;

#ifdef __clang__
inline constexpr const char* compiler = "clang " __clang_version__;
#else
inline constexpr const char* compiler = "gcc " __VERSION__;
#endif

/// Of the model file, of summary.json and of the result files.
inline constexpr int schema_version = 1;

}  // namespace freeplay
