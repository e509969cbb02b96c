#include "stage/factor_cache.h"

#include <cmath>

namespace freeplay {
namespace {

constexpr int kept_factors = 4;
constexpr int few_unknowns = 100;
constexpr double same_beta = 1e-6;  // relative: a factor only preconditions the iteration

}  // namespace

FactorCache::FactorCache(StageEquations& equations) : equations_(equations) {
  for (int i = 0; i < kept_factors; ++i) factors_.push_back({.matrix = StageMatrix(equations.system(), true)});
}

StageFactor& FactorCache::factor_for(double beta_q, double beta_v) {
  follow_choice_of_rows();
  ++clock_;
  StageFactor* oldest = &factors_[0];
  for (StageFactor& factor : factors_) {
    if (factor.used >= 0 && std::abs(factor.beta_q - beta_q) <= same_beta * beta_q &&
        std::abs(factor.beta_v - beta_v) <= same_beta * beta_v) {
      factor.used = clock_;
      return factor;
    }
    if (factor.used < oldest->used) oldest = &factor;
  }
  oldest->beta_q = beta_q;
  oldest->beta_v = beta_v;
  oldest->used = clock_;
  oldest->record.begin();
  return *oldest;
}

double FactorCache::factorize(StageFactor& factor) {
  if (!factor.has_pattern) set_pattern(factor);
  ++factorizations_;
  return factor.matrix.factor(equations_.evaluation(), factor.beta_q, factor.beta_v, factor.beta_z);
}

// Of a small system the patterns of all factors are set at once: no other length of steps allocates then.
void FactorCache::set_pattern(StageFactor& factor) {
  const System& system = equations_.system();
  const Profile::Timer start(equations_.profile(), Phase::start);
  const bool alone = system.layout().nv() + system.layout().nc() > few_unknowns;
  for (StageFactor& each : factors_) {
    if (&each != &factor && alone) continue;
    each.matrix.set_pattern(equations_.dependent());
    each.has_pattern = true;
  }
}

void FactorCache::save(ArchiveWriter& archive) const {
  archive(choice_, clock_, factorizations_);
  for (const StageFactor& factor : factors_) {
    archive(factor);
    if (factor.has_pattern && choice_ == equations_.rows().choice()) archive(factor.matrix);
  }
}

// Matrices of other rows than the present ones are not used again.
void FactorCache::restore(ArchiveReader& archive) {
  archive(choice_, clock_, factorizations_);
  for (StageFactor& factor : factors_) {
    archive(factor);
    if (!factor.has_pattern || choice_ != equations_.rows().choice()) continue;
    factor.matrix.set_pattern(equations_.dependent());
    archive(factor.matrix);
  }
}

void FactorCache::follow_choice_of_rows() {
  if (choice_ == equations_.rows().choice()) return;
  choice_ = equations_.rows().choice();
  for (StageFactor& factor : factors_) factor.record.usable = factor.has_pattern = false;
}

}  // namespace freeplay
