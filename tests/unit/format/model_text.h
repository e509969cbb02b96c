// Builds models from texts, for tests.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "format/model_builder.h"
#include "toy_components.h"
#include "yaml/document.h"

namespace freeplay {

struct Built {
  std::unique_ptr<Model> model;
  std::string report;  ///< the diagnostics as printed
  /// "line:column id" of every message, each ended by a blank.
  std::string places;
};

inline Built build(const std::string& text, const BuildOptions& options = {}, bool strict = false) {
  static const Registry registry = [] {
    Registry toys;
    toys.add(&toy::publish_toys, "toys");
    return toys;
  }();
  Diagnostics diagnostics(strict);
  Built built;
  const std::optional<Document> document = parse_yaml(text, "m.yaml", diagnostics);
  if (document) built.model = build_model(*document, registry, options, diagnostics);
  built.report = diagnostics.format(0);
  for (const Diagnostic& d : diagnostics.sorted()) {
    built.places += std::to_string(d.location.line) + ":" + std::to_string(d.location.column) + " " + d.id + " ";
  }
  return built;
}

/// A sound model of one body on line 3, with `more` from line 4 on.
inline std::string with_rod(const std::string& more) {
  return "freeplay: 1\n"
         "bodies:\n"
         "  rod: {mass: 1, inertia: 1, frames: {tip: [1, 0]}}\n" +
         more;
}

}  // namespace freeplay
