// AnalysisRequest: what an analysis is asked, in numbers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/play_law.h"
#include "analysis/pose_form.h"
#include "base/jet.h"
#include "model/grid_values.h"

namespace freeplay {

enum class AnalysisKind { inverse_kinematics, workspace, singularity, error, inverse_dynamics };

struct ErrorColumns {
  long samples = 0;  ///< of random play
  std::uint64_t seed = 0;
  PlayLaw law;
  bool sensitivity = false;
};

/// Components of a pose that are given, and their values.
struct PoseWords {
  Components given{};
  FramePose value{};
};

/// At most one of `poses`, `inputs`, `times` and `grid` says where; else the model file does: its grid, or for inverse
/// kinematics and dynamics its path.
struct AnalysisRequest {
  struct Pose {
    PoseWords pose;
    std::string words;  ///< how messages name it
  };
  struct Inputs {
    std::vector<Jet> values;  ///< by input; NaN: left open
    std::string words;        ///< as it was written
  };

  AnalysisKind kind = AnalysisKind::inverse_kinematics;
  std::vector<Pose> poses;  ///< which give the same components
  std::vector<Inputs> inputs;
  std::optional<GridValues> times;
  std::array<std::optional<GridValues>, most_components> grid;  ///< by component of a pose
  bool branches = false;                                        ///< inverse kinematics: every posture of each pose
  bool chooses_elbow = false;                                   ///< working modes are not those of the model file
  ErrorColumns error;
  double preload = 0.0;  ///< inner tension of redundant drivers [N or N m]
  int threads = 1;

  bool asks_for_grid() const {
    for (const auto& axis : grid) {
      if (axis) return true;
    }
    return false;
  }
  /// Poses that cannot be reached are errors.
  bool must_reach() const { return kind == AnalysisKind::inverse_kinematics || kind == AnalysisKind::inverse_dynamics; }
};

}  // namespace freeplay
