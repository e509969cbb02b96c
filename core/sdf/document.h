// SdfDocument: an SDFormat file as the sections of a model file.
#pragma once

#include <optional>

#include "urdf/document.h"

namespace freeplay::sdf {

/// Adds the sections of the file's world, or of its models, to `document`, with the gravity that the world says.
/// Reports everything that is wrong, not used or changed, as urdf::add_sections() does, under ids with `sdf` in place
/// of `urdf`. Nothing is returned after an error. Poses are those of SDFormat 1.7 to 1.12; older files from 1.2 on may
/// not name frames.
std::optional<urdf::Sections> add_sections(XmlDocument& xml, const std::string* file_name, const urdf::Options& options,
                                           Document& document, Diagnostics& diagnostics);

}  // namespace freeplay::sdf
