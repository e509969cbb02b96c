// FlatModel: a model without templates and instances that moves as the one with them.
#pragma once

#include <map>
#include <string>

#include "format/document.h"
#include "format/readout.h"
#include "model/model.h"

namespace freeplay {

/// "leg1.crank" to "leg1_crank": what instances declare gets names that a person may declare. Every old name by itself,
/// whatever it names; names that keep do not occur.
using Renaming = std::map<std::string, std::string, std::less<>>;

struct FlatModel {
  std::string text;  ///< a YAML model
  Renaming renamed;
};

/// Writes every instance out under its new names. Values inside templates become numbers in SI, references and patterns
/// the names that they stand for, presets the keys that they hold; the top level stays as it is, but for names.
/// `readout` was filled while `model` was built from `document`.
FlatModel flat_model(const Document& document, const Model& model, const Readout& readout);

/// Does the document have instances?
bool has_instances(const Document& document);

}  // namespace freeplay
