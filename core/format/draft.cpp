#include "format/draft.h"

#include <algorithm>

#include "base/name_pattern.h"
#include "format/name_rule.h"
#include "model/rotation.h"

namespace freeplay {
namespace {

const std::string ground_name = "ground";
constexpr std::size_t most_comparisons = 1'000'000'000;  // characters

bool is_dotted(const std::string& name) { return name.find('.') != std::string::npos; }

std::optional<int> look_up(const NameTable& table, const std::string& name, const Part& part) {
  if (!is_dotted(name)) {
    const std::optional<int> own = table.find(part.full(name));
    if (own) return own;
  }
  return table.find(name);
}

}  // namespace

std::vector<int> matching(const Draft& draft, const NameTable& table, const CheckedValue& value,
                          const std::string& pattern, const Part& part) {
  std::vector<int> found;
  // After a star a name may be tried once for each of its characters.
  const std::size_t repeated = 1 + std::min<std::size_t>(pattern.size() - pattern.rfind('*'), 16);
  draft.compared += 2 * (table.names().size() + repeated * table.characters());
  if (draft.compared > most_comparisons) {
    throw Error(Error::Category::input, "too-large", "the patterns of the file fit too many names", value.location());
  }
  const auto collect = [&](const std::string& full_pattern) {
    const std::vector<std::string>& names = table.names();
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (matches(full_pattern, names[i])) found.push_back(static_cast<int>(i));
    }
  };
  if (!part.prefix.empty() && !is_dotted(pattern)) collect(part.full(pattern));
  if (found.empty()) collect(pattern);
  draft.compared += 16 * found.size();  // each costs its reader something, too
  return found;
}

void Draft::check_name(const CheckedValue& entry, const std::vector<std::string>& reserved) {
  const std::string name = entry.key();
  const bool foreign = entry.key_node() != nullptr && entry.key_node()->foreign;
  if (foreign ? !is_foreign_name(name) : !is_name(name)) {
    entry.fail_at_key("bad-name", "'" + name + "' is not a valid name", {}, name_hint(name));
  } else if (std::find(reserved.begin(), reserved.end(), name) != reserved.end()) {
    entry.fail_at_key("reserved-name", "the name '" + name + "' is reserved");
  }
}

bool Draft::excused(const std::string& name) const {
  for (const std::string& broken : broken_instances) {
    if (name.find('*') != std::string::npos || name.compare(0, broken.size(), broken) == 0) return true;
  }
  return false;
}

void Draft::unknown(const CheckedValue& value, const char* kind, const std::string& name, const NameTable& table,
                    const Part& part, bool at_key) const {
  if (excused(name)) return;
  std::vector<std::string> candidates;
  const bool few = table.names().size() <= most_candidates;
  for (const std::string& full : few ? table.names() : candidates) {
    if (!part.prefix.empty() && full.starts_with(part.prefix)) candidates.push_back(full.substr(part.prefix.size()));
    candidates.push_back(full);
  }
  if (&table == &bodies) candidates.push_back("ground");
  const std::string message = std::string("unknown ") + kind + " '" + name + "'", meant = nearest(name, candidates);
  at_key ? value.fail_at_key("unknown-name", message, meant) : value.fail("unknown-name", message, meant);
}

const std::string& Draft::body_name(BodyId id) const {
  return id == ground ? ground_name : model.bodies[static_cast<std::size_t>(id)].name;
}

std::optional<BodyId> Draft::find_body(const std::string& name, const Part& part) const {
  if (name == "ground") return ground;
  return look_up(bodies, name, part);
}

std::optional<int> Draft::find_joint(const std::string& name, const Part& part) const {
  return look_up(joints, name, part);
}

void Draft::unknown_joint(const CheckedValue& value, const std::string& name, const Part& part, bool at_key) const {
  const bool is_own = !is_dotted(name) && divided.contains(part.full(name));
  const auto whole = divided.find(is_own ? part.full(name) : name);
  if (whole == divided.end()) return unknown(value, "joint", name, joints, part, at_key);
  const std::string message = "joint '" + name + "' with play is two joints and has no coordinate of its own";
  at_key ? value.fail_at_key("unknown-name", message, {}, whole->second)
         : value.fail("unknown-name", message, {}, whole->second);
}

const std::string* Draft::lone_frame(const std::string& name) const {
  if (lone_frames_.empty()) {
    for (const auto& [full, frame] : frames) {
      const auto [place, fresh] = lone_frames_.try_emplace(full.substr(full.find('/') + 1), full);
      if (!fresh) place->second.clear();
    }
  }
  const auto found = lone_frames_.find(name);
  return found == lone_frames_.end() || found->second.empty() ? nullptr : &found->second;
}

std::optional<BodyId> Draft::body(const CheckedValue& value, const Part& part) const {
  const std::optional<std::string> name = value.reference();
  if (!name) return std::nullopt;
  const std::optional<BodyId> found = find_body(*name, part);
  if (!found) unknown(value, "body", *name, bodies, part);
  if (found) value.note_names({body_name(*found)});
  return found;
}

std::optional<int> Draft::joint(const CheckedValue& value, const Part& part) const {
  const std::optional<std::string> name = value.reference();
  if (!name) return std::nullopt;
  const std::optional<int> found = find_joint(*name, part);
  if (!found) unknown_joint(value, *name, part);
  if (found) value.note_names({joints.names()[static_cast<std::size_t>(*found)]});
  return found;
}

std::optional<std::vector<int>> Draft::joint_list(const CheckedValue& value, const Part& part) const {
  const auto items = value.one_or_list();
  if (!items) return std::nullopt;
  std::vector<int> all;
  bool good = true;
  for (const CheckedValue& item : *items) {
    const std::optional<std::string> name = item.reference();
    if (name && is_pattern(*name)) {
      const std::vector<int> found = matching(*this, joints, item, *name, part);
      all.insert(all.end(), found.begin(), found.end());
      good = good && !found.empty();
      std::vector<std::string> full;
      for (const int joint : found) full.push_back(joints.names()[static_cast<std::size_t>(joint)]);
      item.note_names(std::move(full));
      if (found.empty() && !excused(*name)) {
        item.fail("unknown-name", "no joint matches the pattern '" + *name + "'");
      }
      continue;
    }
    const std::optional<int> found = name ? joint(item, part) : std::nullopt;
    good = good && found.has_value();
    if (found) all.push_back(*found);
  }
  if (!good) return std::nullopt;
  return all;
}

/// BODY/FRAME in full, of a frame that exists.
std::optional<std::string> Draft::frame_name(const CheckedValue& value, const std::string& reference,
                                             const Part& part) const {
  const std::size_t slash = reference.find('/');
  const std::string body_word = reference.substr(0, slash);
  const std::string frame = slash == std::string::npos ? "origin" : reference.substr(slash + 1);
  const std::optional<BodyId> id = find_body(body_word, part);
  if (!id) {
    unknown(value, "body", body_word, bodies, part);
    return std::nullopt;
  }
  const std::string stem = body_name(*id) + "/";
  // A template's own body has the template's frames; to an outer one it may have added some under its own name.
  const std::string added = stem + part.full(frame);
  if (frames.contains(added)) return added;
  if (frames.contains(stem + frame)) return stem + frame;
  if (excused(frame)) return std::nullopt;
  std::vector<std::string> candidates;
  if (frames.size() <= most_candidates) {
    for (const auto& [name, unused] : frames) {
      if (name.starts_with(stem)) candidates.push_back(name.substr(stem.size()));
    }
  }
  std::sort(candidates.begin(), candidates.end());
  // In the words of the file, so that the instances of a template share the message.
  value.fail("unknown-name", "body '" + body_word + "' has no frame '" + frame + "'", nearest(frame, candidates));
  return std::nullopt;
}

std::optional<int> Draft::marker(const CheckedValue& value, const Part& part) {
  const std::optional<std::string> reference = value.reference();
  if (!reference) return std::nullopt;
  const std::optional<std::string> name = frame_name(value, *reference, part);
  if (!name) return std::nullopt;
  value.note_names({*name});
  return marker(*name);
}

int Draft::marker(const std::string& full_name) {
  const auto known = markers.find(full_name);
  if (known != markers.end()) return known->second;
  const Frame& frame = frames.at(full_name);
  const int index = static_cast<int>(model.markers.size());
  model.markers.push_back(marker_of(frame, full_name));
  markers.emplace(full_name, index);
  return index;
}

int Draft::turned_marker(int marker, const Rotation& turn) {
  Marker turned = model.markers[static_cast<std::size_t>(marker)];
  turned.rotation = product(turned.rotation, turn);
  model.markers.push_back(std::move(turned));
  return static_cast<int>(model.markers.size()) - 1;
}

}  // namespace freeplay
