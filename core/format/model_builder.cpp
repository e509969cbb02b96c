#include "format/model_builder.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <set>
#include <utility>

#include "base/kept_input.h"
#include "format/analysis_section.h"
#include "format/body_section.h"
#include "format/doubtful_body.h"
#include "format/doubtful_end.h"
#include "format/doubtful_gear.h"
#include "format/doubtful_load.h"
#include "format/doubtful_motion.h"
#include "format/doubtful_number.h"
#include "format/doubtful_rest.h"
#include "format/doubtful_threshold.h"
#include "format/draft.h"
#include "format/driver_section.h"
#include "format/force_section.h"
#include "format/frame_section.h"
#include "format/gear.h"
#include "format/initial_section.h"
#include "format/joint_section.h"
#include "format/name_rule.h"
#include "format/parameter_override.h"
#include "format/path_override.h"
#include "format/run_override.h"
#include "format/simulation_section.h"
#include "format/study_section.h"
#include "format/template.h"
#include "format/unused_frame.h"

namespace freeplay {
namespace {

constexpr long schema_version = 1;

class ModelBuilder {
 public:
  ModelBuilder(const Document& document, const Registry& registry, const BuildOptions& options,
               Diagnostics& diagnostics, const ColumnCheck& check_columns)
      : document_(document),
        diagnostics_(diagnostics),
        check_columns_(check_columns),
        options_(options),
        draft_(registry, options_, diagnostics),
        overrides_(options, diagnostics),
        paths_(options, diagnostics),
        parameters_(used_),
        presets_(used_),
        reading_{&diagnostics, &parameters_, &presets_, options.readout} {
    draft_.top = &reading_;
    if (!paths_.empty() || options.addresses != nullptr) reading_.paths = &paths_;
    for (const RegisteredLibrary& library : registry.libraries()) draft_.model.instances.keep(library);
  }

  std::unique_ptr<Model> build() {
    const CheckedValue root(reading_, document_.root(), nullptr, "");
    if (!root.node().is_null() && !root.node().is_map()) {
      root.fail("wrong-type", std::string("a model must be a map, not ") + root.node().kind_name());
      return nullptr;
    }
    const Node nothing{.kind = Node::Kind::map, .line = 1, .column = 1, .file = document_.root().file};
    MapReader top(root.node().is_map() ? root : CheckedValue(reading_, nothing, nullptr, ""), "model");
    if (!read_version(top)) return nullptr;
    read_parameters(top);
    if (!read_header(top)) return nullptr;
    open_sections(top);
    read_sections();
    const int errors = diagnostics_.errors();
    top.finish();
    judge_columns(diagnostics_.errors() > errors);
    if (templates_) judge_unused_templates();
    if (!diagnostics_.has_errors()) require_ideal_matches(draft_);
    if (!diagnostics_.has_errors()) paths_.require_found();
    if (!diagnostics_.has_errors()) warn_ignored_elbows(draft_);
    warn_unused();
    if (diagnostics_.has_errors()) return nullptr;
    doubt_bodies(draft_);
    doubt_motions(draft_);
    doubt_rests(draft_);
    if (simulation_) doubt_end(draft_, *simulation_);
    doubt_gears(draft_);
    doubt_loads(draft_);
    doubt_thresholds(draft_);
    if (!document_.incomplete()) warn_unused_frames(draft_);
    if (diagnostics_.has_errors()) return nullptr;  // with --strict
    keep_frames();
    return std::make_unique<Model>(std::move(draft_.model));
  }

 private:
  void keep_frames() {
    std::vector<Marker>& frames = draft_.model.frames;
    frames.reserve(draft_.frames.size());
    for (const auto& [name, frame] : draft_.frames) frames.push_back(marker_of(frame, name));
    std::ranges::sort(frames, {}, &Marker::name);
  }

  // --- head of the file ------------------------------------------------------------------------------------------

  /// Another version may mean other keys, so nothing else is read then.
  bool read_version(MapReader& top) {
    const auto version = top.require("freeplay");
    if (!version) return true;
    const auto number = version->quantity(dimension::none);
    if (!number || *number == schema_version) return true;
    version->fail("bad-version",
                  "schema version " + version->node().text + " is not known; this program reads version 1");
    return false;
  }

  /// False when the rest cannot be read sensibly.
  bool read_header(MapReader& top) {
    Model& model = draft_.model;
    model.file = document_.file_name();
    model.text = document_.text();
    model.name = kept_model_name(model.file);
    if (model.name.empty()) model.name = std::filesystem::path(model.file).stem().string();
    model.overrides = draft_.options.set;
    const auto name = top.find("name"), description = top.find("description"), space = top.find("space");
    if (name) model.name = name->string().value_or(model.name);
    if (name && model.name.empty()) name->fail("wrong-type", "'name' must not be empty");
    if (description) description->string();
    if (const auto plugins = top.find("plugins")) check_plugins(*plugins);
    // Its reader has replaced the key by what the file says; a document that comes otherwise cannot have it.
    top.refuse("urdf");
    top.refuse_old("sweep", "study");
    for (const Document::Attachment& file : document_.attachments()) {
      model.inputs.push_back({std::filesystem::path(*file.name).filename().string(), file.text});
    }
    if (space) {
      const std::optional<int> word = space->word({"planar", "spatial"});
      if (word == std::optional<int>(1)) {
        model.space = Space::spatial;
        reading_.dimensions = 3;
      }
    }
    if (const auto gravity = top.find("gravity")) {
      model.gravity = gravity->vector(dimension::acceleration).value_or(Vector3{});
      doubt_gravity(*gravity, model.gravity);
    }
    return true;
  }

  // They were loaded before types are looked up; here only the words are checked.
  static void check_plugins(const CheckedValue& plugins) {
    if (plugins.node().is_null()) return;
    if (const auto items = plugins.list()) {
      for (const CheckedValue& item : *items) item.string();
    }
  }

  void read_parameters(MapReader& top) {
    const auto section = top.find("parameters");
    if (section && !section->node().is_null()) {
      for (const CheckedValue& entry : entries_of(*section)) {
        if (!check_parameter_name(entry)) {
          parameters_.add_broken(entry.key());
          continue;
        }
        const Node* replaced = overrides_.text_of(entry.key());
        parameters_.add(entry.key(), *entry.key_node(), replaced == nullptr ? entry.node() : *replaced, entry.path(),
                        reading_, replaced != nullptr);
      }
    }
    overrides_.require_declared(parameters_);
    parameters_.evaluate();
    draft_.model.parameters = parameters_.values();
    apply_run_overrides(options_, parameters_);
    draft_.ideal_matched.assign(options_.ideal.size(), false);
  }

  // --- sections --------------------------------------------------------------------------------------------------

  static std::optional<CheckedValue> present(std::optional<CheckedValue> section) {
    if (section && section->node().is_null()) return std::nullopt;
    return section;
  }

  void open_sections(MapReader& top) {
    if (const auto presets = present(top.find("presets"))) presets_.read(*presets);
    simulation_ = present(top.find("simulation"));
    if (simulation_) reading_.start_time = read_start_time(*simulation_);
    Part& part = draft_.parts.emplace_back();
    for (const char* name : {"bodies", "frames", "joints", "drivers", "forces"}) {
      const auto section = present(top.find(name));
      if (section) part.sections.emplace(name, *section);
    }
    templates_ = present(top.find("templates"));
    initial_ = present(top.find("initial"));
    analysis_ = present(top.find("analysis"));
    study_ = present(top.find("study"));
    if (templates_) check_templates(*templates_);
    const auto instances = present(top.find("instances"));
    if (instances) expand_instances(draft_, templates_, *instances, used_, storage_);
  }

  void read_sections() {
    if (!within_limit()) return;
    add_elements(draft_);
    if (initial_) read_initial(draft_, *initial_);
    if (!read_simulation(draft_, simulation_)) draft_.unsure_columns.emplace_back("frame.");
    sections_read_ = true;
    if (analysis_) read_analysis(draft_, *analysis_);
    if (study_ && !options_.without_study) check_study();
    if (!draft_.model.bodies.empty() || diagnostics_.has_errors()) return;
    CheckedValue(reading_, document_.root(), nullptr, "").fail("empty-model", "the model has no body that moves");
  }

  // Its values are constants, and no values of the command line take their places.
  void check_study() {
    UsedKeys none;
    const ParameterScope constants(none);
    const Reading reading{&diagnostics_, &constants};
    const auto dimension_of = [&](const std::string& target) -> std::optional<Dimension> {
      const Quantity* declared = parameters_.declares(target) ? parameters_.find(target) : nullptr;
      if (declared == nullptr || declared->kind != DimensionKind::dimensioned) return std::nullopt;
      return declared->dimension;
    };
    const StudySection study =
        read_study(CheckedValue(reading, study_->node(), study_->key_node(), study_->path()), true, dimension_of);
    for (const TargetValue& one : study.set) require_target(one.target, one.value);
    for (const StudyAxis& axis : study.axes) {
      if (!axis.each && !axis.target.empty()) require_target(axis.target, axis.entry);
      for (const StudyCase& one : axis.cases) {
        for (const TargetValue& value : one.values) require_target(value.target, value.value);
      }
    }
  }

  // Paths are known to those who try values at them.
  void require_target(const std::string& target, const CheckedValue& written) const {
    if (PathOverrides::is_path(target) || parameters_.declares(target)) return;
    written.fail_at_key("unknown-name", "unknown parameter '" + target + "'", nearest(target, parameters_.names()));
  }

  // Names of columns do not depend on values: what other mistakes leave in doubt alone is not judged.
  void judge_columns(bool misspelt_section) {
    if (!check_columns_ || !sections_read_ || draft_.model.bodies.empty()) return;
    std::vector<std::string>& unsure = draft_.unsure_columns;
    const Node& root = document_.root();
    const Node* instances = root.find("instances");
    const bool all =
        instances == nullptr ? misspelt_section && templates_ : !instances->is_map() && !instances->is_null();
    for (const auto& [kind, word] : {std::pair("body.", "bodies"), std::pair("joint.", "joints"),
                                     std::pair("driver.", "drivers"), std::pair("force.", "forces")}) {
      const char* const name = word;  // clang 14 captures no structured bindings
      const bool missing = misspelt_section && root.find(name) == nullptr;
      const bool wrong = std::ranges::any_of(draft_.parts, [&](const Part& part) {
        const auto section = part.section(name);
        return section && !section->node().is_map();
      });
      if (all || missing || wrong) unsure.emplace_back(kind);
      for (const std::string& instance : draft_.broken_instances) unsure.push_back(kind + instance);
    }
    check_columns_(draft_.model, unsure);
  }

  // In a model of its own: nothing of it becomes part of this one. What it may refer to around it is not known.
  void judge_unused_templates() {
    for (const CheckedValue& entry : entries_of(*templates_)) {
      if (used_.contains(entry.key_node()) || !entry.node().is_map()) continue;
      const std::set<std::string> excused = diagnostics_.excuse({"unknown-name"});
      Draft alone(draft_.registry, draft_.options, diagnostics_);
      alone.top = &reading_;
      alone.ideal_matched.assign(draft_.options.ideal.size(), false);
      alone.model.file = draft_.model.file;
      alone.parts.emplace_back();
      UsedKeys used;
      expand_alone(alone, entry, used, storage_);
      add_elements(alone);
      diagnostics_.excuse(excused);
    }
  }

  static void add_elements(Draft& draft) {
    for (const Part& part : draft.parts) add_bodies(draft, part);
    for (const Part& part : draft.parts) add_frames(draft, part);
    draft.length_scale = length_scale(draft);
    for (const Part& part : draft.parts) add_joints(draft, part);
    for (const Part& part : draft.parts) add_gears(draft, part);
    for (const Part& part : draft.parts) add_drivers(draft, part);
    for (const Part& part : draft.parts) add_forces(draft, part);
    draft.model.bodies.shrink_to_fit();
    draft.model.markers.shrink_to_fit();
    draft.model.joints.shrink_to_fit();
  }

  bool within_limit() {
    std::size_t count = 0;
    for (const Part& part : draft_.parts) {
      for (const char* name : {"bodies", "joints", "drivers", "forces"}) {
        const auto section = part.section(name);
        if (section) count += section->node().entries.size();
      }
    }
    if (count <= static_cast<std::size_t>(largest_model)) return true;
    CheckedValue(reading_, document_.root(), nullptr, "")
        .fail("too-large", "a model has at most " + std::to_string(largest_model) + " elements");
    return false;
  }

  // --- warnings --------------------------------------------------------------------------------------------------

  void warn_unused() {
    // What an error kept from being read may well use it.
    if (diagnostics_.has_errors()) return;
    const Node& root = document_.root();
    // A value in the place of another may leave a parameter without use, and that is meant so.
    if (paths_.empty()) warn_unused_in(root.find("parameters"), "parameter");
    warn_unused_in(root.find("presets"), "preset");
    const Node* templates = root.find("templates");
    warn_unused_in(templates, "template");
    if (templates == nullptr) return;
    for (const Node::Entry& entry : templates->entries) {
      if (used_.contains(entry.key)) warn_unused_in(entry.value->find("parameters"), "parameter");
    }
  }

  void warn_unused_in(const Node* section, const std::string& kind) {
    if (section == nullptr) return;
    for (const Node::Entry& entry : section->entries) {
      if (is_note(entry.key->text) || used_.contains(entry.key)) continue;
      CheckedValue(reading_, *entry.value, entry.key, entry.key->text)
          .warn_at_key("unused", kind + " '" + entry.key->text + "' is not used");
    }
  }

  const Document& document_;
  Diagnostics& diagnostics_;
  const ColumnCheck& check_columns_;
  bool sections_read_ = false;
  BuildOptions options_;
  Draft draft_;
  ParameterOverrides overrides_;
  PathOverrides paths_;
  UsedKeys used_;
  ParameterScope parameters_;
  PresetTable presets_;
  Reading reading_;
  InstanceStorage storage_;
  std::optional<CheckedValue> simulation_, templates_, initial_, analysis_, study_;
};

}  // namespace

std::vector<NamedPlugin> named_plugins(const Document& document) {
  std::vector<NamedPlugin> plugins;
  const Node* list = document.root().is_map() ? document.root().find("plugins") : nullptr;
  if (list == nullptr || !list->is_list()) return plugins;
  for (const Node* item : list->items) {
    if (item->is_scalar()) plugins.push_back({item->text, item->location()});
  }
  return plugins;
}

std::unique_ptr<Model> build_model(const Document& document, const Registry& registry, const BuildOptions& options,
                                   Diagnostics& diagnostics, const ColumnCheck& check_columns) {
  if (document.incomplete()) diagnostics.excuse({"unknown-name", "missing-key", "empty-model"});
  return ModelBuilder(document, registry, options, diagnostics, check_columns).build();
}

}  // namespace freeplay
