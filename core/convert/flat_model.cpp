#include "convert/flat_model.h"

#include <algorithm>
#include <set>
#include <vector>

#include "base/name_pattern.h"
#include "format/name_rule.h"
#include "model/channel.h"
#include "yaml/text.h"

namespace freeplay {
namespace {

constexpr std::size_t longest_name = 64;

bool is_dotted(const std::string& name) { return name.find('.') != std::string::npos; }

/// Every name of the model, in order.
std::vector<std::string> all_names(const Model& model) {
  std::vector<std::string> names;
  for (const Body& body : model.bodies) names.push_back(body.name);
  for (const JointElement& joint : model.joints) names.push_back(joint.name);
  for (const Driver& driver : model.drivers) names.push_back(driver.name);
  for (const InverseKinematics& entry : model.kinematics) names.push_back(entry.name);
  for (const AppliedForce& force : model.forces) names.push_back(force.name);
  for (const Marker& frame : model.frames) names.push_back(frame.name.substr(frame.name.find('/') + 1));
  return names;
}

Renaming renaming_of(const Model& model, const Readout& readout, const Document& document) {
  std::vector<std::string> names = all_names(model);
  // Forces of gravity leave no element of their name.
  for (const Readout::Instance& instance : readout.instances()) {
    for (const char* section : {"forces", "drivers"}) {
      const Node* entries = instance.content->find(section);
      if (entries == nullptr || !entries->is_map()) continue;
      for (const Node::Entry& entry : entries->entries) names.push_back(instance.name + "." + entry.key->text);
    }
  }
  std::set<std::string> taken;
  for (const std::string& name : names) {
    if (!is_dotted(name)) taken.insert(name);
  }
  if (const Node* forces = document.root().find("forces"); forces != nullptr) {
    for (const Node::Entry& entry : forces->entries) taken.insert(entry.key->text);
  }
  Renaming renamed;
  for (const std::string& name : names) {
    if (!is_dotted(name) || renamed.contains(name)) continue;
    std::string wanted = name;
    std::ranges::replace(wanted, '.', '_');
    std::string chosen = wanted.substr(0, longest_name);
    for (int i = 2; taken.contains(chosen); ++i) {
      const std::string number = "_" + std::to_string(i);
      chosen = wanted.substr(0, longest_name - number.size()) + number;
    }
    taken.insert(chosen);
    renamed.emplace(name, chosen);
  }
  return renamed;
}

class Flattening {
 public:
  Flattening(const Document& document, const Model& model, const Readout& readout)
      : source_(document),
        channels_(model),
        readout_(readout),
        renamed_(renaming_of(model, readout, document)),
        target_(document.file_name(), "") {
    for (const JointElement& joint : model.joints) joints_.push_back(joint.name);
  }

  FlatModel run() {
    Node& root = map();
    for (const Node::Entry& entry : source_.root().entries) {
      const std::string& key = entry.key->text;
      if (key == "templates" || key == "instances" || is_part(key) || is_note(key)) continue;
      if (!entry.value->is_null()) put(root, key, copy(*entry.value, ""));
    }
    for (const char* section : parts) {
      Node& entries = map();
      if (const Node* own = source_.root().find(section)) add_entries(entries, *own, "", section);
      for (const Readout::Instance& instance : readout_.instances()) {
        if (const Node* content = instance.content->find(section))
          add_entries(entries, *content, instance.name, section);
      }
      if (std::string_view(section) == "frames")
        entries.entries.insert(entries.entries.end(), ground_.begin(), ground_.end());
      if (!entries.entries.empty()) put(root, section, entries);
    }
    return {yaml_text(root), std::move(renamed_)};
  }

 private:
  static constexpr const char* parts[] = {"bodies", "frames", "joints", "drivers", "forces"};
  static bool is_part(const std::string& key) {
    return std::ranges::any_of(parts, [&](const char* part) { return key == part; });
  }

  Node& map() { return target_.add(Node::Kind::map, 1, 1); }
  Node& scalar(const std::string& text) {
    Node& node = target_.add(Node::Kind::scalar, 1, 1);
    node.text = text;
    return node;
  }
  void put(Node& owner, const std::string& key, const Node& value) { owner.entries.push_back({&scalar(key), &value}); }

  void add_entries(Node& target, const Node& section, const std::string& instance, std::string_view kind) {
    if (!section.is_map()) return;
    for (const Node::Entry& entry : section.entries) {
      const std::string& key = entry.key->text;
      if (is_note(key)) continue;
      if (kind == "frames") {
        const std::vector<std::string>* full = readout_.find(instance, *entry.key);
        put(target, rename(full == nullptr ? key : full->front()), copy(*entry.value, instance));
      } else if (!instance.empty() && key == "ground") {
        add_ground_frames(*entry.value, instance);
      } else {
        put(target, rename(instance.empty() ? key : instance + "." + key), copy(*entry.value, instance));
      }
    }
  }

  /// Of `ground` there is one entry only, so what instances add goes to the section `frames`.
  void add_ground_frames(const Node& ground, const std::string& instance) {
    const Node* frames = ground.is_map() ? ground.find("frames") : nullptr;
    if (frames == nullptr || !frames->is_map()) return;
    for (const Node::Entry& entry : frames->entries) {
      const std::vector<std::string>* full = readout_.find(instance, *entry.key);
      if (full == nullptr) continue;
      ground_.push_back({&scalar("ground/" + rename(full->front())), &copy(*entry.value, instance)});
    }
  }

  /// NAME, or one or both sides of BODY/FRAME, or a channel.
  std::string rename(const std::string& text) const {
    if (const std::size_t slash = text.find('/'); slash != std::string::npos) {
      return rename(text.substr(0, slash)) + "/" + rename(text.substr(slash + 1));
    }
    const auto found = renamed_.find(text);
    return found == renamed_.end() ? text : found->second;
  }

  /// SECTION.NAME.KEY as targets of a study have it; what instances declare has the longest name.
  std::string rename_path(const std::string& path) const {
    const std::size_t first = path.find('.');
    if (first == std::string::npos || !is_part(path.substr(0, first))) return rename(path);
    for (std::size_t end = path.rfind('.'); end > first; end = path.rfind('.', end - 1)) {
      const std::string name = path.substr(first + 1, end - first - 1);
      if (renamed_.contains(name)) return path.substr(0, first + 1) + rename(name) + path.substr(end);
    }
    return path;
  }

  std::string rename_channel(const std::string& channel) const {
    const std::size_t first = channel.find('.'), last = channel.rfind('.');
    if (first == std::string::npos || last <= first) return channel;
    return channel.substr(0, first + 1) + rename(channel.substr(first + 1, last - first - 1)) + channel.substr(last);
  }

  const Node& copy(const Node& node, const std::string& instance) {
    if (node.is_scalar()) return copy_scalar(node, instance);
    if (node.is_map()) return copy_map(node, instance);
    Node& made = target_.add(node.kind, 1, 1);
    for (const Node* item : node.items) {
      const std::vector<std::string>* texts = readout_.find(instance, *item);
      if (texts == nullptr) {
        made.items.push_back(&copy(*item, instance));
        continue;
      }
      for (const std::string& text : *texts) made.items.push_back(&scalar(rename(text)));
    }
    return made;
  }

  const Node& copy_scalar(const Node& node, const std::string& instance) {
    const std::vector<std::string>* texts = readout_.find(instance, node);
    if (texts == nullptr) return scalar(node.text);
    if (texts->size() == 1) return scalar(rename(texts->front()));
    Node& list = target_.add(Node::Kind::list, 1, 1);
    for (const std::string& text : *texts) list.items.push_back(&scalar(rename(text)));
    return list;
  }

  const Node& copy_map(const Node& node, const std::string& instance) {
    Node& made = map();
    std::set<std::string> open;
    if (instance.empty()) {
      for (const Node::Entry& entry : node.entries) add_entry(made, entry, instance);
    } else {
      add_layers(made, node, instance, open);
    }
    return made;
  }

  void add_entry(Node& made, const Node::Entry& entry, const std::string& instance) {
    const std::string& key = entry.key->text;
    if (is_note(key)) return;
    if (key == "channel" && entry.value->is_scalar()) return put(made, key, scalar(rename_channel(entry.value->text)));
    if (key == "channels" && instance.empty()) return put(made, key, channel_list(*entry.value));
    if (key == "ideal" && instance.empty()) return put(made, key, joint_list(*entry.value));
    const bool path = (key == "target" || key == "summary") && instance.empty() && entry.value->is_scalar();
    if (path) return put(made, key, scalar(rename_path(entry.value->text)));
    put(made, instance.empty() ? rename_path(key) : rename(key), copy(*entry.value, instance));
  }

  /// `ideal` of a study: names and patterns of joints, or `all`.
  const Node& joint_list(const Node& written) {
    Node& list = target_.add(Node::Kind::list, 1, 1);
    for (const Node* item : written.is_list() ? written.items : std::vector<const Node*>{&written}) {
      if (item->text == "all") return scalar("all");
      for (const std::string& joint : joints_) {
        if (matches(item->text, joint)) list.items.push_back(&scalar(rename(joint)));
      }
    }
    return list;
  }

  /// The keys of an entry, then those of its presets that are not there yet; a later preset is stronger.
  void add_layers(Node& made, const Node& node, const std::string& instance, std::set<std::string>& open) {
    for (const Node::Entry& entry : node.entries) {
      if (entry.key->text != "use" && made.find(entry.key->text) == nullptr) add_entry(made, entry, instance);
    }
    const Node* use = node.find("use");
    const Node* presets = source_.root().find("presets");
    if (use == nullptr || presets == nullptr) return;
    std::vector<const Node*> names = use->is_list() ? use->items : std::vector<const Node*>{use};
    std::ranges::reverse(names);
    for (const Node* name : names) {
      const Node* preset = presets->find(name->text);
      if (preset == nullptr || !preset->is_map() || !open.insert(name->text).second) continue;
      add_layers(made, *preset, instance, open);
    }
  }

  /// A pattern that no pattern can follow under the new names becomes the list of what it fits.
  const Node& channel_list(const Node& written) {
    Node& list = target_.add(Node::Kind::list, 1, 1);
    const std::vector<const Node*> patterns = written.is_list() ? written.items : std::vector<const Node*>{&written};
    for (const Node* pattern : patterns) {
      const std::string renamed = renamed_pattern(pattern->text);
      if (!renamed.empty()) {
        list.items.push_back(&scalar(renamed));
        continue;
      }
      for (const ChannelInfo& channel : channels_.all()) {
        if (matches(pattern->text, channel.name)) list.items.push_back(&scalar(rename_channel(channel.name)));
      }
    }
    return list;
  }

  /// The pattern itself, or with '_' for some of its dots, that fits the new names of just the columns that the pattern
  /// fits; "" when there is none.
  std::string renamed_pattern(const std::string& pattern) const {
    constexpr std::size_t most_dots = 5;
    std::vector<std::size_t> dots;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
      if (pattern[i] == '.') dots.push_back(i);
    }
    const std::size_t ways = dots.size() > most_dots ? 1 : std::size_t{1} << dots.size();
    for (std::size_t way = 0; way < ways; ++way) {
      std::string candidate = pattern;
      for (std::size_t i = 0; i < dots.size(); ++i) {
        if ((way >> i) % 2 == 1) candidate[dots[i]] = '_';
      }
      const bool same = std::ranges::all_of(channels_.all(), [&](const ChannelInfo& channel) {
        return matches(pattern, channel.name) == matches(candidate, rename_channel(channel.name));
      });
      if (same) return candidate;
    }
    return {};
  }

  const Document& source_;
  std::vector<std::string> joints_;
  const Channels channels_;
  const Readout& readout_;
  Renaming renamed_;
  Document target_;
  std::vector<Node::Entry> ground_;  ///< frames that instances add to ground under `bodies`
};

}  // namespace

FlatModel flat_model(const Document& document, const Model& model, const Readout& readout) {
  return Flattening(document, model, readout).run();
}

bool has_instances(const Document& document) {
  const Node* instances = document.root().is_map() ? document.root().find("instances") : nullptr;
  return instances != nullptr && instances->is_map() && !instances->entries.empty();
}

}  // namespace freeplay
