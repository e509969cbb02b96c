// MapDrawing: a quantity over the positions of a platform, as SVG.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace freeplay {

enum class MapPoint : char { good, unreachable, singular };

/// Values on a grid of positions.
struct PositionMap {
  std::string title, quantity;              ///< quantity: name and unit for the legend
  std::vector<double> x, y;                 ///< [m], in order
  std::vector<double> values;               ///< at x[i], y[j] in place i y.size() + j; only of good points
  std::vector<MapPoint> points;             ///< the same way
  std::vector<double> determinant;          ///< the same way: changes sign across singular curves; may be empty
  std::vector<std::array<double, 2>> path;  ///< [m]; may be empty
};

/// Contours with their values, steps of grey from light to dark, hatched where nothing is reached, crosses at singular
/// points, singular curves dashed, the path on top: nothing is shown by colour alone. Same input, same bytes.
std::string map_svg(const PositionMap& map);

/// "Nice" levels between two values: 1, 2 or 5 times a power of ten apart, about seven of them; `logarithmic`: 1, 2 and
/// 5 times powers of ten themselves, at most twelve. Both values positive then.
std::vector<double> contour_levels(double least, double most, bool logarithmic);

/// Pieces of the lines where a field on a grid takes a value, by marching squares; cells with a corner that is NaN have
/// none. Each piece: x, y of both ends.
std::vector<std::array<double, 4>> contour(const std::vector<double>& x, const std::vector<double>& y,
                                           const std::vector<double>& values, double level);

}  // namespace freeplay
