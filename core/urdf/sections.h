// UrdfSections: a robot as the sections of a model, in the plane or in space.
#pragma once

#include <optional>

#include "urdf/document.h"
#include "urdf/names.h"
#include "urdf/view.h"

namespace freeplay::urdf {

/// The sections of a robot as `view` sees it; `plane` is that of the view, empty in space. Reports joints that the
/// model cannot have: `bad-urdf`.
Sections write_sections(const Robot& robot, View& view, std::optional<Options::Plane> plane, Names& names,
                        const Options& options, Nodes& nodes, Messages& messages);

}  // namespace freeplay::urdf
