// MjcfDocument: an MJCF file, the format of MuJoCo, as the sections of a model file.
#pragma once

#include <optional>

#include "urdf/document.h"

namespace freeplay::mjcf {

/// Adds the sections of the file to `document`, with the gravity of its `option`. Reports everything that is wrong, not
/// used or changed, as urdf::add_sections() does, under ids with `mjcf` in place of `urdf`. Nothing is returned after
/// an error.
std::optional<urdf::Sections> add_sections(XmlDocument& xml, const std::string* file_name, const urdf::Options& options,
                                           Document& document, Diagnostics& diagnostics);

}  // namespace freeplay::mjcf
