// build_model: from the text of a model file to the checked mechanism.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "component/registry.h"
#include "format/build_options.h"
#include "format/document.h"
#include "model/model.h"

namespace freeplay {

/// An entry of `plugins`: a path or a name, and its place.
struct NamedPlugin {
  std::string word;
  Location location;
};

/// The plugins that a model asks for. They are to be in the registry before build_model().
std::vector<NamedPlugin> named_plugins(const Document& document);

/// Asked to judge what the file says of result columns, which follow from the whole mechanism. `unsure` are beginnings
/// of names ("joint.", "joint.leg1.B.") that cannot be judged, as what has such columns is in error.
using ColumnCheck = std::function<void(const Model& model, const std::vector<std::string>& unsure)>;

/// Checks the whole document and reports every mistake to `diagnostics`; null when there is an error. Throws
/// Error{usage} for an option that fits no model (`--set` of an unknown parameter or of a text that does not parse,
/// `--ideal` without a match, an unknown `--integrator`), Error{plugin} for a component that fails, and Error{input}
/// when `diagnostics` is full. `check_columns` is called at most once, also when there are
/// mistakes. The model keeps what it uses of the registry alive.
std::unique_ptr<Model> build_model(const Document& document, const Registry& registry, const BuildOptions& options,
                                   Diagnostics& diagnostics, const ColumnCheck& check_columns = {});

}  // namespace freeplay
