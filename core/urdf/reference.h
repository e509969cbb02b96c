// UrdfReference: links by name, and axes: what joints and loops read alike.
#pragma once

#include <cmath>
#include <string>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "urdf/element.h"

namespace freeplay::urdf {

class LinkNames {
 public:
  explicit LinkNames(const std::vector<Link>& links) {
    for (std::size_t i = 0; i < links.size(); ++i) {
      index_.emplace(links[i].name, static_cast<int>(i));
      names_.push_back(links[i].name);
    }
  }

  bool knows(const std::string& name) const { return index_.contains(name); }

  /// Index of the link, or no_link after a message.
  int find(const std::string& name, const Spot& spot, Messages& messages) const {
    const auto found = index_.find(name);
    if (found != index_.end()) return found->second;
    messages.error(spot, "bad-urdf", fmt::format("unknown link '{}'", name), messages.suggest(name, names_));
    return no_link;
  }

 private:
  std::unordered_map<std::string, int> index_;
  std::vector<std::string> names_;
};

/// Makes `axis` a unit vector; reports a zero one, and notes one whose length is no rounding of 1.
inline Eigen::Vector3d unit_axis(const Eigen::Vector3d& axis, const Spot& spot, const std::string& owner,
                                 Messages& messages) {
  const double length = length_of(axis);
  if (length > shortest_direction) {
    constexpr double rounding = 1e-3;
    if (std::abs(length - 1.0) > rounding) {
      messages.warning(spot, "urdf-ignored",
                       fmt::format("{} has length {:.6g}: only its direction counts", owner, length));
    }
    return axis / length;
  }
  messages.error(spot, "bad-urdf", fmt::format("{} has zero length: it gives no direction", owner));
  return Eigen::Vector3d::UnitX();
}

/// The `xyz` of an axis element; x where it says none. `spot` becomes its place.
inline Eigen::Vector3d read_axis(XmlElement& xml, const std::string& owner, Messages& messages, Spot& spot) {
  Element element(xml, owner, messages, false);
  spot = spot_of(xml, "xyz");
  const Eigen::Vector3d axis = element.vector("xyz").value_or(Eigen::Vector3d::UnitX());
  element.finish();
  return unit_axis(axis, spot, owner, messages);
}

}  // namespace freeplay::urdf
