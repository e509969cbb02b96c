// Figure: lines over axes, in panels that share a page.
#pragma once

#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "plot/curve.h"
#include "svg/axis.h"

namespace freeplay::plot {

struct Line {
  std::vector<Point> points;
  Extremes seen;  ///< of all rows, also those of which no point is needed
  std::int64_t rows = 0;
};

/// "3 of 100 rows have no number"; empty where all have.
std::string missing_words(const Line& line);

/// Centred at the origin of a panel with equal scales.
struct Circle {
  double radius = 0.0;
  std::string label;
  bool dashed = false;
  double label_angle = std::numbers::pi / 2.0;  ///< where the label stands, from x on
  int line = -1;                                ///< whose colour it has; -1: grey
};

struct Panel {
  std::string channel, channel_unit;  ///< of the result
  std::string unit;                   ///< of y, in SI
  std::string title;
  std::string x_label;  ///< without its unit; empty: the next panel has the same axis
  std::string x_unit;   ///< in SI
  svg::Axis x, y;
  std::vector<Line> lines;                        ///< one for each of Figure::names
  std::vector<std::pair<double, double>> shaded;  ///< spans of x
  std::vector<Circle> circles;
  bool equal_scales = false;  ///< x and y are lengths of one kind
};

struct Figure {
  std::string title;
  std::vector<std::string> names;  ///< of the lines, for a legend where there are several
  std::string shading;             ///< what shaded spans mean
  std::vector<Panel> panels;
};

/// Size of a picture.
struct PageSize {
  double width = 900.0;         ///< [px], 96 to an inch
  double panel_height = 240.0;  ///< [px]; panels with equal scales are as high as they are wide, at most so wide
  bool in_millimetres = false;  ///< how the size is written in the file
};

/// Panels below each other, as SVG: black on white without scripts; `<g class="panel">` with the pixels and values at
/// the edges of each as data- attributes. Lines differ in colour (Okabe and Ito 2008) and in their dashes. Same figure,
/// same bytes.
std::string figure_svg(const Figure& figure, const PageSize& size);
/// Room of lines across a panel [px].
double line_room(const PageSize& size);

/// Twelve lines of braille patterns or asterisks for each panel, `columns` characters wide.
std::string figure_text(const Figure& figure, int columns, bool braille);

}  // namespace freeplay::plot
