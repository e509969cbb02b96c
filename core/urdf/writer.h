// UrdfText: a planar model as a URDF file and a side-car.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/document.h"
#include "format/readout.h"
#include "model/model.h"

namespace freeplay {

struct UrdfText {
  std::string urdf;
  std::optional<Document> sidecar;  ///< what URDF cannot say, when there is something
  std::vector<std::string> notes;   ///< what a person should know
};

/// Links are the bodies, joints of the tree are the revolute, prismatic and fixed joints that lead away from ground; a
/// body that no such joint reaches floats. A link's frame stands where its joint of the tree is, with the axes of the
/// body, so that coordinates and angles keep their meaning. The side-car names `urdf_file` and holds everything else,
/// (with a frame `body-origin` where something refers to an origin that has moved) and, unless the tree stands so at
/// coordinates zero, the assembled start `q`, `v` (x, y, angle of each centre of mass) as the guess, so that the same
/// start is found again. Numbers of bodies and frames are written out: parameters in them are lost. The model must have
/// no instances: see flat_model.h.
UrdfText write_urdf(const Document& document, const Model& model, const Readout& readout, std::span<const double> q,
                    std::span<const double> v, const std::string& urdf_file);

}  // namespace freeplay
