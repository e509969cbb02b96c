// What a contact law computes from the pair of surfaces, and words for what it lacks there.
#pragma once

#include <cmath>
#include <string>

#include "freeplay/contact_law.h"

namespace freeplay {

inline bool known(double value) { return !std::isnan(value); }
inline bool known(const Material& m) { return known(m.youngs_modulus) && known(m.poisson_ratio); }

/// Collects the names of missing data: "the radii, the material of the journal".
class MissingData {
 public:
  MissingData& need(bool is_known, const char* name) {
    if (!is_known) words_ += (words_.empty() ? "" : ", ") + std::string(name);
    return *this;
  }
  MissingData& need_materials(const ContactPair& pair) {
    return need(known(pair.bearing), "the material of the bearing")
        .need(known(pair.journal), "the material of the journal");
  }
  /// "" when all is there.
  const std::string& words() const { return words_; }

 private:
  std::string words_;
};

/// 1/E* = h_b + h_j [1/Pa],  h = (1 - nu^2)/E, with Young's modulus E [Pa] and Poisson's ratio nu of both sides.
inline double contact_compliance(const ContactPair& pair) {
  const auto compliance = [](const Material& m) {
    return (1.0 - m.poisson_ratio * m.poisson_ratio) / m.youngs_modulus;
  };
  return compliance(pair.bearing) + compliance(pair.journal);
}

}  // namespace freeplay
