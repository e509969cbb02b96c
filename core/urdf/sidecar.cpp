#include "urdf/sidecar.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "base/input_text.h"
#include "base/kept_input.h"
#include "format/map_reader.h"
#include "format/name_rule.h"
#include "format/parameter_scope.h"

namespace freeplay {
namespace {

using Words = std::vector<std::string>;

/// Reads the section `urdf`.
class UrdfSection {
 public:
  UrdfSection(const CheckedValue& section, const Node& model, const std::string& model_file)
      : map_(section.node().is_scalar() ? MapReader::empty(section) : MapReader(section, "urdf")) {
    const auto file = section.node().is_scalar() ? std::optional<CheckedValue>(section) : map_.require("file");
    readable_ = file && read_file(*file, model_file);
    // A key that is wrong has the value with which the robot shows no mistakes that are not there.
    using Plane = urdf::Options::Plane;
    constexpr std::optional<Plane> planes[] = {Plane::xy, Plane::xz, Plane::yz, std::nullopt};
    options.space = space_of(model);
    if (options.space == urdf::Options::Space::spatial) {
      map_.refuse("plane", "only in planar models");
    } else {
      options.plane = planes[word("plane", {"xy", "xz", "yz"}, 3)];
    }
    options.floating_base = word("base", {"fixed", "floating"}, 0) == 1;
    options.two_parents = word("loops", {"elements", "two-parents"}, 1) == 1;
    options.repair_inertia = map_.find("repair").has_value();
    word("repair", {"inertia"}, 0);
    options.stops = word("limits", {"ignore", "stop"}, 0) == 1;
    if (const auto merge = map_.find("merge_fixed")) {
      options.merge_fixed = merge->boolean().value_or(false);
    }
    map_.finish();
  }

  bool readable() const { return readable_; }

  urdf::Options options;
  std::string path, text;

 private:
  /// What the model says, or what else it says only of one space; else the robot decides.
  urdf::Options::Space space_of(const Node& model) const {
    using Space = urdf::Options::Space;
    if (const Node* space = model.find("space")) {
      return space->text == "planar" ? Space::planar : space->text == "spatial" ? Space::spatial : Space::by_robot;
    }
    const Node* gravity = model.find("gravity");
    if (map_.has("plane") || (gravity != nullptr && gravity->items.size() == 2)) return Space::planar;
    return Space::by_robot;
  }

  bool read_file(const CheckedValue& file, const std::string& model_file) {
    const auto name = file.string();
    if (!name) return false;
    const std::filesystem::path written = std::filesystem::path(model_file).parent_path() / *name;
    path = kept_input(model_file, written.string(), written.filename().string());
    const std::string why = read_input(path, text);
    if (!why.empty()) file.fail("file-not-found", fmt::format("cannot read '{}': {}", path, why));
    if (text.size() > largest_input) file.fail("too-large", fmt::format("'{}' is larger than 16 MiB", path));
    return why.empty() && text.size() <= largest_input;
  }

  /// Index of the word; 0 where the key is not written, `wrong` after a message.
  int word(const char* key, const Words& words, int wrong) {
    const auto value = map_.find(key);
    return value ? value->word(words).value_or(wrong) : 0;
  }

  MapReader map_;
  bool readable_ = false;
};

class Merger {
 public:
  Merger(Document& document, Diagnostics& diagnostics) : document_(document), diagnostics_(diagnostics) {}

  void merge(const urdf::Sections& sections) {
    Node& root = document_.add(Node::Kind::map, document_.root().line, document_.root().column);
    for (const Node::Entry& entry : document_.root().entries) {
      if (entry.key->text != "urdf") root.entries.push_back(entry);
    }
    if (!sections.plane && root.find("space") == nullptr) {
      root.entries.push_back({&word("space"), &word("spatial")});
    }
    if (sections.gravity != nullptr && root.find("gravity") == nullptr) {
      root.entries.push_back({&word("gravity"), sections.gravity});
    }
    merge_section(root, "bodies", *sections.bodies, {"frames", "pose", "velocity"});
    merge_section(root, "joints", *sections.joints, {"clearance"});
    merge_section(root, "forces", *sections.forces, {});
    document_.set_root(root);
  }

 private:
  Node& word(const char* text) {
    Node& made = document_.add(Node::Kind::scalar, 1, 1);
    made.text = text;
    return made;
  }

  /// `allowed`: keys that the model may add to an entry of the robot.
  void merge_section(Node& root, const char* name, const Node& robot, const Words& allowed) {
    const auto own = std::ranges::find_if(root.entries, [&](const auto& entry) { return entry.key->text == name; });
    if (own == root.entries.end()) {
      root.entries.push_back({&word(name), &robot});
      return;
    }
    if (own->value->is_null()) {
      own->value = &robot;
      return;
    }
    if (!own->value->is_map()) return;  // the builder reports it
    Node& both = document_.add(Node::Kind::map, own->value->line, own->value->column);
    both.entries = robot.entries;
    std::unordered_map<std::string, std::size_t> index;
    for (std::size_t i = 0; i < both.entries.size(); ++i) index.emplace(both.entries[i].key->text, i);
    for (const Node::Entry& entry : own->value->entries) {
      const auto known = index.find(entry.key->text);
      if (known == index.end()) {
        both.entries.push_back(entry);
      } else {
        both.entries[known->second].value = extend(*both.entries[known->second].value, entry, name, allowed);
      }
    }
    own->value = &both;
  }

  /// The entry of the robot with what the model adds.
  const Node* extend(const Node& robot, const Node::Entry& added, const std::string& section, const Words& allowed) {
    const std::string path = section + "." + added.key->text;
    if (allowed.empty() || !added.value->is_map()) {
      report(*added.key, "duplicate-name", fmt::format("'{}' comes from the robot file already", path), {});
      return &robot;
    }
    Node& both = document_.add(Node::Kind::map, robot.line, robot.column);
    both.file = robot.file;
    both.length = robot.length;
    both.entries = robot.entries;
    for (const Node::Entry& entry : added.value->entries) {
      const bool note = is_note(entry.key->text);
      if (!note && std::ranges::find(allowed, entry.key->text) == allowed.end() && added.key->text != "ground") {
        report(*entry.key, "unknown-key",
               fmt::format("'{}' comes from the robot file; the key '{}' cannot be added", path, entry.key->text),
               fmt::format("only {}", either(allowed)));
        continue;
      }
      append(both, entry);
    }
    return &both;
  }

  /// Frames join those that are there; every other key is new or wins over the robot's (a starting pose).
  void append(Node& both, const Node::Entry& entry) {
    const auto known =
        std::ranges::find_if(both.entries, [&](const auto& e) { return e.key->text == entry.key->text; });
    if (known == both.entries.end()) {
      both.entries.push_back(entry);
    } else if (entry.key->text == "frames" && entry.value->is_map()) {
      Node& frames = document_.add(Node::Kind::map, entry.value->line, entry.value->column);
      frames.entries = known->value->entries;
      frames.entries.insert(frames.entries.end(), entry.value->entries.begin(), entry.value->entries.end());
      known->value = &frames;
    } else {
      *known = entry;
    }
  }

  void report(const Node& at, const char* id, std::string message, std::string hint) {
    diagnostics_.error(at.location(), at.length, id, std::move(message), {}, std::move(hint));
  }

  Document& document_;
  Diagnostics& diagnostics_;
};

}  // namespace

bool add_robot(Document& document, RobotReader read, Diagnostics& diagnostics) {
  UsedKeys used;
  const ParameterScope scope(used);
  const Reading reading{&diagnostics, &scope};
  const Node& root = document.root();
  const auto entry = std::ranges::find_if(root.entries, [](const auto& e) { return e.key->text == "urdf"; });
  const CheckedValue value(reading, *entry->value, entry->key, "urdf");
  UrdfSection section(value, root, document.file_name());
  if (!section.readable()) return false;
  diagnostics.add_source(section.path, section.text);
  const std::string* file = document.add_file(section.path, section.text);
  const auto sections = read(section.text, file, section.options, document, diagnostics);
  if (!sections) return false;
  Merger(document, diagnostics).merge(*sections);
  return true;
}

}  // namespace freeplay
