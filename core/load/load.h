// Load: from a file or a text to a checked model, and to a system that is ready to move. The one way in for commands,
// tests and other programs.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "assembly/assembly.h"
#include "base/diagnostics.h"
#include "component/registry.h"
#include "format/build_options.h"
#include "format/document.h"
#include "load/options.h"
#include "model/model.h"

namespace freeplay {

/// A model file after reading: a model, or messages that say why there is none.
struct LoadedModel {
  Diagnostics diagnostics;
  std::optional<Document> document;
  std::unique_ptr<Model> model;
  int exit_code = 0;  ///< 3 or 5 when something is wrong
};

/// Reads and checks `file`, with the plugins that it and the options name. Throws Error{usage} for what the options ask
/// for and the model does not have.
LoadedModel load_model(const std::string& file, const BuildOptions& build, const LoadOptions& options);

/// The same for the text of a YAML model that is at hand; `file` gives its name and the folder that paths count from.
LoadedModel load_text(std::string text, const std::string& file, const BuildOptions& build, const LoadOptions& options);

/// The same with the types of `registry` alone, whatever plugins the text names.
LoadedModel load_text(std::string text, const std::string& file, const BuildOptions& build, const Registry& registry);

/// The same for a document that has been read, with the types of `registry` alone; it stays where it is, and places of
/// messages have no text.
LoadedModel load_document(const Document& document, const BuildOptions& build, const Registry& registry);

/// Refuses a spatial model. Throws Error{input} "type-space" with what only works in the plane.
void require_planar(const LoadedModel& loaded, const std::string& what);

/// A model that is ready to move, from the start that `--set repeat` and `seed` choose. The system refers to the model.
struct AssembledModel {
  explicit AssembledModel(const Model& model);

  System system;
  Start start;
};

/// Assembles a model that was loaded from `document`, which may be null; null with a message and an exit code if it
/// cannot be put together.
std::unique_ptr<AssembledModel> assemble_model(const Model& model, const Document* document, Diagnostics& diagnostics,
                                               int& exit_code);
/// The same of `loaded`, which keeps the messages.
std::unique_ptr<AssembledModel> assemble_model(LoadedModel& loaded);

}  // namespace freeplay
