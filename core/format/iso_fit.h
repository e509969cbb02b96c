// IsoFit: limits and fits of ISO 286 up to 500 mm.
#pragma once

#include <optional>
#include <string_view>

namespace freeplay {

/// Deviations of a hole and a shaft from the nominal size [m].
struct IsoFit {
  double hole_low = 0.0, hole_high = 0.0, shaft_low = 0.0, shaft_high = 0.0;

  /// Of the radial clearance [m].
  double smallest_clearance() const { return (hole_low - shaft_high) / 2; }
  double largest_clearance() const { return (hole_high - shaft_low) / 2; }
};

/// Of a code such as "H7/g6": holes D to H and JS, shafts d to h and js, grades 5 to 11; nothing for another one, or a
/// diameter [m] that is not above 0 and at most 0.5.
std::optional<IsoFit> iso_fit(std::string_view code, double diameter);

}  // namespace freeplay
