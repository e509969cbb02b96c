// Reading: what a value of the model file sees while it is read, and where its mistakes go.
#pragma once

#include <string>

#include "base/diagnostics.h"

namespace freeplay {

class ParameterScope;
class PathOverrides;
class PresetTable;
class Readout;

/// One for the top level, one for each instance of a template. Referred to by every value that is read in it.
struct Reading {
  Diagnostics* diagnostics;
  const ParameterScope* scope;
  const PresetTable* presets = nullptr;
  Readout* readout = nullptr;      ///< keeps what is read; null where it is not wanted
  std::string instance{};          ///< full name of the instance; empty at top level
  double start_time = 0.0;         ///< time functions are tried here [s]
  std::size_t dimensions = 2;      ///< of vectors: 2 in planar, 3 in spatial models
  PathOverrides* paths = nullptr;  ///< values in the place of others; null: none
};

}  // namespace freeplay
