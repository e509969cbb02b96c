#include "system/tooth_forces.h"

#include <cmath>
#include <complex>

#include "base/index.h"
#include "model/gear_teeth.h"
#include "system/evaluation.h"

namespace freeplay {
namespace {

using PlanePoint = std::complex<double>;

PlanePoint turned_left(const PlanePoint& x) { return {-x.imag(), x.real()}; }
double cross_product(const PlanePoint& x, const PlanePoint& y) { return (std::conj(x) * y).imag(); }

/// A joint that holds a wheel or a rack: the marker of this, and 1 where the joint counts it against the body that
/// carries both, else -1.
struct Holder {
  int joint, marker;
  double sense;
};

Holder holder(const Model& model, int joint, BodyId carrier) {
  const JointElement& one = model.joints[at(joint)];
  if (model.markers[at(one.marker_a)].body == carrier) return {joint, one.marker_b, 1.0};
  return {joint, one.marker_a, -1.0};
}

/// F at C, and F_r along u or n.
struct ToothLoad {
  PlanePoint at, force, radial;
};

ToothLoad tooth_load(const PlanePoint& pitch_point, const PlanePoint& direction, const PlanePoint& off, double along,
                     double ratio, double tangent) {
  const PlanePoint radial = std::copysign(std::abs(along) * tangent, -ratio) * off;
  return {pitch_point, along * direction + radial, radial};
}

}  // namespace

std::array<ToothWrench, 3> tooth_wrenches(const System& system, const Gear& gear, const Evaluation& e,
                                          std::span<const double> lambda) {
  const Model& model = system.model();
  const auto turns = [&](int joint) { return model.joints[at(joint)].ideal_layout().coordinate == Coordinate::angle; };
  const bool b_is_second = turns(gear.first);
  const BodyId carrier = carrier_of(model, gear).value_or(ground);
  const Holder a = holder(model, b_is_second ? gear.first : gear.second, carrier),
               b = holder(model, b_is_second ? gear.second : gear.first, carrier);
  const auto place = [&](int marker) {
    return PlanePoint{e.markers[at(marker)].position[0], e.markers[at(marker)].position[1]};
  };
  const PlanePoint from = place(a.marker), to = place(b.marker);
  const double ratio = a.sense * b.sense * (b_is_second ? gear.ratio : 1.0 / gear.ratio);
  const double passed =
      b.sense * (b_is_second ? -1.0 : gear.ratio) * lambda[at(system.layout().rows(gear.joint).offset)];
  const double tangent = std::tan(pressure_angle(model.joints[at(gear.joint)]));
  const bool is_rack = !turns(b.joint);

  ToothLoad load;
  if (is_rack) {
    const double* axes = e.markers[at(b.marker)].rotation;
    const PlanePoint along{axes[0], axes[3]}, off = turned_left(along);
    load = tooth_load(from - ratio * off, along, off, passed, ratio, tangent);
  } else {
    const PlanePoint d = to - from, off = d / std::abs(d);
    load = tooth_load(to - d / (1.0 - ratio), turned_left(off), off, -(1.0 - ratio) * passed / std::abs(d), ratio,
                      tangent);
  }
  const auto wrench = [](int joint, bool is_whole, const PlanePoint& force, double moment) {
    return ToothWrench{joint, is_whole, {force.real(), force.imag()}, moment};
  };
  const PlanePoint own = b_is_second ? load.force : -load.force;
  // The row of the gear already supplies the force along the slide of a rack, at the slide's second frame.
  const PlanePoint lacking = is_rack ? load.radial : load.force;
  const double moment = is_rack ? cross_product(load.at - place(model.joints[at(b.joint)].marker_b), load.force) : 0.0;
  return {wrench(gear.joint, true, own, cross_product(load.at - (b_is_second ? to : from), own)),
          wrench(a.joint, false, a.sense * load.force, 0.0),
          wrench(b.joint, false, -b.sense * lacking, -b.sense * moment)};
}

}  // namespace freeplay
