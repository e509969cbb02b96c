// Entry points of the libraries that are linked into the program.
#pragma once

#include <span>

#include "freeplay/plugin.h"

namespace freeplay {

/// In the order of the build's list; the definition is generated from builtin_plugins.cpp.in.
std::span<const PluginEntry> builtin_plugins();

}  // namespace freeplay
