// StageEquations: the equations of motion at the points where the solvers of a stage evaluate them, and what both
// solvers share: units, redundant rows, and why an evaluation failed.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "freeplay/integrator.h"
#include "stage/independent_rows.h"
#include "system/system.h"

namespace freeplay {

class StageEquations {
 public:
  explicit StageEquations(const System& system, EvaluationContext* run = nullptr);

  const System& system() const { return system_; }
  Profile* profile() const { return e_->profile(); }
  /// h of the states handed in from now on; views must stay valid.
  void use_history(std::span<const double> h) { h_ = h; }
  Point point_of(const StateView& s) const { return {*s.t, s.q, s.v, s.z, h_}; }
  /// Fills these terms at a state; false with fault() and trouble() where an element fails.
  bool evaluate(const StateView& at, unsigned terms) {
    return system_.evaluate(point_of(at), terms, e_) || note_fault();
  }
  /// The equations where they were evaluated last.
  KeptEvaluation& evaluation() { return e_; }
  const KeptEvaluation& evaluation() const { return e_; }

  IndependentRows& rows() { return rows_; }
  const IndependentRows& rows() const { return rows_; }
  std::span<const char> dependent() const { return rows_.dependent(); }

  /// Of increments and their rates: 1 for angles, else the model's size [m].
  std::span<const double> units() const { return unit_; }
  /// Largest part of an increment or of its rates, in units; keeps a NaN.
  double norm(std::span<const double> increment) const {
    // Bits of numbers without a sign are in the order of the numbers; what is not finite comes after all others.
    constexpr std::uint64_t without_sign = ~std::uint64_t{0} >> 1;
    std::uint64_t bits = 0;
    const auto add = [&](std::size_t i) {
      bits = std::max(bits, std::bit_cast<std::uint64_t>(increment[i] * per_unit_[i]) & without_sign);
    };
    for (std::size_t i = 0; i < per_unit_.size(); i += 3) add(i), add(i + 1), add(i + 2);  // bodies have 3 or 6
    const double largest = std::bit_cast<double>(bits);
    return largest + (largest - largest);
  }

  /// Why the last call of a solver failed: an element's fault, or kind none with `trouble()`.
  const Fault& fault() const { return e_->fault; }
  const char* trouble() const { return trouble_; }
  void note_trouble(const char* text) { trouble_ = text; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.rows_, self.e_);
  }

 private:
  [[gnu::cold]] bool note_fault();  // false

  const System& system_;
  KeptEvaluation e_;
  IndependentRows rows_;
  std::span<const double> h_;
  std::vector<double> unit_, per_unit_;
  const char* trouble_ = "";
};

}  // namespace freeplay
