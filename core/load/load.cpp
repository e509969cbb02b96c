#include "load/load.h"

#include <algorithm>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "format/model_builder.h"
#include "format/run_override.h"
#include "load/channel_check.h"
#include "load/model_file.h"
#include "load/plugins.h"
#include "run/play_start.h"
#include "run/simulation.h"
#include "yaml/document.h"

namespace freeplay {
namespace {

/// Takes what was thrown while a model was made of `document`, which may be null, into the messages.
void keep(const Error& error, const Document* document, bool strict, Diagnostics& diagnostics, int& exit_code) {
  if (error.category() != Error::Category::input && error.category() != Error::Category::plugin) throw error;
  Diagnostic diagnostic = as_diagnostic(error);
  if (error.location().file.empty() && document != nullptr) diagnostic.location = {document->file_name(), 0, 0};
  exit_code = error.exit_code();
  if (error.category() == Error::Category::plugin) {
    // Reported alone: without the plugin the rest of the file cannot be judged.
    diagnostics = Diagnostics(strict);
    if (document != nullptr) diagnostics.add_source(document->file_name(), document->text());
  }
  diagnostics.add(std::move(diagnostic));
}

const Document* document_of(const LoadedModel& loaded) { return loaded.document ? &*loaded.document : nullptr; }

using Types = std::function<Registry(const Document&)>;
using Read = std::function<std::optional<Document>(Diagnostics&)>;

std::unique_ptr<Model> build_checked(const Document& document, const Registry& registry, BuildOptions build,
                                     Diagnostics& diagnostics) {
  build.parse_value = parse_yaml;
  return build_model(
      document, registry, build, diagnostics, [&](const Model& model, const std::vector<std::string>& unsure) {
        check_channels(model, document, unsure, !build.channels.empty(), !build.without_study, diagnostics);
      });
}

/// Without a model there is an exit code.
void settle(LoadedModel& loaded) {
  if (!loaded.diagnostics.has_errors() && loaded.model) return;
  loaded.model.reset();
  if (loaded.exit_code == 0) loaded.exit_code = 3;
}

LoadedModel load(const Read& read, const BuildOptions& build, const LoadOptions& options, const Types& types) {
  LoadedModel loaded{Diagnostics(options.strict), {}, {}, 0};
  try {
    loaded.document = read(loaded.diagnostics);
    if (loaded.document) {
      const Registry registry = types(*loaded.document);
      loaded.model = build_checked(*loaded.document, registry, build, loaded.diagnostics);
    }
  } catch (const Error& error) {
    keep(error, document_of(loaded), options.strict, loaded.diagnostics, loaded.exit_code);
  }
  settle(loaded);
  if (options.note && loaded.model && loaded.model->ideal.empty() && !build.largest_step &&
      std::ranges::find(build.ideal, "all") != build.ideal.end()) {
    options.note(
        fmt::format("--ideal all: no joint of '{}' has clearance, nothing was made ideal", loaded.model->file));
  }
  return loaded;
}

}  // namespace

LoadedModel load_model(const std::string& file, const BuildOptions& build, const LoadOptions& options) {
  return load([&](Diagnostics& diagnostics) { return read_model(file, diagnostics); }, build, options,
              [&](const Document& document) { return load_registry(options, &document); });
}

LoadedModel load_text(std::string text, const std::string& file, const BuildOptions& build,
                      const LoadOptions& options) {
  return load([&](Diagnostics& diagnostics) { return parse_yaml(std::move(text), file, diagnostics); }, build, options,
              [&](const Document& document) { return load_registry(options, &document); });
}

LoadedModel load_text(std::string text, const std::string& file, const BuildOptions& build, const Registry& registry) {
  return load([&](Diagnostics& diagnostics) { return parse_yaml(std::move(text), file, diagnostics); }, build, {},
              [&](const Document&) { return registry; });
}

LoadedModel load_document(const Document& document, const BuildOptions& build, const Registry& registry) {
  LoadedModel loaded{Diagnostics(), {}, {}, 0};
  try {
    loaded.model = build_checked(document, registry, build, loaded.diagnostics);
  } catch (const Error& error) {
    keep(error, nullptr, false, loaded.diagnostics, loaded.exit_code);
  }
  settle(loaded);
  return loaded;
}

void require_planar(const LoadedModel& loaded, const std::string& what) {
  if (!loaded.model || loaded.model->space == Space::planar) return;
  throw Error(Error::Category::input, "type-space",
              what + " works on planar models only, but '" + loaded.model->file + "' is spatial");
}

namespace {

Start start_of(System& system) {
  const StartChoice choice = start_choice(system.model());
  return assemble_in_play(system, choice.seed, choice.repeat - 1);
}

/// Warns of starts that could as well be others.
void judge_start(const StartReport& report, Diagnostics& diagnostics) {
  for (const TwinStart& twin : report.twins) {
    diagnostics.warning(twin.location, 1, "ambiguous-start", sentence(twin), {},
                        fmt::format("give '{}' a `pose` that is nearer to one of them", twin.body));
  }
}

}  // namespace

AssembledModel::AssembledModel(const Model& model) : system(model), start(start_of(system)) {}

std::unique_ptr<AssembledModel> assemble_model(const Model& model, const Document* document, Diagnostics& diagnostics,
                                               int& exit_code) {
  try {
    auto assembled = std::make_unique<AssembledModel>(model);
    require_attainable_accuracy(assembled->system);
    for (const StructureDoubt& doubt : assembled->start.structure.doubts) {
      diagnostics.warning(doubt.location, doubt.length, doubt.id, doubt.message);
    }
    judge_start(assembled->start.report, diagnostics);
    if (diagnostics.has_errors()) {  // with --strict
      exit_code = 3;
      return nullptr;
    }
    return assembled;
  } catch (const Error& error) {
    keep(error, document, false, diagnostics, exit_code);
    return nullptr;
  }
}

std::unique_ptr<AssembledModel> assemble_model(LoadedModel& loaded) {
  return assemble_model(*loaded.model, document_of(loaded), loaded.diagnostics, loaded.exit_code);
}

}  // namespace freeplay
