#include "study/file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "base/error.h"
#include "base/input_text.h"
#include "base/json_text.h"
#include "base/kept_input.h"
#include "base/name_pattern.h"
#include "base/sha256.h"
#include "format/map_reader.h"
#include "format/name_rule.h"
#include "format/path_override.h"
#include "format/run_override.h"
#include "load/model_file.h"
#include "study/document_json.h"
#include "study/reducer_entry.h"
#include "yaml/document.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr const char* record_file = "inputs/study.json";  // beside the copies: what they do not say
constexpr std::array reserved_columns = {"index", "model", "direction", "sample", "start", "exit_code", "error"};

constexpr std::size_t most_fitting = 10'000;  // axes of one pattern

std::string model_copy(std::size_t number, const std::string& file) {
  return fmt::format("inputs/{}/model{}", number, is_robot(file) ? fs::path(file).extension().string() : ".yaml");
}

std::string table_copy(std::size_t axis) { return fmt::format("inputs/table{}.csv", axis); }

bool is_text(const Json& object, const char* key) {
  return object.is_object() && object.value(key, Json()).is_string();
}

/// Is it what kept_files() writes?
bool is_record(const Json& record, std::size_t models) {
  if (!is_text(record, "name") || !record.contains("set") || !record.contains("models")) return false;
  const auto pair = [](const Json& one) {
    return one.is_array() && one.size() == 2 && one[0].is_string() && one[1].is_string();
  };
  const auto model = [](const Json& one) { return is_text(one, "name") && is_text(one, "file"); };
  return std::ranges::all_of(record["set"], pair) && std::ranges::all_of(record["models"], model) &&
         record["models"].size() == models;
}

/// Can the points be known without building the model?
bool has_addresses(const Json& model) {
  const Json addresses = model.value("addresses", Json());
  return addresses.is_array() && std::ranges::all_of(addresses, [](const Json& one) { return one.is_string(); }) &&
         model.value("play", Json()).is_boolean();
}

Json record_beside(const std::string& file, std::size_t models) {
  std::ifstream stream(fs::path(file).parent_path() / record_file);
  const Json record = stream ? Json::parse(stream, nullptr, false) : Json();
  if (is_record(record, models)) return record;
  throw Error(Error::Category::input, "file-not-found",
              fmt::format("'{}' stands in no folder of a study: there is no {} that fits it", file, record_file));
}

}  // namespace

bool has_study_alone(const Node& root) {
  return root.find("study") != nullptr && std::ranges::all_of(root.entries, [](const Node::Entry& entry) {
           const std::string& key = entry.key->text;
           return key == "freeplay" || key == "study" || is_note(key);
         });
}

StudyFile::StudyFile(Document document, Diagnostics& diagnostics)
    : document_(std::move(document)), no_parameters_(none_used_), reading_{&diagnostics, &no_parameters_} {}

std::unique_ptr<StudyFile> StudyFile::read(const std::string& file, const KeptStudy& kept, const TargetTexts& set,
                                           const LoadOptions& options, Diagnostics& diagnostics) {
  std::string text;
  if (const std::string why = read_input(file, text); !why.empty()) {
    diagnostics.error({file, 0, 0}, 1, "file-not-found", fmt::format("cannot read '{}': {}", file, why));
    return nullptr;
  }
  std::optional<Document> document = parse_yaml(std::move(text), file, diagnostics);
  if (!document || diagnostics.has_errors()) return nullptr;
  std::unique_ptr<StudyFile> study(new StudyFile(std::move(*document), diagnostics));
  study->kept_ = kept.kept;
  study->look_ = kept.look;
  if (!study->read_section(diagnostics)) return nullptr;
  study->combine_set(set);
  if (!study->read_models(options, diagnostics)) return nullptr;
  study->plan_axes();
  study->check_targets(options);
  study->check_columns();
  return study;
}

bool StudyFile::read_section(Diagnostics& diagnostics) {
  const CheckedValue root(reading_, document_.root(), nullptr, "");
  if (!root.node().is_map()) {
    root.fail("wrong-type", fmt::format("a study must be a map, not {}", root.node().kind_name()));
    return false;
  }
  in_model_ = !has_study_alone(root.node());
  MapReader map(root, "model");
  const auto version = map.require("freeplay");
  const auto study = map.require("study");
  if (version && version->quantity(dimension::none).value_or(1.0) != 1.0) {
    version->fail("bad-version", fmt::format("schema version {} is not known", version->node().text));
  }
  if (study) section_ = read_study(*study, in_model_);
  if (!section_ || diagnostics.has_errors()) {
    if (study) check_reducers(*study);
    return false;
  }
  const std::string stem = fs::path(document_.file_name()).stem().string();
  name_ = section_->name.empty() ? stem : section_->name;
  if (kept_) {
    record_ = record_beside(document_.file_name(), in_model_ ? 1 : section_->models.size());
    look_ = look_ && std::ranges::all_of(record_["models"], has_addresses);
    name_ = record_["name"].get<std::string>();
  }
  return true;
}

/// What they look like, where the rest of the section is wrong.
void StudyFile::check_reducers(const CheckedValue& section) const {
  const Node* reducers = section.node().is_map() ? section.node().find("reducers") : nullptr;
  if (reducers == nullptr || !reducers->is_map()) return;
  const Node* points = section.node().find("do");
  read_reducers(CheckedValue(reading_, *reducers, nullptr, "study.reducers"), points != nullptr && points->is_map());
}

// The last one of a target counts; those of the command line come after the file's.
void StudyFile::combine_set(const TargetTexts& set) {
  if (kept_) {
    for (const Json& one : record_["set"]) {
      command_set_.emplace_back(one[0].get<std::string>(), one[1].get<std::string>());
    }
  }
  command_set_.insert(command_set_.end(), set.begin(), set.end());
  for (const TargetValue& value : section_->set) {
    const Node& node = value.value.node();
    set_.push_back({value.target, AxisValue::of(node)});
    if (node.is_scalar()) set_.back().value.text = node.text;
  }
  for (const auto& [target, text] : command_set_) {
    const std::string& name = target;
    std::erase_if(set_, [&](const PlannedSetting& other) { return other.target == name; });
    set_.push_back({target, AxisValue::of(text)});
    set_.back().value.text = text;
  }
}

TargetTexts StudyFile::set_texts() const {
  TargetTexts texts;
  for (const PlannedSetting& setting : set_) texts.emplace_back(setting.target, setting.value.text);
  return texts;
}

std::optional<StudyModel> StudyFile::read_one_model(std::size_t number, const std::string& place,
                                                    const std::string& written, const LoadOptions& options,
                                                    Diagnostics& diagnostics,
                                                    std::vector<Diagnostic>& about_set) const {
  if (!look_) return read_study_model(place, written, set_texts(), options, diagnostics, about_set);
  const Json& record = record_["models"][number];
  auto model = read_kept_model(place, written, diagnostics);
  if (!model) return model;
  model->addresses = record["addresses"].get<std::vector<std::string>>();
  model->has_play = record.value("play", false);
  return model;
}

bool StudyFile::read_models(const LoadOptions& options, Diagnostics& diagnostics) {
  const fs::path folder = fs::path(document_.file_name()).parent_path();
  std::vector<Diagnostic> about_set;
  const std::size_t count = in_model_ ? 1 : section_->models.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::string written = in_model_ ? document_.file_name() : section_->models[i].path.node().text;
    std::string place = in_model_ ? written : (folder / written).lexically_normal().string();
    if (kept_) place = (folder / model_copy(i, record_["models"][i]["file"].get<std::string>())).string();
    std::error_code ignored;
    if (!in_model_ && !fs::exists(place, ignored)) {
      section_->models[i].path.fail("file-not-found", fmt::format("there is no file '{}'", place));
      continue;
    }
    auto model = read_one_model(i, place, written, options, diagnostics, about_set);
    if (!model) continue;
    if (kept_) {
      model->file = record_["models"][i]["file"].get<std::string>();
      model->name = record_["models"][i]["name"].get<std::string>();
    } else if (!in_model_ && !section_->models[i].name.empty()) {
      model->name = section_->models[i].name;
    }
    models_.push_back(std::move(*model));
  }
  report_about_set(std::move(about_set), diagnostics);
  if (models_.size() == count && !diagnostics.has_errors()) name_models();
  return !diagnostics.has_errors();
}

void StudyFile::report_about_set(std::vector<Diagnostic> errors, Diagnostics& diagnostics) const {
  for (Diagnostic& error : errors) {
    const std::string target = error.location.file.substr(std::string("--set ").size());
    const bool commanded = std::ranges::any_of(command_set_, [&](const auto& one) { return one.first == target; });
    if (commanded) {
      throw Error(Error::Category::usage, "usage", fmt::format("--set {}: {}", target, error.message), {},
                  error.suggestion.empty() ? error.hint : fmt::format("did you mean '{}'?", error.suggestion));
    }
    const auto written = std::ranges::find(section_->set, target, &TargetValue::target);
    if (written == section_->set.end()) {
      diagnostics.add(std::move(error));
    } else if (error.id == "unknown-name") {
      written->value.fail_at_key(error.id, error.message, error.suggestion, error.hint);
    } else {
      written->value.fail(error.id, error.message, error.suggestion, error.hint);
    }
  }
}

// Names stand in a table without quotes.
void StudyFile::name_models() {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < models_.size(); ++i) {
    for (char& c : models_[i].name) {
      if (c == ',' || c == '"' || c == '\n') c = '_';
    }
    if (seen.insert(models_[i].name).second) continue;
    section_->models[i].path.fail("duplicate-name", fmt::format("two models are called '{}'", models_[i].name), {},
                                  "name them: models: {one: " + section_->models[i].path.node().text + ", ...}");
  }
}

// --- axes ----------------------------------------------------------------------------------------------------------

void StudyFile::plan_axes() {
  for (const StudyAxis& axis : section_->axes) plan_axis(axis);
}

/// What the pattern of an axis fits: in the first model, then what the others add.
std::vector<std::string> StudyFile::fitting(const StudyAxis& axis) const {
  std::vector<std::string> targets;
  std::unordered_set<std::string> known;
  const auto take = [&](const std::string& name) {
    if (matches(axis.target, name) && known.insert(name).second) targets.push_back(name);
  };
  for (const StudyModel& model : models_) {
    for (const std::string& address : model.addresses) {
      if (PathOverrides::is_path(address)) take(address);  // a whole section is no target
    }
    std::ranges::for_each(model.parameters, take);
  }
  if (targets.empty()) {
    axis.entry.fail_at_key("unknown-name", fmt::format("nothing in the models fits '{}'", axis.target));
  } else if (targets.size() > most_fitting) {
    axis.entry.fail_at_key("too-large", fmt::format("'{}' fits {} targets; at most {} become axes", axis.target,
                                                    targets.size(), most_fitting));
    targets.clear();
  }
  return targets;
}

void StudyFile::plan_axis(const StudyAxis& axis) {
  const std::vector<std::string> targets = axis.each ? fitting(axis) : std::vector{axis.target};
  std::optional<DesignTable> table;
  if (axis.table) {
    const fs::path folder = fs::path(document_.file_name()).parent_path();
    const auto number = static_cast<std::size_t>(&axis - section_->axes.data());
    const fs::path place = kept_ ? folder / table_copy(number) : folder / axis.table->node().text;
    table = DesignTable::read(place.string(), *axis.table);
    if (!table) return;
  }
  if (axis.fits.size() > 1 && !targets.empty()) axes_.emplace_back(axis, axis.name + ".fit", "", table, draws_);
  for (const std::string& target : targets) {
    axes_.emplace_back(axis, axis.each ? target : axis.name, target, table, draws_);
    draws_ += axis.draws();
  }
}

/// Fills `present`, and reports targets that are nowhere or not everywhere.
void StudyFile::find_targets(PlannedAxis& axis, const LoadOptions& options) const {
  const StudyAxis& source = axis.source();
  axis.present.assign(models_.size(), true);
  for (const std::string& target : axis.targets()) {
    std::size_t models = 0;
    for (std::size_t i = 0; i < models_.size(); ++i) {
      const bool has = models_[i].has(target);
      models += has ? 1 : 0;
      if (!has) axis.present[i] = false;
    }
    if (models == models_.size() || (models > 0 && source.where_present)) continue;
    const auto lacking = static_cast<std::size_t>(
        std::ranges::find_if(models_, [&](const StudyModel& one) { return !one.has(target); }) - models_.begin());
    const ModelProbe probe(*models_[lacking].document, options);
    const ModelProbe::Result tried = probe.build({{target, "1"}}, nullptr);
    std::string message = fmt::format("there is no '{}'", target), hint;
    if (target == "repeat") message = "no joint has play, in which `repeat` moves bodies";
    if (tried.refused) {
      message = tried.errors.front().message;
      hint = tried.errors.front().hint;
    }
    if (models_.size() > 1) message = fmt::format("model '{}': {}", models_[lacking].name, message);
    if (models > 0) hint = "`where_present: true` leaves it out where it is not";
    if (axis.table()) message = fmt::format("column '{}' of '{}': {}", target, source.table->node().text, message);
    axis.written(target).fail_at_key("unknown-name", message, {}, hint);
  }
}

void StudyFile::check_targets(const LoadOptions& options) {
  PlannedAxis* choice = nullptr;  // of the axes after it; where none of them is there is nothing to choose
  for (PlannedAxis& axis : axes_) {
    find_targets(axis, options);
    if (axis.chooses_fit()) {
      choice = &axis;
      axis.present.assign(models_.size(), false);
    } else if (axis.source().fits.size() > 1) {
      for (std::size_t i = 0; i < models_.size(); ++i) {
        if (axis.present[i]) choice->present[i] = true;
      }
    }
  }
  std::unordered_map<std::string, std::string> seen;  // and where they are set
  for (const PlannedSetting& setting : set_) {
    for (const std::string& address : addressed(models_, setting.target)) seen.emplace(address, "`set`");
  }
  for (const PlannedAxis& axis : axes_) {
    std::string said;  // once of a pattern
    for (const std::string& target : axis.targets()) {
      for (const std::string& address : addressed(models_, target)) {
        const auto other = seen.find(address);
        if (other == seen.end()) {
          const Location place = axis.source().entry.key_location();
          seen.emplace(address, fmt::format("'{}' (line {})", axis.name(), place.line));
        } else if (said != target) {
          axis.source().entry.fail_at_key(
              "duplicate-name", fmt::format("'{}' is set by {} and by '{}'", address, other->second, axis.name()));
          said = target;
        }
      }
    }
  }
}

void StudyFile::check_columns() const {
  std::set<std::string> seen;
  for (const PlannedAxis& axis : axes_) {
    for (const AxisColumn& column : axis.columns()) {
      const CheckedValue& entry = axis.source().entry;
      if (std::ranges::find(reserved_columns, column.name) != reserved_columns.end()) {
        entry.fail_at_key("reserved-name", fmt::format("the table has a column '{}' of its own", column.name), {},
                          "give the axis another name, and `target: " + axis.targets().front() + "`");
      } else if (!seen.insert(column.name).second) {
        entry.fail_at_key("duplicate-name", fmt::format("two axes are called '{}'", column.name));
      }
    }
  }
}

// --- what is kept --------------------------------------------------------------------------------------------------

std::string StudyFile::copy_of(std::size_t model) const { return model_copy(model, models_[model].file); }

std::vector<std::string> StudyFile::plugin_copies(std::size_t model) const {
  std::vector<std::string> copies;
  const fs::path folder = fs::path(copy_of(model)).parent_path() / libraries_folder;
  for (const InputFile& plugin : models_[model].plugins) {
    fs::path copy = folder / plugin.name;
    for (int again = 2; std::ranges::find(copies, copy.string()) != copies.end(); ++again) {
      copy = folder / fmt::format("{}-{}.so", fs::path(plugin.name).stem().string(), again);
    }
    copies.push_back(copy.string());
  }
  return copies;
}

bool StudyFile::keep_input(std::size_t model, const InputFile& input) {
  StudyModel& of = models_[model];
  const auto there = std::ranges::find(of.inputs, input.name, &InputFile::name);
  if (there != of.inputs.end()) return there->text == input.text;
  of.inputs.push_back(input);
  of.sha256 = fingerprint(*of.document, of.inputs);
  return true;
}

/// Those that axes speak of; with these the points are known.
std::vector<std::string> StudyFile::named_addresses(const StudyModel& model) const {
  std::vector<std::string> named;
  for (const std::string& address : model.addresses) {
    const bool fits =
        std::ranges::any_of(section_->axes, [&](const StudyAxis& axis) { return matches(axis.target, address); }) ||
        std::ranges::any_of(axes_, [&](const PlannedAxis& axis) {
          return std::ranges::any_of(axis.targets(),
                                     [&](const std::string& target) { return matches(target, address); });
        });
    if (fits) named.push_back(address);
  }
  for (const PlannedAxis& axis : axes_) {
    for (const std::string& target : axis.targets()) {
      const bool path = PathOverrides::is_path(target) && !is_run_override(target) && model.has(target);
      if (path && !is_pattern(target) && std::ranges::find(named, target) == named.end()) named.push_back(target);
    }
  }
  std::ranges::sort(named);
  return named;
}

std::vector<KeptFile> StudyFile::kept_files() const {
  std::vector<KeptFile> files = {{"study.yaml", document_.text()}};
  Json record = {{"name", name_}, {"set", Json::array()}, {"models", Json::array()}};
  for (const auto& [target, text] : command_set_) record["set"].push_back({target, text});
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const StudyModel& model = models_[i];
    record["models"].push_back(
        {{"name", model.name}, {"file", model.file}, {"play", model.has_play}, {"addresses", named_addresses(model)}});
    const std::string copy = model_copy(i, model.file), folder = copy.substr(0, copy.rfind('/') + 1);
    files.push_back({copy, model.document->text()});
    files.push_back({folder + only_copies, ""});
    for (const InputFile& input : model.inputs) files.push_back({folder + "inputs/" + input.name, input.text});
    const std::vector<std::string> plugins = plugin_copies(i);
    for (std::size_t k = 0; k < plugins.size(); ++k) files.push_back({plugins[k], model.plugins[k].text});
  }
  for (const PlannedAxis& axis : axes_) {
    const auto number = static_cast<std::size_t>(&axis.source() - section_->axes.data());
    if (axis.table()) files.push_back({table_copy(number), axis.table()->bytes()});
  }
  files.push_back({record_file, json_text(record)});
  return files;
}

std::string StudyFile::identity() const {
  constexpr std::array<std::string_view, 3> without = {"name", "description", "plots"};
  std::string text = "freeplay-study 1\n" + document_json(section_->section.node(), without) + "\n";
  for (const auto& [target, value] : command_set_) text += "set " + target + "=" + AxisValue::of(value).shown + "\n";
  for (const StudyModel& model : models_) text += "model " + model.name + " " + model.sha256 + "\n";
  for (const PlannedAxis& axis : axes_) {
    if (axis.table()) text += "table " + sha256(axis.table()->bytes()) + "\n";
  }
  return sha256(text);
}

}  // namespace freeplay
