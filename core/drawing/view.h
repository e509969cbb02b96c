// View: a spatial scene seen from one side without perspective, and the solids that symbols are made of.
#pragma once

#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "svg/page.h"

namespace freeplay {

/// `right` and `up` are unit vectors, world axes, at a right angle; what lies further along right x up is nearer.
class View {
 public:
  using Vector = Eigen::Vector3d;

  View(std::string name, const Vector& right, const Vector& up)
      : name_(std::move(name)), right_(right), up_(up), toward_(right.cross(up)) {}

  const std::string& name() const { return name_; }
  /// From the scene to the eye.
  const Vector& toward() const { return toward_; }
  /// Place of a point, or of the end of an arrow, on a plane with x to the right and y down [m].
  svg::Point flat(const Vector& p) const { return {p.dot(right_), -p.dot(up_)}; }
  double depth(const Vector& p) const { return p.dot(toward_); }

  /// Puts the point of the plane `middle` [m] to `centre` of the page, with so many px per m.
  void fit(const svg::Point& middle, const svg::Point& centre, double scale) {
    middle_ = middle, centre_ = centre, scale_ = scale;
  }
  double scale() const { return scale_; }
  svg::Point page(const Vector& p) const { return centre_ + scale_ * (flat(p) - middle_); }

 private:
  std::string name_;
  Vector right_, up_, toward_;
  svg::Point middle_, centre_;
  double scale_ = 1.0;
};

/// Solids of a size on the page [px] at a place of it, with the attitude of the scene; names keep out of their way.
namespace solid {

/// A round bar about the unit vector `axis`, `half` long to each side; the end that is seen is grey.
void bar(svg::Page& page, const View& view, const svg::Point& at, const Eigen::Vector3d& axis, double half,
         double radius);
/// A block with its edges along the columns of `axes`, `half` wide to each side, faces in shades of `grey` 0 to 1.
void block(svg::Page& page, const View& view, const svg::Point& at, const Eigen::Matrix3d& axes,
           const Eigen::Vector3d& half, double grey);
/// A dashed circle about the unit vector `axis` [px].
void pitch_circle(svg::Page& page, const View& view, const svg::Point& at, const Eigen::Vector3d& axis, double radius);
void ball(svg::Page& page, const svg::Point& at, double radius);

/// Arrows for the world axes from a point of the page on, with their letters; those along the line of sight are a ring
/// with a dot (to the eye) or a cross.
void axes(svg::Page& page, const View& view, const svg::Point& at, double length);

}  // namespace solid

}  // namespace freeplay
