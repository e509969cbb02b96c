// EnergyGrowth: steps that end with energy that nothing has put in.
#pragma once

#include "run/context.h"

namespace freeplay {

class EnergyGrowth {
 public:
  explicit EnergyGrowth(RunContext& run) : run_(run) {}

  void start() { explained_energy_ = energy_of(run_.e_accepted).size; }
  /// Whether energy has grown in the step that was just made far beyond the work of all that acts.
  bool too_large();
  /// Without work, by the step that was looked at last [J].
  double gained() const { return gained_; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.explained_energy_);
  }

 private:
  struct Energy {
    double value, size;  ///< [J]
  };
  Energy energy_of(const Evaluation& e) const;
  [[gnu::cold]] double energy_of_drives() const;

  RunContext& run_;
  double explained_energy_ = 0.0;  // the largest that work was found for [J]
  double gained_ = 0.0;
};

}  // namespace freeplay
