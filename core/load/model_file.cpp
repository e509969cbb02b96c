#include "load/model_file.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/input_text.h"
#include "base/kept_input.h"
#include "load/robot_file.h"
#include "urdf/sidecar.h"
#include "yaml/document.h"

namespace freeplay {
namespace {

/// Root of the model that a robot file alone stands for.
void set_root_of_robot(Document& document, const urdf::Sections& sections) {
  Node& root = document.add(Node::Kind::map, 1, 1);
  const auto scalar = [&](const char* text) -> Node& {
    Node& node = document.add(Node::Kind::scalar, 1, 1);
    node.text = text;
    return node;
  };
  const auto put = [&](const char* key, const Node& value) { root.entries.push_back({&scalar(key), &value}); };
  put("freeplay", scalar("1"));
  if (!sections.plane) put("space", scalar("spatial"));
  // Down is -z in URDF; in the plane xy nothing of it is left.
  if (sections.gravity != nullptr) {
    put("gravity", *sections.gravity);
  } else if (sections.plane != urdf::Options::Plane::xy) {
    Node& gravity = document.add(Node::Kind::list, 1, 1);
    gravity.items = {&scalar("0"), &scalar("-9.81")};
    if (!sections.plane) gravity.items.insert(gravity.items.begin(), &scalar("0"));
    put("gravity", gravity);
  }
  put("bodies", *sections.bodies);
  put("joints", *sections.joints);
  put("forces", *sections.forces);
  document.set_root(root);
}

/// The rest of a model whose robot cannot be read, so that its own mistakes are found in the same pass.
void leave_robot_out(Document& document) {
  Node& root = document.add(Node::Kind::map, document.root().line, document.root().column);
  for (const Node::Entry& entry : document.root().entries) {
    if (entry.key->text != "urdf") root.entries.push_back(entry);
  }
  // The length of vectors alone shows what space the robot would have had.
  const Node* gravity = root.find("gravity");
  if (root.find("space") == nullptr && gravity != nullptr && gravity->items.size() == 3) {
    Node& key = document.add(Node::Kind::scalar, 1, 1);
    Node& value = document.add(Node::Kind::scalar, 1, 1);
    key.text = "space";
    value.text = "spatial";
    root.entries.push_back({&key, &value});
  }
  document.set_root(root);
  document.set_incomplete();
}

std::optional<Document> parse_robot(std::string text, const std::string& file_name, Diagnostics& diagnostics) {
  if (text.size() > largest_input) {
    diagnostics.error({file_name, 1, 1}, 1, "too-large", "the file is larger than 16 MiB");
    return std::nullopt;
  }
  diagnostics.add_source(file_name, text);
  Document document(file_name, std::move(text));
  urdf::Options options;
  options.space = urdf::Options::Space::by_robot;
  options.plane.reset();
  const auto sections = add_robot_sections(document.text(), &document.file_name(), options, document, diagnostics);
  if (!sections) return std::nullopt;
  set_root_of_robot(document, *sections);
  return document;
}

}  // namespace

bool is_urdf(const std::string& file_name) { return std::filesystem::path(file_name).extension() == ".urdf"; }

bool is_robot(const std::string& file_name) {
  const std::filesystem::path ending = std::filesystem::path(file_name).extension();
  return is_urdf(file_name) || ending == ".xml" || ending == ".sdf";
}

std::optional<Document> parse_model(std::string text, const std::string& file_name, Diagnostics& diagnostics) {
  if (is_robot(file_name)) return parse_robot(std::move(text), file_name, diagnostics);
  std::optional<Document> document = parse_yaml(std::move(text), file_name, diagnostics);
  if (document && document->root().is_map() && document->root().find("urdf") != nullptr) {
    if (!add_robot(*document, add_robot_sections, diagnostics)) leave_robot_out(*document);
  }
  return document;
}

std::optional<Document> read_model(const std::string& file_name, Diagnostics& diagnostics) {
  std::string text;
  if (const std::string why = read_input(file_name, text); !why.empty()) {
    std::string hint;
    std::error_code ignored;
    const std::string inside = kept_model(file_name);
    if (std::filesystem::exists(inside, ignored)) hint = "its model is '" + inside + "'";
    diagnostics.error({file_name, 0, 0}, 1, "file-not-found", fmt::format("cannot read '{}': {}", file_name, why), {},
                      hint);
    return std::nullopt;
  }
  return parse_model(std::move(text), file_name, diagnostics);
}

}  // namespace freeplay
