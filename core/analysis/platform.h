// Platform: what an analysis looks at in a model: the frame that moves, the joints that move it, its path.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "analysis/pose_form.h"
#include "model/model.h"

namespace freeplay {

/// The platform as the section `analysis` names it. What the section leaves out comes from the only
/// inverse-kinematics driver; inputs, if there is none, are all joints that a driver prescribes.
struct Platform {
  int marker = 0;           ///< index into Model::markers, on a body
  std::vector<int> inputs;  ///< joints
  std::vector<int> elbow;   ///< 1 or -1, by input
  bool elbow_given = false;
  FramePath path;     ///< gives nothing where none is known
  Location location;  ///< of what names the frame

  bool has_path() const { return path.gives_any(); }
  Components path_components() const;
};

/// What the command line puts in place of the section.
struct PlatformOverrides {
  std::optional<int> marker;
  std::vector<int> elbow;  ///< empty, one for all inputs, or one each
};

/// Throws Error{input}: "missing-key" (no frame is known), "wrong-type" (a joint that cannot be driven, a frame on
/// ground), "driver-on-clearance", "wrong-length" (modes); Error{usage} "bad-value" for modes of the command line.
[[gnu::cold]] Platform platform_of(const Model& model, const PlatformOverrides& overrides = {});

/// Index into Model::markers of BODY or BODY/FRAME; the marker is made when it is new. Throws Error{usage}
/// "unknown-name" with the nearest name.
int frame_marker(Model& model, const std::string& reference);

}  // namespace freeplay
