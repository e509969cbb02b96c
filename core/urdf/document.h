// UrdfDocument: a URDF file as the sections of a model file.
#pragma once

#include <optional>

#include "base/diagnostics.h"
#include "format/document.h"
#include "urdf/robot.h"
#include "urdf/xml_document.h"

namespace freeplay::urdf {

/// The sections `bodies`, `joints` and `forces` that a robot file stands for. Nodes belong to a document; their places
/// are those of the URDF file.
struct Sections {
  const Node* bodies;
  const Node* joints;
  const Node* forces;
  std::optional<Options::Plane> plane;  ///< empty: the robot is spatial
  const Node* gravity = nullptr;        ///< null: the file says none
};

/// Reads `file_name`, at most 16 MiB, and adds its sections to `document`. Reports everything that is wrong, not used
/// or changed: `bad-urdf`, `urdf-massless`, `urdf-not-planar`, `out-of-range` (inertia), `duplicate-name`; warnings
/// `urdf-ignored`, `urdf-renamed`. Nothing is returned after an error.
std::optional<Sections> add_sections(const std::string& text, const std::string* file_name, const Options& options,
                                     Document& document, Diagnostics& diagnostics);
/// The same of a file that has been parsed.
std::optional<Sections> add_sections(XmlDocument& xml, const std::string* file_name, const Options& options,
                                     Document& document, Diagnostics& diagnostics);

}  // namespace freeplay::urdf
