#include "yaml/text.h"

#include <string>

#include <gtest/gtest.h>

#include "yaml/document.h"

namespace freeplay {
namespace {

Document parse(const std::string& text) {
  Diagnostics diagnostics;
  auto document = parse_yaml(text, "m.yaml", diagnostics);
  EXPECT_EQ(diagnostics.format(0), "") << text;
  return document ? std::move(*document) : Document("m.yaml", "");
}

/// Kind, text and children, without places.
std::string shape(const Node& node) {
  if (node.is_null()) return "~";
  if (node.is_scalar()) return "'" + node.text + "'";
  std::string out = node.is_list() ? "[" : "{";
  for (const Node* item : node.items) out += shape(*item) + ",";
  for (const Node::Entry& entry : node.entries) out += shape(*entry.key) + ":" + shape(*entry.value) + ",";
  return out + (node.is_list() ? "]" : "}");
}

TEST(YamlText, ReadsBackToTheSameTree) {
  const std::string long_list = "[" + std::string(60, '1') + ", " + std::string(60, '2') + ", {a: b, c: [d]}]";
  const Document document =
      parse("freeplay: 1\nname: \"a: b # c\"\nempty: ''\nnothing:\nquoted: \"~\"\nlist: " + long_list +
            "\nbodies:\n  rod: {mass: 1 kg, inertia: \"1 kg*m^2 / 12\", com: [$l/2, \"atan2(1, 2)\"], note: \"x\\n\\ty "
            "\\\"z\\\"\"}\n"
            "  other: {mass: -1e-05, x: \"- a\", y: \"*a\", z: \"{a}\", deep: {" +
            std::string(60, 'k') + ": " + std::string(60, 'v') + "}}\n");
  EXPECT_EQ(shape(parse(yaml_text(document.root())).root()), shape(document.root()));
}

TEST(YamlText, PutsEntriesOnLinesOfTheirOwnAndShortMapsInBraces) {
  const Document document = parse("{bodies: {a: {mass: 1, com: [1, 2]}, b: {mass: 2}}, joints: {}}");
  EXPECT_EQ(yaml_text(document.root()), "bodies:\n  a: {mass: 1, com: [1, 2]}\n  b: {mass: 2}\n");
}

}  // namespace
}  // namespace freeplay
