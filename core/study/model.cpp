#include "study/model.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/error.h"
#include "base/input_text.h"
#include "base/kept_input.h"
#include "base/name_pattern.h"
#include "base/sha256.h"
#include "format/key_table.h"
#include "format/model_builder.h"
#include "format/path_override.h"
#include "format/run_override.h"
#include "load/model_file.h"
#include "load/plugins.h"
#include "study/document_json.h"
#include "yaml/document.h"

namespace freeplay {
namespace {

/// The option as which a target acts: "--ideal", "--end".
std::string option_of(const std::string& target) { return "--" + target.substr(target.find('.') + 1); }

/// What the command line would refuse, as a message about a value.
ModelProbe::Result refused(const Error& error, const TargetTexts& set) {
  ModelProbe::Result result;
  Diagnostic diagnostic = as_diagnostic(error);
  diagnostic.location = {};
  for (const auto& [target, text] : set) {
    const std::string start = "--set " + target;
    const bool name = error.message().starts_with(start + ": ");
    const bool acting = is_run_override(target) && error.message().starts_with(option_of(target) + " ");
    if (!name && !acting && !error.message().starts_with(start + "=")) continue;
    result.refused = target;
    diagnostic.id = name ? "unknown-name" : target == "simulation.integrator" ? "unknown-type" : "bad-value";
    for (const std::string& before :
         {start + ": ", start + "='" + text + "': ", option_of(target) + " " + text + ": "}) {
      if (error.message().starts_with(before)) diagnostic.message = error.message().substr(before.size());
    }
    break;
  }
  if (!result.refused) throw error;
  result.errors.push_back(std::move(diagnostic));
  return result;
}

std::set<std::string> parameters_of(const Document& document) {
  std::set<std::string> names;
  const Node* parameters = document.root().find("parameters");
  if (parameters == nullptr) return names;
  for (const Node::Entry& entry : parameters->entries) names.insert(entry.key->text);
  return names;
}

std::vector<InputFile> libraries(const std::vector<std::string>& files) {
  std::vector<InputFile> libraries;
  for (const std::string& file : files) {
    std::ifstream stream(file, std::ios::binary);
    libraries.push_back(
        {std::filesystem::path(file).filename().string(), {std::istreambuf_iterator<char>(stream), {}}});
  }
  return libraries;
}

}  // namespace

std::string fingerprint(const Document& document, std::vector<InputFile> inputs) {
  constexpr std::array<std::string_view, 1> without = {"study"};
  std::ranges::sort(inputs, {}, &InputFile::name);
  Sha256 hash;
  const std::string text = document_json(document.root(), without);
  hash.add(text.data(), text.size());
  for (const InputFile& input : inputs) hash.add(input.text.data(), input.text.size());
  return hash.digits();
}

bool StudyModel::has(const std::string& target) const {
  if (parameters.contains(target)) return true;
  if (is_run_override(target)) return target != "repeat" || has_play;
  if (!PathOverrides::is_path(target)) return false;
  if (!is_pattern(target)) return std::ranges::binary_search(addresses, target) || may_have(target);
  return std::ranges::any_of(addresses, [&](const std::string& address) { return matches(target, address); });
}

bool StudyModel::may_have(const std::string& target) const {
  // Elements of a section that is not there have no keys.
  const FormatKey* section = format_map("model").find(target.substr(0, target.find('.')));
  const bool of_names = section != nullptr && section->value.starts_with("entries of");
  const auto offers = [&](const std::string& beginning) {
    return (!of_names || beginning.find('.') != std::string::npos) && std::ranges::binary_search(offered, beginning);
  };
  if (offers(target)) return true;
  for (std::size_t dot = target.find('.'); dot != std::string::npos; dot = target.find('.', dot + 1)) {
    if (offers(target.substr(0, dot)) || offers(target.substr(0, dot + 1))) return true;
  }
  return false;
}

ModelProbe::ModelProbe(const Document& document, const LoadOptions& options)
    : document_(document), registry_(load_registry(options, &document)) {}

ModelProbe::Result ModelProbe::build(const TargetTexts& set, std::vector<std::string>* addresses,
                                     std::vector<std::string>* offered) const {
  BuildOptions options;
  options.set = set;
  options.parse_value = parse_yaml;
  options.without_study = true;
  options.addresses = addresses;
  options.offered = offered;
  Result result;
  Diagnostics diagnostics;
  try {
    result.model = build_model(document_, registry_, options, diagnostics);
  } catch (const Error& error) {
    if (error.category() == Error::Category::usage) return refused(error, set);
    if (error.category() != Error::Category::input && error.category() != Error::Category::plugin) throw;
    diagnostics.add(as_diagnostic(error));
  }
  for (Diagnostic& diagnostic : diagnostics.sorted()) {
    if (diagnostic.severity == Severity::error) result.errors.push_back(std::move(diagnostic));
  }
  return result;
}

std::optional<StudyModel> read_study_model(const std::string& place, const std::string& file, const TargetTexts& set,
                                           const LoadOptions& options, Diagnostics& diagnostics,
                                           std::vector<Diagnostic>& about_set) {
  std::optional<Document> document = read_model(place, diagnostics);
  if (!document || diagnostics.has_errors()) return std::nullopt;
  StudyModel made;
  made.file = file;
  made.document = std::make_unique<const Document>(std::move(*document));
  const ModelProbe probe(*made.document, options);
  ModelProbe::Result built = probe.build(set, &made.addresses, &made.offered);
  for (Diagnostic& error : built.errors) {
    if (built.refused) error.location.file = "--set " + *built.refused;
    if (error.location.file.starts_with("--set ")) {
      about_set.push_back(std::move(error));
    } else {
      diagnostics.add(std::move(error));
    }
  }
  if (!built.model) return std::nullopt;
  for (std::vector<std::string>* paths : {&made.addresses, &made.offered}) {
    std::ranges::sort(*paths);
    paths->erase(std::unique(paths->begin(), paths->end()), paths->end());
  }
  made.parameters = parameters_of(*made.document);
  made.has_play = built.model->clearance_joints() > 0 || !built.model->ideal.empty();
  made.inputs = built.model->inputs;
  made.plugins = libraries(own_plugins(probe.registry()));
  made.name = built.model->name;
  made.sha256 = fingerprint(*made.document, made.inputs);
  return made;
}

std::optional<StudyModel> read_kept_model(const std::string& place, const std::string& file, Diagnostics& diagnostics) {
  std::optional<Document> document = read_model(place, diagnostics);
  if (!document || diagnostics.has_errors()) return std::nullopt;
  StudyModel made;
  made.file = file;
  made.document = std::make_unique<const Document>(std::move(*document));
  made.parameters = parameters_of(*made.document);
  std::error_code none;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(place).parent_path() / "inputs", none)) {
    InputFile input{entry.path().filename().string(), {}};
    if (!input.name.starts_with('.') && read_input(entry.path().string(), input.text).empty()) {
      made.inputs.push_back(std::move(input));
    }
  }
  made.plugins = libraries(kept_libraries(place));
  made.sha256 = fingerprint(*made.document, made.inputs);
  return made;
}

std::set<std::string> addressed(const std::vector<StudyModel>& models, const std::string& target) {
  if (!is_pattern(target)) return {target};
  std::set<std::string> all;
  for (const StudyModel& model : models) {
    std::ranges::copy_if(model.addresses, std::inserter(all, all.end()),
                         [&](const std::string& address) { return matches(target, address); });
  }
  return all;
}

}  // namespace freeplay
