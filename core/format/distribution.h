// Distribution: what a random axis of a study is drawn from.
#pragma once

#include <limits>
#include <optional>

#include "format/map_reader.h"

namespace freeplay {

struct Distribution {
  enum class Kind {
    normal,     ///< mean a, standard deviation b
    uniform,    ///< from a to b
    triangular  ///< from a over the mode b to c
  };
  Kind kind = Kind::uniform;
  double a = 0.0, b = 1.0, c = 0.0;                                                                       ///< [SI]
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();  ///< cut there
};

/// Reads `normal`, `uniform` or `triangular` and `truncate` of an axis, of any dimension, which becomes `dimension`.
/// Nothing where none of them stands there, or after an error.
std::optional<Distribution> read_distribution(MapReader& axis, std::optional<Dimension>& dimension);

/// A low and a high end, the second larger. Nothing after an error.
std::optional<std::pair<double, double>> read_ends(const CheckedValue& value, std::optional<Dimension>& dimension);

}  // namespace freeplay
