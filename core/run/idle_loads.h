// IdleLoads: loads that move nothing, because constraints and drivers alone fix the motion of what they act on.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "stage/independent_rows.h"
#include "system/system.h"

namespace freeplay {

/// The two bodies of a load, each at its place or ground, and whether it turns them alone.
struct ActsOn {
  BodyId a = ground, b = ground;
  bool turns = false;
  bool operator==(const ActsOn&) const = default;
};

[[gnu::cold]] ActsOn acts_on(const System& system, const AppliedForce& force);
[[gnu::cold]] ActsOn acts_on(const System& system, const JointElement& joint);
/// That applies an effort.
[[gnu::cold]] ActsOn acts_on(const System& system, const Driver& driver);

/// No error of a step shows what such a load does to reactions and efforts of drivers. Allocates when a load is added.
class IdleLoads {
 public:
  explicit IdleLoads(const System& system);

  /// Returns the number of the load.
  [[gnu::cold]] int add(ActsOn load);
  /// From an accepted state, before the step that is made from there.
  void look(const IndependentRows& rows, const ConstraintValues& e);
  bool is_idle(int load) const { return load >= 0 && loads_[static_cast<std::size_t>(load)].idle; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.loads_, self.rank_, self.looks_, self.next_look_);
  }

 private:
  struct Load {
    ActsOn on;
    bool idle = false;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.idle);
    }
  };
  [[gnu::cold]] void find_held(const ConstraintValues& e);
  bool holds(BodyId body, bool turns) const;

  const System& system_;
  std::vector<Load> loads_;
  int rank_ = -2;                   // none yet
  long looks_ = 0, next_look_ = 0;  // since the rank is what it is
  std::vector<SparseEntry> entries_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows_;
  std::vector<int> pivots_;  // column by row
  std::vector<char> taken_;  // by column: a pivot
  std::vector<char> held_;   // by column: no free motion has a part in it
};

}  // namespace freeplay
