// Model files: reads whatever file a model is written in.
#pragma once

#include <optional>
#include <string>

#include "base/diagnostics.h"
#include "format/document.h"

namespace freeplay {

/// Reads a model file. A robot file (URDF or MJCF) becomes a complete model; in a YAML file the section `urdf` is
/// replaced by the bodies, joints and forces of the robot file that it names, to which the file's own are added
/// (section 13 of the model format). Everything else is as parse_yaml() gives it. Reports also `file-not-found`;
/// directories and devices are not opened. After an error in a robot file nothing is returned, or the rest of the YAML
/// model, incomplete().
std::optional<Document> read_model(const std::string& file_name, Diagnostics& diagnostics);

/// The same for a text that is at hand; files that it names are looked for beside `file_name`.
std::optional<Document> parse_model(std::string text, const std::string& file_name, Diagnostics& diagnostics);

/// Is it a URDF file, by its name?
bool is_urdf(const std::string& file_name);
/// Is it a robot file, by its name: `.urdf`, `.sdf` or `.xml`? The root element says which format it has.
bool is_robot(const std::string& file_name);

}  // namespace freeplay
