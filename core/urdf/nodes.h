// UrdfNodes: makes the nodes of the model that a URDF file stands for.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "format/document.h"
#include "urdf/robot.h"

namespace freeplay::urdf {

/// Nodes belong to a document; their places are those of the URDF file.
class Nodes {
 public:
  Nodes(Document& document, const std::string* file) : document_(document), file_(file) {}

  Node& map(const Spot& spot) { return node(Node::Kind::map, spot); }
  Node& scalar(std::string text, const Spot& spot) {
    Node& made = node(Node::Kind::scalar, spot);
    made.text = std::move(text);
    return made;
  }
  Node& number(double value, const Spot& spot) { return scalar(number_text(value), spot); }
  Node& list(std::vector<const Node*> items, const Spot& spot) {
    Node& made = node(Node::Kind::list, spot);
    made.items = std::move(items);
    return made;
  }
  Node& numbers(const std::vector<double>& values, const Spot& spot) {
    std::vector<const Node*> items;
    for (const double value : values) items.push_back(&number(value, spot));
    return list(std::move(items), spot);
  }
  void put(Node& owner, const std::string& key, const Node& value, const Spot& spot) {
    Node& key_node = scalar(key, spot);
    key_node.foreign = true;
    owner.entries.push_back({&key_node, &value});
  }

 private:
  Node& node(Node::Kind kind, const Spot& spot) {
    Node& made = document_.add(kind, spot.line, spot.column);
    made.length = spot.length;
    made.file = file_;
    return made;
  }

  Document& document_;
  const std::string* file_;
};

}  // namespace freeplay::urdf
