#include "drawing/model_text.h"

#include <vector>

#include <fmt/format.h>

#include "base/number_text.h"
#include "base/text.h"

namespace freeplay {
namespace {

std::string words(const Json& value);

std::string list_text(const Json& list, const char* open, const char* close) {
  std::string out = open;
  for (const Json& item : list) out += (out.size() > 1 ? ", " : "") + words(item);
  return out + close;
}

std::string map_text(const Json& map) {
  std::string out;
  for (const auto& [key, value] : map.items()) {
    if (value.is_object() && value.empty()) continue;
    out += fmt::format("{}{} {}", out.empty() ? "" : "  ", key, words(value));
  }
  return out;
}

std::string words(const Json& value) {
  if (value.is_number()) return number_text(value.get<double>());
  if (value.is_array()) return list_text(value, "(", ")");
  if (value.is_object()) return "{" + map_text(value) + "}";
  if (value.is_string()) return printable(value.get<std::string>());
  return value.dump();
}

std::string frame_text(const Json& frame) {
  if (frame.is_string()) return words(frame);
  const char* turn = frame.contains("angle") ? "angle" : "quaternion";
  return fmt::format("{}  {} {}", words(frame["position"]), turn, words(frame[turn]));
}

std::size_t widest(const Json& map) {
  std::size_t width = 0;
  for (const auto& [name, unused] : map.items()) width = std::max(width, name.size());
  return width;
}

std::string frames_text(const Json& frames, int indent) {
  std::string out;
  const std::size_t width = widest(frames);
  for (const auto& [name, frame] : frames.items()) {
    out += fmt::format("{:{}}frame {:<{}}  {}\n", "", indent, name, width, frame_text(frame));
  }
  return out;
}

std::string body_text(const std::string& name, const Json& body) {
  std::string out = fmt::format("  {}: mass {}  inertia {}  com {}\n", name, words(body["mass"]),
                                words(body["inertia"]), words(body["com"]));
  for (const char* guess : {"pose", "velocity"}) {
    if (body.contains(guess)) out += fmt::format("    {}  {}\n", guess, map_text(body[guess]));
  }
  return out + frames_text(body["frames"], 4);
}

/// A joint, driver or force: its type or kind, what it ties, and the rest.
std::string entry_text(const std::string& name, const Json& entry, std::size_t width) {
  Json rest = entry;
  std::string head;
  for (const char* key : {"type", "kind"}) {
    if (!head.empty() || !rest.contains(key)) continue;
    head = words(rest[key]);
    rest.erase(key);
  }
  for (const char* key : {"between", "of"}) {
    if (!rest.contains(key)) continue;
    head += fmt::format("  {} - {}", words(rest[key][0]), words(rest[key][1]));
    rest.erase(key);
  }
  const std::string tail = map_text(rest);
  return fmt::format("  {:<{}}  {}{}{}\n", name, width, head, tail.empty() ? "" : "  ", tail);
}

std::string section_text(const char* heading, const Json& section) {
  if (section.empty()) return {};
  std::string out = fmt::format("{}\n", heading);
  const std::size_t width = widest(section);
  for (const auto& [name, entry] : section.items()) out += entry_text(name, entry, width);
  return out;
}

std::string start_text(const Json& initial) {
  std::string out = "initial\n";
  for (const char* key : {"joints", "speeds"}) {
    for (const auto& [joint, value] : initial[key].items()) {
      out += fmt::format("  {} {} of {}\n", key, words(value), joint);
    }
  }
  return out + "  assembly  " + map_text(initial["assembly"]) + "\n";
}

std::string simulation_text(const Json& simulation) {
  const Json& step = simulation.contains("step") ? simulation["step"] : Json();
  std::string steps = step.is_null() ? fmt::format("in steps for an accuracy of {}", words(simulation["accuracy"]))
                                     : fmt::format("in steps of {}", words(step));
  if (step.is_object()) {
    Json rest = step;
    for (const char* shown : {"size", "adaptive"}) rest.erase(shown);
    steps = fmt::format("in adaptive steps, the first of {}  {}", words(step["size"]), map_text(rest));
  }
  std::string out =
      fmt::format("simulation\n  {} to {} {}\n", words(simulation["start"]), words(simulation["end"]), steps);
  if (!simulation["integrator"].is_null()) out += "  integrator  " + map_text(simulation["integrator"]) + "\n";
  out += "  output  " + map_text(simulation["output"]) + "\n";
  for (const Json& condition : simulation["stop"]) out += "  stop  " + map_text(condition) + "\n";
  return out;
}

/// For Graphviz; `second` stands on a line of its own.
std::string quoted(const std::string& text, const std::string& second = {}) {
  std::string out = "\"";
  for (const char c : printable(text)) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  if (!second.empty()) out += "\\n" + second;
  return out + "\"";
}

std::string body_of(const Json& marker) {
  const std::string name = marker.get<std::string>();
  return name.substr(0, name.find('/'));
}

std::string edge(const std::string& from, const std::string& to, const std::string& name, const Json& entry,
                 const char* style) {
  return fmt::format("  {} -- {} [label={}{}];\n", quoted(from), quoted(to),
                     quoted(name, entry["type"].get<std::string>()), style);
}

/// The body that a joint moves: the second one.
std::string moved_body(const Json& model, const Json& joint) {
  const Json& entry = model["joints"][joint.get<std::string>()];
  return entry.contains("between") ? body_of(entry["between"][1]) : moved_body(model, entry["of"][1]);
}

}  // namespace

std::string model_tree(const Json& model) {
  std::string out =
      fmt::format("{}: {}, gravity {}\n", words(model["name"]), words(model["space"]), words(model["gravity"]));
  out += "ground\n" + frames_text(model["ground"]["frames"], 2);
  out += "bodies\n";
  for (const auto& [name, body] : model["bodies"].items()) out += body_text(name, body);
  for (const char* section : {"joints", "drivers", "paths", "forces"}) out += section_text(section, model[section]);
  return out + start_text(model["initial"]) + simulation_text(model["simulation"]);
}

std::string model_graph(const Json& model) {
  std::string out = fmt::format("graph {} {{\n  node [shape=box, style=rounded];\n  \"ground\" [style=filled];\n",
                                quoted(model["name"].get<std::string>()));
  for (const auto& [name, unused] : model["bodies"].items()) out += fmt::format("  {};\n", quoted(name));
  for (const auto& [name, joint] : model["joints"].items()) {
    if (joint.contains("between")) {
      out += edge(body_of(joint["between"][0]), body_of(joint["between"][1]), name, joint, "");
    } else {
      out += edge(moved_body(model, joint["of"][0]), moved_body(model, joint["of"][1]), name, joint, ", style=dashed");
    }
  }
  for (const auto& [name, force] : model["forces"].items()) {
    if (!force.contains("between")) continue;
    out += edge(body_of(force["between"][0]), body_of(force["between"][1]), name, force, ", style=dotted");
  }
  return out + "}\n";
}

}  // namespace freeplay
