#include "drawing/contours.h"

#include <algorithm>
#include <cmath>

#include "svg/axis.h"

namespace freeplay {
namespace {

/// Values of a field less the level at the corners of a cell of the grid, in one sense of turning, and where its edges
/// cross the level.
class Cell {
 public:
  Cell(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& values, double level,
       std::size_t i, std::size_t j) {
    const std::size_t corners[4][2] = {{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}};
    for (std::size_t k = 0; k < 4; ++k) {
      value[k] = values[corners[k][0] * y.size() + corners[k][1]] - level;
      corner[k] = {x[corners[k][0]], y[corners[k][1]]};
    }
  }

  bool known() const {
    return std::ranges::all_of(value, [](double v) { return std::isfinite(v); });
  }
  double least() const { return std::ranges::min(value); }
  bool up(std::size_t k) const { return value[k % 4] >= 0.0; }
  bool crosses(std::size_t k) const { return up(k) != up(k + 1); }
  /// On the edge from corner k to the next: found from the same end by both cells that share it.
  svg::Point crossing(std::size_t k) const {
    std::size_t a = k, b = (k + 1) % 4;
    if (k >= 2) std::swap(a, b);
    const double s = value[a] / (value[a] - value[b]);
    return corner[a] + s * (corner[b] - corner[a]);
  }
  /// All four edges cross: the mean says which corners are connected.
  bool saddle() const { return up(0) == up(2) && up(1) == up(3) && up(0) != up(1); }
  bool middle_up() const { return value[0] + value[1] + value[2] + value[3] >= 0.0; }

  double value[4];
  svg::Point corner[4];
};

}  // namespace

std::vector<double> contour_levels(double least, double most, bool logarithmic) {
  std::vector<double> levels;
  if (!(most > least) || !std::isfinite(least) || !std::isfinite(most)) return levels;
  if (logarithmic) {
    for (double power = std::floor(std::log10(least)); power <= std::log10(most); ++power) {
      for (const double digit : {1.0, 2.0, 5.0}) {
        const double level = digit * std::pow(10.0, power);
        if (level > least && level < most) levels.push_back(level);
      }
    }
    while (levels.size() > 12) {
      std::vector<double> fewer;
      for (std::size_t i = 0; i < levels.size(); i += 3) fewer.push_back(levels[i]);
      levels = std::move(fewer);
    }
    return levels;
  }
  return svg::round_numbers(least, most, 7.0);
}

std::vector<std::array<double, 4>> contour(const std::vector<double>& x, const std::vector<double>& y,
                                           const std::vector<double>& values, double level) {
  std::vector<std::array<double, 4>> pieces;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    for (std::size_t j = 0; j + 1 < y.size(); ++j) {
      const Cell cell(x, y, values, level, i, j);
      if (!cell.known()) continue;
      std::vector<svg::Point> ends;
      for (std::size_t k = 0; k < 4; ++k) {
        if (cell.crosses(k)) ends.push_back(cell.crossing(k));
      }
      // With the first corner's side in the middle, lines cut off corners 1 and 3, else 0 and 2.
      if (cell.saddle() && cell.middle_up() != cell.up(0)) std::rotate(ends.begin(), ends.begin() + 3, ends.end());
      for (std::size_t k = 0; k + 1 < ends.size(); k += 2) {
        pieces.push_back({ends[k].x, ends[k].y, ends[k + 1].x, ends[k + 1].y});
      }
    }
  }
  return pieces;
}

std::vector<std::vector<svg::Point>> region(const std::vector<double>& x, const std::vector<double>& y,
                                            const std::vector<double>& values, double level, double next) {
  std::vector<std::vector<svg::Point>> polygons;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    for (std::size_t j = 0; j + 1 < y.size(); ++j) {
      const Cell cell(x, y, values, level, i, j);
      if (!cell.known() || cell.least() >= next - level) continue;
      if (cell.saddle() && !cell.middle_up()) {
        for (std::size_t k = 0; k < 4; ++k) {
          if (cell.up(k)) polygons.push_back({cell.crossing((k + 3) % 4), cell.corner[k], cell.crossing(k)});
        }
        continue;
      }
      std::vector<svg::Point> polygon;
      for (std::size_t k = 0; k < 4; ++k) {
        if (cell.up(k)) polygon.push_back(cell.corner[k]);
        if (cell.crosses(k)) polygon.push_back(cell.crossing(k));
      }
      if (!polygon.empty()) polygons.push_back(std::move(polygon));
    }
  }
  return polygons;
}

std::vector<std::vector<svg::Point>> joined(const std::vector<std::array<double, 4>>& pieces) {
  std::vector<std::vector<svg::Point>> lines;
  std::vector<char> used(pieces.size(), 0);
  const auto same = [](const svg::Point& a, const svg::Point& b) { return a.x == b.x && a.y == b.y; };
  for (std::size_t first = 0; first < pieces.size(); ++first) {
    if (used[first]) continue;
    used[first] = 1;
    std::vector<svg::Point> line{{pieces[first][0], pieces[first][1]}, {pieces[first][2], pieces[first][3]}};
    for (bool grew = true; grew;) {
      grew = false;
      for (std::size_t i = first + 1; i < pieces.size(); ++i) {
        if (used[i]) continue;
        const svg::Point a{pieces[i][0], pieces[i][1]}, b{pieces[i][2], pieces[i][3]};
        if (same(line.back(), a)) {
          line.push_back(b);
        } else if (same(line.back(), b)) {
          line.push_back(a);
        } else if (same(line.front(), a)) {
          line.insert(line.begin(), b);
        } else if (same(line.front(), b)) {
          line.insert(line.begin(), a);
        } else {
          continue;
        }
        used[i] = 1;
        grew = true;
      }
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace freeplay
