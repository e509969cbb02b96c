// PicturePage: a pair of axes with marks, as SVG.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "svg/axis.h"

namespace freeplay {

/// Values along an edge: numbers, or words side by side.
class PictureScale {
 public:
  PictureScale() = default;
  PictureScale(std::string label, const std::vector<double>& values, const std::string& unit, svg::Fit fit);
  PictureScale(std::string label, std::vector<std::string> words);

  /// From 0 to 1.
  double at(double value) const { return (value - axis_.from) / (axis_.until - axis_.from); }
  /// What words stand at.
  double value_of(const std::string& word) const;
  const svg::Axis& axis() const { return axis_; }
  std::string label() const;

 private:
  std::string label_;
  std::vector<std::string> words_;
  svg::Axis axis_;
};

/// Where a value of a point stands.
struct PictureMark {
  double x = 0.0, y = 0.0;
  std::uint64_t point = 0;
};

class PicturePage {
 public:
  /// `families`: names of the series, for a legend.
  PicturePage(std::string title, PictureScale x, PictureScale y, std::vector<std::string> families = {});

  const PictureScale& x() const { return x_; }
  const PictureScale& y() const { return y_; }
  static const char* colour(std::size_t series);
  /// From white at 0 to dark at 1.
  static std::string shade(double dark);
  static constexpr std::size_t most_marks = 4000;  ///< of a series

  /// What white and dark stand for.
  void shades(double least, double most, const std::string& unit);
  /// Discs. Of more than `most_marks` one stands for all in a cell of the picture, at the first of them, the larger
  /// the more there are: nothing that stands apart is lost.
  void marks(std::span<const PictureMark> marks, std::size_t series, double radius);
  void tile(double from_x, double until_x, double from_y, double until_y, std::uint64_t point, const std::string& fill,
            const std::string& words);
  /// Points of a line; of a band first along its lower edge, then back along the upper one.
  void line(const std::vector<std::pair<double, double>>& points, std::size_t series);
  void band(const std::vector<std::pair<double, double>>& points, std::size_t series);
  /// A value of x across the picture, dashed, with a word; its interval is a bar near the upper edge. Series stand one
  /// below the other.
  void upright(double x, std::optional<std::pair<double, double>> interval, std::size_t series,
               const std::string& words);

  std::string text() const;
  /// One picture of several, one below the other.
  static std::string stacked(const std::vector<PicturePage>& pages);

 private:
  void disc(const PictureMark& mark, std::size_t series, double radius);
  double px_x(double x) const;
  double px_y(double y) const;
  std::string path(const std::vector<std::pair<double, double>>& points) const;
  std::string legend() const;
  std::string labels_of_x() const;
  bool leans() const;

  std::string title_;
  PictureScale x_, y_;
  std::vector<std::string> families_;
  double left_, top_, bottom_;  // margins [px]
  std::string body_;
};

}  // namespace freeplay
