#include "sdf/frames.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/index.h"

namespace freeplay::sdf {

using Kind = Frame::Kind;

int Frames::add(Frame frame, bool strict) {
  const int index = size();
  const auto [known, fresh] = names_.try_emplace({frame.scope, frame.name}, index);
  if (!fresh && !frame.name.empty()) {
    const Frame& other = frames_[at(known->second)];
    if (strict || other.kind == frame.kind) {
      messages_.error(frame.spot, "bad-urdf",
                      fmt::format("the name '{}' exists already: first on line {}", frame.name, other.spot.line));
    } else if (frame.kind == Kind::link) {
      known->second = index;  // ends of joints are links
    }
  }
  if (frame.kind == Kind::link) first_links_.emplace(frame.scope, index);
  if (frame.kind == Kind::model) first_models_.emplace(frame.scope, index);
  frames_.push_back(std::move(frame));
  return index;
}

int Frames::look_up(int scope, const std::string& name) const {
  if (name == "__model__" && frames_[at(scope)].kind == Kind::model) return scope;
  if (name == "world" && scope == world) return world;
  if (const auto whole = names_.find({scope, name}); whole != names_.end()) return whole->second;
  const std::size_t colons = name.find("::");
  if (colons == std::string::npos) return none;
  const auto first = names_.find({scope, name.substr(0, colons)});
  if (first == names_.end() || frames_[at(first->second)].kind != Kind::model) return none;
  return look_up(first->second, name.substr(colons + 2));
}

int Frames::find(int scope, const Frame::Name& name) const {
  const int found = look_up(scope, name.text);
  if (found != none) return found;
  std::vector<std::string> words;
  for (auto known = names_.lower_bound({scope, {}}); known != names_.end() && known->first.first == scope; ++known) {
    words.push_back(known->first.second);
  }
  messages_.error(name.spot, "bad-urdf", fmt::format("unknown frame '{}'", name.text),
                  messages_.suggest(name.text, words));
  return none;
}

std::string Frames::path(int frame, int top) const {
  std::string out = frames_[at(frame)].name;
  for (int scope = frames_[at(frame)].scope; scope > world && scope != top; scope = frames_[at(scope)].scope) {
    out = frames_[at(scope)].name + "-" + out;
  }
  return out;
}

// --- where they stand ------------------------------------------------------------------------------------------------

/// What the pose of a frame is relative to.
int Frames::base_of(int frame) const {
  const Frame& here = frames_[at(frame)];
  if (here.kind == Kind::world) return world;
  if (!here.relative_to.text.empty()) {
    const int found = find(here.scope, here.relative_to);
    return found == none ? here.scope : found;
  }
  const bool carried = here.kind == Kind::joint || here.kind == Kind::plain;
  // An unknown name is reported where the frame that carries it is looked for.
  const int carrier = carried && !here.attached_to.text.empty() ? look_up(here.scope, here.attached_to.text) : none;
  return carrier == none ? here.scope : carrier;
}

/// The frames on the way from `scope` down to `frame`, `scope` left out.
void Frames::add_path(int frame, int scope, std::vector<int>& path) const {
  for (int next = frame; next != scope && next > world; next = frames_[at(next)].scope) path.push_back(next);
}

/// The frames whose places in their scopes the place of this one follows from.
std::vector<int> Frames::needs(int frame) const {
  std::vector<int> out;
  add_path(bases_[at(frame)], frames_[at(frame)].scope, out);
  if (placements_[at(frame)] != none) add_path(placements_[at(frame)], frame, out);
  return out;
}

Eigen::Isometry3d Frames::pose_in(int frame, int scope) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int next = frame; next != scope && next > world; next = frames_[at(next)].scope) pose = local_[at(next)] * pose;
  return pose;
}

void Frames::place(int frame) {
  const Frame& here = frames_[at(frame)];
  const int base = bases_[at(frame)];
  local_[at(frame)] = base == here.scope ? here.pose : pose_in(base, here.scope) * here.pose;
  const int placed = placements_[at(frame)];
  if (placed != none) local_[at(frame)] = local_[at(frame)] * urdf::inverse_pose(pose_in(placed, frame));
}

/// Places what a frame needs before the frame itself.
void Frames::place_all(int first) {
  constexpr int open = 1, done = 2;
  std::vector<int> stack{first};
  while (!stack.empty()) {
    const int here = stack.back();
    int next = none;
    if (marks_[at(here)] != done) {
      marks_[at(here)] = open;
      for (const int need : needs(here)) {
        if (marks_[at(need)] == open) {
          const Frame& frame = frames_[at(here)];
          const bool named = !frame.relative_to.text.empty();
          messages_.error(
              named ? frame.relative_to.spot : frame.spot, "bad-urdf",
              fmt::format("the place of '{}' depends on itself, by that of '{}'", frame.name, frames_[at(need)].name));
          bases_[at(here)] = frame.scope;
          placements_[at(here)] = none;
          break;
        }
        if (marks_[at(need)] != done) next = need;
      }
    }
    if (next != none) {
      stack.push_back(next);
      continue;
    }
    if (marks_[at(here)] != done) place(here);
    marks_[at(here)] = done;
    stack.pop_back();
  }
}

Eigen::Isometry3d Frames::pose(int frame) const { return pose_in(frame, world); }

// --- what carries them -----------------------------------------------------------------------------------------------

/// What a frame is attached to; itself for a link, and for what nothing carries.
int Frames::support_of(int frame) {
  const Frame& here = frames_[at(frame)];
  if (here.kind == Kind::world || here.kind == Kind::link) return frame;
  if (here.kind == Kind::model && here.is_static) return world;
  if (here.kind == Kind::joint && here.attached_to.text == "world") return world;  // reported by its reader
  if (!here.attached_to.text.empty()) {
    const int found = find(here.kind == Kind::model ? frame : here.scope, here.attached_to);
    return found == none ? world : found;
  }
  if (here.kind != Kind::model) return here.scope;
  const auto link = first_links_.find(frame), model = first_models_.find(frame);
  if (link != first_links_.end()) return link->second;
  return model == first_models_.end() ? world : model->second;
}

void Frames::find_carriers() {
  std::vector<int> next;
  for (int i = 0; i < size(); ++i) next.push_back(support_of(i));
  carriers_.assign(frames_.size(), none);
  for (int i = 0; i < size(); ++i) {
    std::vector<int> way;
    int here = i;
    while (carriers_[at(here)] == none && next[at(here)] != here) {
      carriers_[at(here)] = here;  // met again only in a cycle
      way.push_back(here);
      here = next[at(here)];
    }
    int end = carriers_[at(here)] == none ? here : carriers_[at(here)];
    if (std::ranges::find(way, here) != way.end()) {
      messages_.error(frames_[at(here)].spot, "bad-urdf",
                      fmt::format("the frame '{}' is attached to itself", frames_[at(here)].name));
      end = world;
    }
    carriers_[at(here)] = end;
    for (const int passed : way) carriers_[at(passed)] = end;
  }
}

int Frames::carrier(int frame) const { return carriers_[at(frame)]; }

void Frames::resolve() {
  for (int i = 0; i < size(); ++i) {
    bases_.push_back(base_of(i));
    const Frame::Name& placed = frames_[at(i)].placement;
    placements_.push_back(placed.text.empty() ? none : find(i, placed));
  }
  local_.assign(frames_.size(), Eigen::Isometry3d::Identity());
  marks_.assign(frames_.size(), 0);
  for (int i = 1; i < size(); ++i) place_all(i);
  find_carriers();
}

}  // namespace freeplay::sdf
