#include "mjcf/geom.h"

#include <algorithm>
#include <array>
#include <numbers>

#include <fmt/format.h>

namespace freeplay::mjcf {
namespace {

constexpr double pi = std::numbers::pi;

enum class Shape { sphere, capsule, cylinder, box, ellipsoid, plane, hfield, mesh, sdf };
const std::vector<std::string> shape_words{"sphere", "capsule", "cylinder", "box", "ellipsoid",
                                           "plane",  "hfield",  "mesh",     "sdf"};

bool has_sizes(Shape shape) { return shape <= Shape::ellipsoid; }
std::size_t size_count(Shape shape) {
  constexpr std::size_t counts[] = {1, 2, 2, 3, 3};
  return counts[static_cast<std::size_t>(shape)];
}

/// Radius or half lengths; of capsules and cylinders the radius and half the length along z [m].
using Sizes = std::array<double, 3>;

double volume(Shape shape, const Sizes& s) {
  switch (shape) {
    case Shape::sphere:
      return 4.0 / 3.0 * pi * s[0] * s[0] * s[0];
    case Shape::capsule:
      return pi * s[0] * s[0] * (2.0 * s[1] + 4.0 / 3.0 * s[0]);
    case Shape::cylinder:
      return 2.0 * pi * s[0] * s[0] * s[1];
    case Shape::box:
      return 8.0 * s[0] * s[1] * s[2];
    default:
      return 4.0 / 3.0 * pi * s[0] * s[1] * s[2];
  }
}

/// Principal moments of a body of mass 1 [m^2].
Eigen::Vector3d moments(Shape shape, const Sizes& s) {
  const double r2 = s[0] * s[0], h = s[1];
  switch (shape) {
    case Shape::sphere:
      return Eigen::Vector3d::Constant(0.4 * r2);
    case Shape::capsule: {
      const double ends = 4.0 / 3.0 * s[0] / (2.0 * h + 4.0 / 3.0 * s[0]), middle = 1.0 - ends;
      // Half spheres whose flat sides stand h off the centre; their centres of mass are 3/8 of the radius further out.
      const double across = middle * (r2 / 4.0 + h * h / 3.0) + ends * (0.4 * r2 + h * h + 0.75 * h * s[0]);
      return {across, across, middle * r2 / 2.0 + ends * 0.4 * r2};
    }
    case Shape::cylinder:
      return {r2 / 4.0 + h * h / 3.0, r2 / 4.0 + h * h / 3.0, r2 / 2.0};
    default: {
      const double share = shape == Shape::box ? 1.0 / 3.0 : 1.0 / 5.0;
      const double x = s[0] * s[0], y = s[1] * s[1], z = s[2] * s[2];
      return share * Eigen::Vector3d(y + z, x + z, x + y);
    }
  }
}

class GeomReader {
 public:
  GeomReader(XmlElement& xml, const std::string& carrier, const Settings& settings, Messages& messages)
      : xml_(xml), settings_(settings), messages_(messages), element_(xml, owner_of(xml, carrier), messages, false) {}

  std::optional<MassProperties> read(bool counts) {
    const int errors = messages_.errors();
    shape_ = static_cast<Shape>(choice(element_, "type", shape_words, 0, messages_));
    pose_ = read_pose(element_, settings_, messages_);
    read_sizes();
    const bool weighs = read_weight();
    for (const char* name :
         {"name", "class", "material", "rgba", "user", "mesh", "hfield", "fitscale", "contype", "conaffinity", "condim",
          "priority", "friction", "solmix", "solref", "solimp", "margin", "gap"}) {
      element_.find(name);
    }
    element_.finish();
    if (messages_.errors() != errors || !counts || !weighs) return std::nullopt;
    if (!has_sizes(shape_) || element_.find("mesh") != nullptr) return refuse_mesh();
    return properties();
  }

 private:
  static std::string owner_of(const XmlElement& xml, const std::string& carrier) {
    const char* name = xml.Attribute("name");
    return name == nullptr ? "a geom of " + carrier : fmt::format("geom '{}' of {}", name, carrier);
  }

  /// Sizes, or both ends of the middle line.
  void read_sizes() {
    const std::vector<double> sizes = element_.numbers("size", 1, 3, "1"), ends = element_.numbers("fromto", 6);
    if (!has_sizes(shape_) || element_.find("mesh") != nullptr) return;
    for (std::size_t i = 0; i < sizes.size(); ++i) sizes_[i] = sizes[i];
    const bool between = !ends.empty() && shape_ != Shape::sphere;
    if (!ends.empty() && !between) {
      messages_.error(spot_of(xml_, "fromto"), "bad-urdf", fmt::format("'fromto' is not for {}, a sphere", owner()));
    }
    const std::size_t needed = between ? 1 : size_count(shape_);
    for (std::size_t i = 0; i < needed; ++i) {
      if (i < sizes.size() && sizes_[i] > 0.0) continue;
      messages_.error(spot_of(xml_, "size"), "bad-urdf",
                      fmt::format("'size' of {} must be {} positive number{}", owner(), needed, needed > 1 ? "s" : ""));
      return;
    }
    if (between) stretch(Eigen::Vector3d(ends[0], ends[1], ends[2]), Eigen::Vector3d(ends[3], ends[4], ends[5]));
  }

  void stretch(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d along = from - to;
    if (urdf::length_of(along) <= urdf::shortest_direction) {
      messages_.error(spot_of(xml_, "fromto"), "bad-urdf", fmt::format("both ends of {} are the same point", owner()));
      return;
    }
    const bool square = shape_ == Shape::box || shape_ == Shape::ellipsoid;
    if (square) sizes_[1] = sizes_[0];
    sizes_[square ? 2 : 1] = 0.5 * along.norm();
    pose_.translation() = 0.5 * (from + to);
    pose_.linear() = turn_to(along);
  }

  /// False for one that weighs nothing whatever its shape.
  bool read_weight() {
    const double group = element_.number("group", 0.0);
    const double density = element_.number("density", 1000.0);
    if (element_.find("mass") != nullptr) mass_ = element_.number("mass", 0.0);
    for (const char* name : {"mass", "density"}) {
      const bool negative = std::string_view(name) == "mass" ? mass_.value_or(0.0) < 0.0 : density < 0.0;
      if (!negative) continue;
      messages_.error(spot_of(xml_, name), "bad-urdf", fmt::format("{} of {} must not be negative", name, owner()));
    }
    density_ = density;
    if (choice(element_, "shellinertia", {"false", "true"}, 0, messages_) == 1) {
      messages_.error(spot_of(xml_, "shellinertia"), "bad-urdf",
                      fmt::format("the inertia of {}, a shell, is not computed here", owner()), {},
                      "give its body an 'inertial' with the numbers");
    }
    if (group < settings_.lowest_group || group > settings_.highest_group) return false;
    if (shape_ == Shape::plane || shape_ == Shape::hfield) return false;
    return mass_ ? *mass_ > 0.0 : density_ > 0.0;
  }

  std::optional<MassProperties> refuse_mesh() {
    messages_.error(element_.begin_spot(), "bad-urdf",
                    fmt::format("the mass of {}, a mesh, is not computed here", owner()), {},
                    "give its body an 'inertial', or this geom mass=\"0\" where others have the mass");
    return std::nullopt;
  }

  MassProperties properties() const {
    MassProperties out;
    out.mass = mass_.value_or(density_ * volume(shape_, sizes_));
    out.com = pose_.translation();
    const Eigen::Vector3d own = out.mass * moments(shape_, sizes_);
    out.inertia = pose_.linear() * own.asDiagonal() * pose_.linear().transpose();
    return out;
  }

  const std::string& owner() const { return element_.owner(); }

  XmlElement& xml_;
  const Settings& settings_;
  Messages& messages_;
  Element element_;
  Shape shape_ = Shape::sphere;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  Sizes sizes_{};
  std::optional<double> mass_;
  double density_ = 1000.0;
};

}  // namespace

std::optional<MassProperties> read_geom(XmlElement& xml, const std::string& carrier, bool counts,
                                        const Settings& settings, Messages& messages) {
  return GeomReader(xml, carrier, settings, messages).read(counts);
}

bool can_touch(const XmlElement& geom) {
  const auto is_zero = [&](const char* name) { return geom.IntAttribute(name, 1) == 0; };
  return !is_zero("contype") || !is_zero("conaffinity");
}

}  // namespace freeplay::mjcf
