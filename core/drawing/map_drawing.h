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
  std::string x_word = "x", y_word = "y";   ///< of the axes
  std::vector<double> x, y;                 ///< [m], in order
  std::vector<double> values;               ///< at x[i], y[j] in place i y.size() + j; only of good points
  std::vector<MapPoint> points;             ///< the same way
  std::vector<double> determinant;          ///< the same way: changes sign across singular curves; may be empty
  std::vector<std::array<double, 2>> path;  ///< [m]; may be empty
  bool coloured = false;                    ///< yellow to blue in place of grey
};

/// Contours with their values, the ground between them in steps of one tone, from light to dark, hatched where nothing
/// is reached, crosses at singular points, singular curves dashed, the path on top: nothing is shown by colour alone.
/// Same input, same bytes.
std::string map_svg(const PositionMap& map);

}  // namespace freeplay
