// FactorCache: factored matrices of stages, one for each pair of betas that was used lately.
#pragma once

#include <vector>

#include "base/archive.h"
#include "stage/convergence_monitor.h"
#include "stage/equations.h"
#include "stage/matrix.h"

namespace freeplay {

struct StageFactor {
  StageMatrix matrix;
  double beta_q = 0.0, beta_v = 0.0, beta_z = 0.0;
  JacobianRecord record = {};
  bool has_pattern = false;
  long used = -1;        // FactorCache's time
  int on_phi_since = 0;  ///< stages since a predictor was off the constraint equations by drift

  /// Without the matrix.
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.beta_q, self.beta_v, self.beta_z, self.record, self.has_pattern, self.used, self.on_phi_since);
  }
};

class FactorCache {
 public:
  explicit FactorCache(StageEquations& equations);

  /// The factors for a stage with these betas: those that are kept, or else unusable ones in the place of those that
  /// were not used for longest.
  StageFactor& factor_for(double beta_q, double beta_v);
  /// Factors at the present evaluation, which must hold Phi_q and derivatives. Returns the smallest pivot over the
  /// largest.
  double factorize(StageFactor& factor);
  /// Factors with other rows than those that are kept at present become unusable.
  void follow_choice_of_rows();
  long factorizations() const { return factorizations_; }

  /// restore() expects the choice of rows.
  void save(ArchiveWriter& archive) const;
  void restore(ArchiveReader& archive);

 private:
  void set_pattern(StageFactor& factor);

  StageEquations& equations_;
  std::vector<StageFactor> factors_;
  int choice_ = 0;  // IndependentRows::choice() that they were made with
  long clock_ = 0, factorizations_ = 0;
};

}  // namespace freeplay
