#include "mjcf/inertia.h"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "mjcf/pose.h"

namespace freeplay::mjcf {

void read_inertial(XmlElement& xml, const std::string& owner, const Settings& settings, urdf::Link& link,
                   Messages& messages) {
  Element inertial(xml, "the inertial of " + owner, messages, true);
  const int errors = messages.errors();
  link.has_inertial = true;
  link.inertial = read_pose(inertial, settings, messages);
  link.mass = inertial.required_number("mass").value_or(1.0);
  link.mass_spot = spot_of(xml, "mass");
  if (link.mass < 0.0) {
    messages.error(link.mass_spot, "bad-urdf",
                   fmt::format("the mass of {} must be positive, not {} kg", owner, link.mass));
  }
  const std::vector<double> moments = inertial.numbers("diaginertia", 3), all = inertial.numbers("fullinertia", 6);
  const char* key = inertial.find("fullinertia") != nullptr ? "fullinertia" : "diaginertia";
  link.inertia_spot = spot_of(xml, key);
  link.moments = {link.inertia_spot, link.inertia_spot, link.inertia_spot};
  if (!moments.empty()) link.inertia = Eigen::Vector3d(moments[0], moments[1], moments[2]).asDiagonal();
  if (!all.empty()) link.inertia << all[0], all[3], all[4], all[3], all[1], all[5], all[4], all[5], all[2];
  if (!moments.empty() && !all.empty()) {
    messages.error(link.inertia_spot, "bad-urdf",
                   fmt::format("{} says both diaginertia and fullinertia", inertial.owner()));
  } else if (!all.empty() && link.inertial.linear() != Eigen::Matrix3d::Identity()) {
    messages.error(link.inertia_spot, "bad-urdf",
                   fmt::format("{} says fullinertia, which is in axes of the body, and is turned", inertial.owner()),
                   {}, "diaginertia goes with a turned frame");
  } else if (moments.empty() && all.empty() && messages.errors() == errors && link.mass > 0.0) {
    messages.error(inertial.begin_spot(), "bad-urdf",
                   fmt::format("{} says neither diaginertia nor fullinertia", inertial.owner()));
  }
  link.inertia_known = messages.errors() == errors;
  inertial.finish();
}

void take_geoms(const std::vector<MassProperties>& geoms, urdf::Link& link) {
  const MassProperties all = urdf::together(geoms);
  link.has_inertial = all.mass > 0.0;
  link.mass = all.mass;
  link.inertial.setIdentity();
  link.inertial.translation() = all.com;
  link.inertia = all.inertia;
  link.moments = {link.inertia_spot, link.inertia_spot, link.inertia_spot};
}

void bound_inertia(const Settings& settings, urdf::Link& link) {
  if (settings.least_mass > link.mass) {
    link.mass = settings.least_mass;
    link.has_inertial = true;
  }
  if (settings.least_moment <= 0.0) return;
  const urdf::PrincipalTensor own = urdf::principal(link.inertia);
  if (own.values[0] >= settings.least_moment) return;
  const Eigen::Vector3d raised = own.values.cwiseMax(settings.least_moment);
  link.inertia = own.axes * raised.asDiagonal() * own.axes.transpose();
}

void scale_masses(const Settings& settings, urdf::Robot& robot) {
  double total = 0.0;
  for (const urdf::Link& link : robot.links) total += link.mass;
  if (settings.total_mass <= 0.0 || total <= 0.0) return;
  for (urdf::Link& link : robot.links) {
    link.mass *= settings.total_mass / total;
    link.inertia *= settings.total_mass / total;
  }
}

}  // namespace freeplay::mjcf
