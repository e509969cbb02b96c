// build_model: from the text of a model file to the checked mechanism.
#pragma once

#include <memory>

#include "base/diagnostics.h"
#include "component/registry.h"
#include "model/build_options.h"
#include "model/document.h"
#include "model/model.h"

namespace freeplay {

/// Checks the whole document and reports every mistake to `diagnostics`; null when there is an error. Throws
/// Error{usage} for an option that fits no model (`--set` of an unknown parameter or of a text that does not parse,
/// `--ideal` without a match, an unknown `--integrator`) and Error{plugin} for the key `plugins` and for a component
/// that fails. The model keeps what it uses of the registry alive.
std::unique_ptr<Model> build_model(const Document& document, const Registry& registry, const BuildOptions& options,
                                   Diagnostics& diagnostics);

}  // namespace freeplay
