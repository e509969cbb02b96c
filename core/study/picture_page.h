// PicturePage: a pair of axes with marks, as SVG.
#pragma once

#include <cstdint>
#include <string>
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

class PicturePage {
 public:
  PicturePage(std::string title, PictureScale x, PictureScale y);

  const PictureScale& x() const { return x_; }
  const PictureScale& y() const { return y_; }
  static const char* colour(std::size_t series);

  void legend(std::vector<std::string> names) { names_ = std::move(names); }
  void mark(double x, double y, std::uint64_t point, std::size_t series, double radius);
  void tile(double from_x, double until_x, double from_y, double until_y, std::uint64_t point, const std::string& fill,
            const std::string& words);
  /// Points of a line; of a band first along its lower edge, then back along the upper one.
  void line(const std::vector<std::pair<double, double>>& points, std::size_t series);
  void band(const std::vector<std::pair<double, double>>& points, std::size_t series);
  /// A value of x across the picture, dashed, with a word.
  void upright(double x, const std::string& words);
  void shade(double from_x, double until_x);

  std::string text() const;
  /// One picture of several, one below the other.
  static std::string stacked(const std::vector<PicturePage>& pages);

 private:
  double px_x(double x) const;
  double px_y(double y) const;
  std::string path(const std::vector<std::pair<double, double>>& points) const;

  std::string title_;
  PictureScale x_, y_;
  std::vector<std::string> names_;
  std::string body_;
};

}  // namespace freeplay
