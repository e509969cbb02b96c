#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "plot/figure.h"

namespace freeplay::plot {
namespace {

constexpr int lines_of_text = 12, dots_across = 2, dots_down = 4;  // of a character

/// Dots in characters of two by four.
class DotScreen {
 public:
  explicit DotScreen(int columns) : columns_(columns), cells_(static_cast<std::size_t>(columns * lines_of_text)) {}

  int width() const { return dots_across * columns_; }
  static int height() { return dots_down * lines_of_text; }

  /// x to the right, y up.
  void dot(int x, int y) {
    if (x < 0 || x >= width() || y < 0 || y >= height()) return;
    const int down = height() - 1 - y;
    // Unicode numbers the dots of a cell by columns, the lowest ones last.
    constexpr unsigned char bits[dots_down][dots_across] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    cells_[static_cast<std::size_t>(down / dots_down) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x / dots_across)] |= bits[down % dots_down][x % dots_across];
  }

  void line(int x0, int y0, int x1, int y1) {
    const int steps = std::max({std::abs(x1 - x0), std::abs(y1 - y0), 1});
    for (int i = 0; i <= steps; ++i) {
      const double s = static_cast<double>(i) / steps;
      dot(static_cast<int>(std::lround(x0 + s * (x1 - x0))), static_cast<int>(std::lround(y0 + s * (y1 - y0))));
    }
  }

  std::string text(bool braille) const {
    std::string out;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (braille) {
        out += {static_cast<char>(0xe2), static_cast<char>(0xa0 | (cells_[i] >> 6)),
                static_cast<char>(0x80 | (cells_[i] & 0x3f))};
      } else {
        out += cells_[i] != 0 ? '*' : ' ';
      }
      if ((i + 1) % static_cast<std::size_t>(columns_) != 0) continue;
      if (!braille) out.erase(out.find_last_not_of(' ') + 1);
      out += '\n';
    }
    return out;
  }

 private:
  int columns_;
  std::vector<std::uint8_t> cells_;
};

void draw(const Panel& panel, DotScreen& screen) {
  double per_x = (screen.width() - 1) / (panel.x.until - panel.x.from);
  double per_y = (DotScreen::height() - 1) / (panel.y.until - panel.y.from);
  if (panel.equal_scales) per_x = per_y = std::min(per_x, per_y);
  const auto dots = [](double value, double from, double per) {
    return static_cast<int>(std::lround((value - from) * per));
  };
  for (const Line& line : panel.lines) {
    const Point* last = nullptr;
    for (const Point& point : line.points) {
      if (std::isnan(point.y)) {
        last = nullptr;
        continue;
      }
      const Point& from = last == nullptr ? point : *last;
      screen.line(dots(from.x, panel.x.from, per_x), dots(from.y, panel.y.from, per_y),
                  dots(point.x, panel.x.from, per_x), dots(point.y, panel.y.from, per_y));
      last = &point;
    }
  }
}

}  // namespace

std::string missing_words(const Line& line) {
  if (!line.seen.any()) return fmt::format("no numbers in {} row{}", line.rows, line.rows == 1 ? "" : "s");
  if (line.seen.missing == 0) return "";
  return fmt::format("{} of {} rows have no number", line.seen.missing, line.rows);
}

std::string figure_text(const Figure& figure, int columns, bool braille) {
  std::string out;
  const char* to = braille ? "…" : "...";
  for (const Panel& panel : figure.panels) {
    const std::string unit = panel.unit == "1" || panel.unit.empty() ? "" : fmt::format(" [{}]", panel.unit);
    for (std::size_t i = 0; i < panel.lines.size(); ++i) {
      const Line& line = panel.lines[i];
      const std::string of = figure.names.size() > 1 ? fmt::format("  {}", figure.names[i]) : "";
      const std::string range =
          line.seen.any() ? fmt::format("{:.6g} {} {:.6g}", line.seen.least, to, line.seen.most) : "no numbers";
      const std::string missing = line.seen.any() ? missing_words(line) : "";
      out += fmt::format("{}{}  {}  ({} rows{}{}){}\n", panel.title, unit, range, line.rows,
                         missing.empty() ? "" : ", ", missing, of);
    }
    DotScreen screen(columns);
    draw(panel, screen);
    out += screen.text(braille);
    const std::string x_unit = panel.x_unit == "1" || panel.x_unit.empty() ? "" : " " + panel.x_unit;
    out += fmt::format("{:.6g} {} {:.6g}{}\n", panel.x.from, to, panel.x.until, x_unit);
  }
  return out;
}

}  // namespace freeplay::plot
