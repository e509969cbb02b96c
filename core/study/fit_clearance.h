// FitClearance: the radial clearance of an ISO 286 fit as hole and shaft give it, cut or not.
#pragma once

#include <vector>

#include "format/study_axis.h"

namespace freeplay {

/// Hole and shaft are independent, and the clearance is that of the pairs between the ends. Where these cut the fit the
/// hole follows the share of shafts that suit it, and the shaft is one of those: a pair has the density that it has
/// without the ends, over the share of all pairs that are kept.
class FitClearance {
 public:
  explicit FitClearance(const StudyFit& of);

  /// Half of hole minus shaft [m]; both arguments between 0 and 1.
  double at(double hole, double shaft) const;

 private:
  /// A part of the hole's zone over which the share of shafts is smooth.
  struct Panel {
    double from, until, share_before;
  };
  double density(double size) const;
  double share(double from, double until) const;
  double size_of_hole(double u) const;

  StudyFit fit_;
  std::vector<Panel> panels_;  // empty where nothing is cut
  double share_ = 1.0;
};

}  // namespace freeplay
