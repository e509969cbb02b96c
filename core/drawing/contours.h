// Contours: lines and regions of a field on a grid.
#pragma once

#include <array>
#include <vector>

#include "svg/page.h"

namespace freeplay {

/// "Nice" levels between two values: 1, 2 or 5 times a power of ten apart, about seven of them; `logarithmic`: 1, 2 and
/// 5 times powers of ten themselves, at most twelve. Both values positive then.
std::vector<double> contour_levels(double least, double most, bool logarithmic);

/// Pieces of the lines where a field on a grid takes a value, by marching squares; cells with a corner that is NaN have
/// none. Values at x[i], y[j] in place i y.size() + j. Each piece: x, y of both ends.
std::vector<std::array<double, 4>> contour(const std::vector<double>& x, const std::vector<double>& y,
                                           const std::vector<double>& values, double level);

/// Polygons of the cells, in x and y, where the field is at least `level`: their edges are the pieces of contour().
/// Cells that lie at `next` or above with all corners are left out.
std::vector<std::vector<svg::Point>> region(const std::vector<double>& x, const std::vector<double>& y,
                                            const std::vector<double>& values, double level, double next);

/// Pieces of a contour strung together where their ends meet.
std::vector<std::vector<svg::Point>> joined(const std::vector<std::array<double, 4>>& pieces);

}  // namespace freeplay
