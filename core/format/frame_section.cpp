#include "format/frame_section.h"

#include <cmath>

#include "format/doubtful_number.h"
#include "format/name_rule.h"
#include "format/rotation_keys.h"

namespace freeplay {
namespace {

std::optional<Vector3> read_polar(const CheckedValue& value) {
  const auto items = value.list(2);
  if (!items) return std::nullopt;
  const auto radius = (*items)[0].quantity(dimension::length);
  const auto angle = (*items)[1].quantity(dimension::angle);
  if (!radius || !angle) return std::nullopt;
  doubt_direction((*items)[1], *angle);
  return Vector3{*radius * std::cos(*angle), *radius * std::sin(*angle), 0.0};
}

Draft::Frame read_frame(const CheckedValue& entry, BodyId body) {
  Draft::Frame frame{body, {}, 0.0};
  if (entry.node().is_list()) {
    frame.position = entry.vector(dimension::length).value_or(Vector3{});
    return frame;
  }
  if (!entry.node().is_map()) {
    entry.wrong_type("a position or a map");
    return frame;
  }
  MapReader map(entry, "frame");
  const auto position = map.find("position");
  if (position) frame.position = position->vector(dimension::length).value_or(Vector3{});
  frame.rotation = read_rotation(map).value_or(no_rotation);
  if (entry.in_space()) {
    map.refuse("polar", "only in planar models");
    map.refuse("angle", "only in planar models; use 'rpy' or 'quaternion'");
  } else {
    const auto polar = map.find("polar");
    const auto angle = map.find("angle");
    map.conflict("position", "polar");
    if (polar) frame.position = read_polar(*polar).value_or(Vector3{});
    if (angle) frame.angle = angle->quantity(dimension::angle).value_or(0.0);
    if (angle) doubt_direction(*angle, frame.angle);
  }
  map.finish();
  return frame;
}

void add_frame(Draft& draft, const CheckedValue& entry, BodyId body, const std::string& name) {
  const std::string full = draft.body_name(body) + "/" + name;
  if (draft.frames.contains(full)) {
    entry.fail_at_key("duplicate-name", "frame '" + full + "' exists already");
    return;
  }
  Draft::Frame frame = read_frame(entry, body);
  frame.key = entry.key_node();
  frame.value = &entry.node();
  frame.reading = &entry.reading();
  draft.frames.emplace(full, frame);
}

/// False after a message.
bool check_frame_name(const CheckedValue& entry, const std::string& name) {
  if (name == "origin" || name == "com") {
    entry.fail_at_key("reserved-name", "every body has its own frame '" + name + "'");
    return false;
  }
  const bool foreign = entry.key_node()->foreign;
  if (foreign ? !is_foreign_name(name) : !is_name(name))
    entry.fail_at_key("bad-name", "'" + name + "' is not a valid name of a frame", {}, name_hint(name));
  return true;
}

void add_body_frames(Draft& draft, const CheckedValue& body_entry, const Part& part) {
  if (!body_entry.node().is_map()) return;
  // The keys of the body have been checked by add_bodies().
  MapReader body(body_entry, body_entry.key() == "ground" ? "ground" : "body");
  const auto section = body.find("frames");
  const auto id = draft.find_body(body_entry.key(), part);
  if (!section || !id) return;
  for (const CheckedValue& entry : entries_of(*section)) {
    if (!check_frame_name(entry, entry.key())) continue;
    // A template that adds a frame to an outer body marks it as its own.
    const bool outer = *id == ground;
    const std::string name = outer ? part.full(entry.key()) : entry.key();
    entry.note_key(name);
    add_frame(draft, entry, *id, name);
  }
}

void add_listed_frame(Draft& draft, const CheckedValue& entry, const Part& part) {
  const std::optional<std::string> key = entry.key_reference();
  if (!key) return;
  const std::size_t slash = key->find('/');
  if (slash == std::string::npos) {
    return entry.fail_at_key("bad-name", "'" + *key + "' must be BODY/NAME");
  }
  const std::string body_word = key->substr(0, slash), name = key->substr(slash + 1);
  const std::optional<BodyId> body = draft.find_body(body_word, part);
  if (!body) {
    if (draft.excused(body_word)) return;
    std::vector<std::string> known{"ground"};
    const std::vector<std::string>& bodies = draft.bodies.names();
    if (bodies.size() <= most_candidates) known.insert(known.end(), bodies.begin(), bodies.end());
    return entry.fail_at_key("unknown-name", "unknown body '" + body_word + "'", nearest(body_word, known));
  }
  if (!check_frame_name(entry, name)) return;
  const bool own = !part.prefix.empty() && draft.body_name(*body).starts_with(part.prefix);
  const std::string full = own ? name : part.full(name);
  entry.note_key(draft.body_name(*body) + "/" + full);
  add_frame(draft, entry, *body, full);
}

}  // namespace

void add_frames(Draft& draft, const Part& part) {
  if (const auto bodies = part.section("bodies"); bodies && bodies->node().is_map()) {
    for (const CheckedValue& entry : entries_of(*bodies)) add_body_frames(draft, entry, part);
  }
  if (const auto section = part.section("frames")) {
    for (const CheckedValue& entry : entries_of(*section)) add_listed_frame(draft, entry, part);
  }
}

}  // namespace freeplay
