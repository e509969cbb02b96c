#include "yaml/document.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "load/model_file.h"

namespace freeplay {
namespace {

/// A text that must be readable.
Document read_yaml_text(const std::string& text) {
  Diagnostics diagnostics;
  auto document = parse_yaml(text, "m.yaml", diagnostics);
  EXPECT_EQ(diagnostics.format(0), "");
  if (!document) throw Error(Error::Category::input, "test", "not readable");
  return std::move(*document);
}

/// "line:column id" of the messages for a text.
std::string errors(const std::string& text) {
  Diagnostics diagnostics;
  parse_yaml(text, "m.yaml", diagnostics);
  std::string all;
  for (const Diagnostic& d : diagnostics.sorted()) {
    all += (all.empty() ? "" : ", ") + std::to_string(d.location.line) + ":" + std::to_string(d.location.column) + " " +
           d.id;
  }
  return all;
}

std::string place(const Node& node) {
  return std::to_string(node.line) + ":" + std::to_string(node.column) + "+" + std::to_string(node.length);
}

TEST(ReadYaml, KeepsOrderKindsAndPlaces) {
  const Document document = read_yaml_text("name: rod\nlist: [1, 2 mm]\nmap: {b: 1, a: 2}\n");
  const Node& root = document.root();
  ASSERT_TRUE(root.is_map());
  ASSERT_EQ(root.entries.size(), 3u);
  EXPECT_EQ(root.entries[2].key->text, "map");
  EXPECT_EQ(place(*root.entries[2].key), "3:1+3");
  EXPECT_EQ(place(*root.find("name")), "1:7+3");
  const Node& list = *root.find("list");
  ASSERT_TRUE(list.is_list());
  EXPECT_EQ(place(list), "2:7+1");
  EXPECT_EQ(list.items[1]->text, "2 mm");
  EXPECT_EQ(place(*list.items[1]), "2:11+4");
  EXPECT_EQ(root.find("map")->entries[0].key->text, "b");
  EXPECT_EQ(root.find("absent"), nullptr);
}

TEST(ReadYaml, CountsColumnsInCharacters) {
  const Document document = read_yaml_text("{\u00b5\u20ac: \"\U0001F600\", b: 1}\n");
  EXPECT_EQ(place(*document.root().entries[0].key), "1:2+2");
  EXPECT_EQ(place(*document.root().entries[0].value), "1:6+3");
  EXPECT_EQ(place(*document.root().find("b")), "1:14+1");
}

TEST(ReadYaml, MapsAnOffsetToAPlaceWhereTheTextIsVerbatim) {
  const Document document = read_yaml_text("a: 2*$l\nb: '2*$l'\nc: \"2\\t$l\"\nd: >\n  2*$l\ne: 2\n  * 3\n");
  EXPECT_EQ(document.root().find("a")->location_at(2).column, 6);
  EXPECT_EQ(document.root().find("b")->location_at(2).column, 7);
  EXPECT_EQ(document.root().find("c")->location_at(2).column, 4);
  EXPECT_EQ(document.root().find("d")->location_at(2).line, 4);
  EXPECT_EQ(document.root().find("e")->text, "2 * 3");
  EXPECT_EQ(document.root().find("e")->location_at(3).column, 4);
}

TEST(ReadYaml, DistinguishesAnAbsentValueFromTheWordNull) {
  const Document document = read_yaml_text("a:\nnull: ~\nb: null\nc: [~, 1]\nd:\n  -\n");
  EXPECT_TRUE(document.root().find("a")->is_null());
  EXPECT_EQ(place(*document.root().find("a")), "1:1+1");
  EXPECT_EQ(document.root().find("null")->text, "~");
  EXPECT_EQ(document.root().find("b")->text, "null");
  EXPECT_TRUE(document.root().find("c")->items[0]->is_scalar());
  EXPECT_TRUE(document.root().find("d")->items[0]->is_null());
  EXPECT_EQ(place(*document.root().find("d")->items[0]), "6:3+1");
}

TEST(ReadYaml, SharesTheNodeOfAnAlias) {
  const Document document = read_yaml_text("x-a: &a # why\n  {k: 1}\nb: *a\nc: &n 5 mm\nd: *n\n");
  const Node& root = document.root();
  EXPECT_EQ(root.find("x-a"), root.find("b"));
  EXPECT_EQ(place(*root.find("b")), "2:3+1");
  EXPECT_EQ(place(*root.find("d")), "4:7+4");
}

TEST(ReadYaml, TakesAnEmptyTextAsNothing) {
  for (const char* text : {"", "# only a comment\n", "---\n", "\xEF\xBB\xBF"}) {
    const Document document = read_yaml_text(text);
    EXPECT_TRUE(document.root().is_null());
    EXPECT_EQ(document.root().location().line, 1);
  }
}

TEST(ReadYaml, IgnoresAByteOrderMarkAndCarriageReturns) {
  const Document document = read_yaml_text(
      "\xEF\xBB\xBF"
      "a: 1\r\nb: 2\r\n");
  EXPECT_EQ(place(*document.root().entries[0].key), "1:1+1");
  EXPECT_EQ(document.root().find("b")->text, "2");
  EXPECT_EQ(place(*document.root().find("b")), "2:4+1");
}

TEST(ReadYaml, RefusesWhatTheFormatLeavesOut) {
  EXPECT_EQ(errors("a: !!str 1\nb: !x {c: 1}\nc: &k !y z\n"), "1:4 yaml-feature, 2:4 yaml-feature, 3:7 yaml-feature");
  EXPECT_EQ(errors("a: &a {b: 1}\nc:\n  <<: *a\n"), "3:3 yaml-feature");
  EXPECT_EQ(errors("a: 1\n---\nb: 1\n"), "2:1 yaml-feature");
  EXPECT_EQ(errors("\"<<\": 1\n"), "");
}

TEST(ReadYaml, RefusesAKeyGivenTwiceAtTheSecond) {
  EXPECT_EQ(errors("a: 1\nb: {c: 1, \"c\": 2}\na: 3\n"), "2:11 duplicate-key, 3:1 duplicate-key");
  Diagnostics diagnostics;
  const auto document = parse_yaml("a: 1\na: 2\n", "m.yaml", diagnostics);
  ASSERT_TRUE(document);
  EXPECT_EQ(document->root().entries.size(), 1u);
  EXPECT_EQ(document->root().find("a")->text, "1");
}

TEST(ReadYaml, RefusesAListOrMapAsKey) {
  EXPECT_EQ(errors("[a, b]: 1\nc: 2\n"), "1:1 wrong-type");
  EXPECT_EQ(errors("? {a: 1}\n: 2\n"), "1:3 wrong-type");
}

TEST(ReadYaml, PointsAtSyntaxErrors) {
  EXPECT_EQ(errors("a: [1, 2\nb: {c: 1}\n"), "1:4 yaml-syntax");
  EXPECT_EQ(errors("name: four: bar\n"), "1:11 yaml-syntax");
  EXPECT_EQ(errors("a: %60 rpm\n"), "1:4 yaml-syntax");
  EXPECT_EQ(errors("a: *x\n"), "1:4 yaml-syntax");
  EXPECT_EQ(errors("a: \"x\n"), "1:4 yaml-syntax");
  EXPECT_EQ(errors("a:\n  b: 1\n   c: 2\n"), "3:5 yaml-syntax");
}

TEST(ReadYaml, RefusesBadBytes) {
  EXPECT_EQ(errors("a: 1\nb: \u00e9\xff\n"), "2:5 yaml-syntax");
  EXPECT_EQ(errors(std::string("a: 1\0", 5)), "1:5 yaml-syntax");
  EXPECT_EQ(errors("a: \x1b[31m\n"), "1:4 yaml-syntax");
  EXPECT_EQ(errors("a: \"\\u001b\"\n"), "");  // escaped it is only text
}

TEST(ReadYaml, IsAsStrictAsTheSpecification) {
  EXPECT_EQ(errors("bodies:\n  rod\nmass: 1\n"), "");  // a text over two lines
  EXPECT_EQ(errors("a: 1\nlone\n"), "2:1 yaml-syntax");
  EXPECT_EQ(errors("a: [1, , 2]\n"), "1:8 yaml-syntax");
  EXPECT_EQ(errors("a: [1, 2]#x\n"), "1:10 yaml-syntax");
  EXPECT_EQ(errors("a: 'x'#y\n"), "1:7 yaml-syntax");
  EXPECT_EQ(errors("a: \"x\\'\"\n"), "1:6 yaml-syntax");
  EXPECT_EQ(errors("a: [-, 1]\n"), "1:5 yaml-syntax");
  EXPECT_EQ(errors("a: 'x\ny'\n"), "2:1 yaml-syntax");
  EXPECT_EQ(errors("a: [\n\t1]\n"), "2:1 yaml-syntax");
  EXPECT_EQ(errors("a:\n\tb: 1\n"), "2:1 yaml-syntax");
  EXPECT_EQ(errors("%YAML 1.2\n"), "1:1 yaml-syntax");
  EXPECT_EQ(errors("%YAML 1.2\n...\n"), "1:1 yaml-syntax");
  EXPECT_EQ(errors("# x\n%YAML 1.2\na: 1\n"), "2:1 yaml-syntax");
  EXPECT_EQ(errors("a: 1\n%YAML 1.2\n"), "2:1 yaml-syntax");
  EXPECT_EQ(errors("%YAML 1.2\n\n# x\n---\na: 1\n"), "");
  EXPECT_EQ(errors("a: [b,\nc]\n"), "2:1 yaml-syntax");
  EXPECT_EQ(errors("a:\n  b: {c: 1,\n  d: 2}\n"), "3:3 yaml-syntax");
  EXPECT_EQ(errors("- [a,\nb]\n"), "2:1 yaml-syntax");
  EXPECT_EQ(errors("a: [b,\n# x\n\n c\n]\nd: {\n  e: 1\n}\n"), "");
  EXPECT_EQ(errors("[a,\nb]\n"), "");
  EXPECT_EQ(errors("a: ># x\n  b\n"), "1:5 yaml-syntax");
  EXPECT_EQ(errors("a: >2- # x\n  b\n"), "");
  EXPECT_EQ(errors("a: [x#y, -1, 'it''s', \"b\": 2, c:d] # fine\n"), "");
  EXPECT_EQ(errors("? a\n? b\n"), "");
}

TEST(ReadYaml, LimitsNestingTo64Levels) {
  const auto nested = [](std::size_t n) { return "a: " + std::string(n, '[') + std::string(n, ']') + "\n"; };
  EXPECT_EQ(errors(nested(63)), "");
  EXPECT_EQ(errors(nested(64)), "1:4 too-large");
  EXPECT_EQ(errors("a: " + std::string(100000, '[')), "1:4 too-large");
  std::string chain = "a0: &a0 [1]\n";  // each alias adds a level
  for (int i = 1; i < 70; ++i) {
    const std::string name = "a" + std::to_string(i);
    chain += name + ": &" + name + " [*a" + std::to_string(i - 1) + "]\n";
  }
  EXPECT_EQ(errors(chain), "64:11 too-large");
}

TEST(ReadYaml, CountsNodesBeforeItExpandsAliases) {
  std::string laughs = "x:\n  - &a0 [z, z, z, z, z, z, z, z, z, z]\n";
  for (int i = 1; i < 10; ++i) {
    const std::string alias = "*a" + std::to_string(i - 1);
    laughs += "  - &a" + std::to_string(i) + " [" + alias;
    for (int k = 0; k < 9; ++k) laughs += ", " + alias;
    laughs += "]\n";
  }
  EXPECT_EQ(errors(laughs), "1:1 too-large");
}

TEST(ReadYaml, RefusesAnAliasToItself) {
  EXPECT_EQ(errors("a: &a [*a]\n"), "1:8 yaml-syntax");
  EXPECT_EQ(errors("a: &a\n  b: *a\n"), "2:6 yaml-syntax");
}

TEST(ReadYaml, RefusesMoreThan16MiB) {
  EXPECT_EQ(errors("# " + std::string(16u << 20, 'x')), "1:1 too-large");
  EXPECT_EQ(errors("# " + std::string((16u << 20) - 2, 'x')), "");
}

TEST(ReadYaml, ReadsAFile) {
  const auto path = std::filesystem::temp_directory_path() / "freeplay_yaml_document_test.yaml";
  std::ofstream(path) << "a: 1\n";
  Diagnostics diagnostics;
  const auto document = read_model(path.string(), diagnostics);
  std::filesystem::remove(path);
  ASSERT_TRUE(document);
  EXPECT_EQ(document->root().find("a")->location().file, path.string());
}

TEST(ReadYaml, DoesNotOpenDirectoriesAndDevices) {
  for (const char* path : {"/nowhere/model.yaml", "/", "/dev/zero"}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(read_model(path, diagnostics));
    ASSERT_EQ(diagnostics.sorted().size(), 1u);
    EXPECT_EQ(diagnostics.sorted()[0].id, "file-not-found");
  }
}

TEST(Document, ReplacesAValueByATextFromElsewhere) {
  Document document = read_yaml_text("p: {c: &v 1 mm, d: *v}\n");
  const Node& parameters = *document.root().find("p");
  EXPECT_TRUE(document.replace_value(parameters, "c", "--set c", "50 um"));
  EXPECT_FALSE(document.replace_value(parameters, "e", "--set e", "1"));
  EXPECT_EQ(parameters.find("c")->text, "50 um");
  EXPECT_EQ(parameters.find("c")->location_at(3).file, "--set c");
  EXPECT_EQ(parameters.find("c")->location_at(3).column, 4);
  EXPECT_EQ(parameters.find("d")->text, "1 mm");
}

TEST(Document, CanBeAScalarFromTheCommandLine) {
  const Document document = Document::scalar("--set c", "50 um");
  EXPECT_TRUE(document.root().is_scalar());
  EXPECT_EQ(document.root().location().file, "--set c");
  EXPECT_EQ(document.root().length, 5);
}

TEST(Document, KeepsItsNodesWhenItIsMoved) {
  Document first = read_yaml_text("a: [1, 2]\n");
  const Node* list = first.root().find("a");
  const Document second = std::move(first);
  EXPECT_EQ(second.root().find("a"), list);
  EXPECT_EQ(list->items[1]->location().file, "m.yaml");
}

TEST(Yaml, RefusesFloodsOfBracketsBeforeTheyAreParsed) {
  const auto report = [](const std::string& text) {
    Diagnostics diagnostics;
    EXPECT_FALSE(parse_yaml(text, "m.yaml", diagnostics));
    return diagnostics.sorted().front();
  };
  const Diagnostic deep = report("a: 1\nb: " + std::string(10'001, '['));
  EXPECT_EQ(deep.id, "too-large");
  EXPECT_EQ(deep.location.line, 2);
  EXPECT_EQ(deep.location.column, 4);
  const Diagnostic wide = report("[1" + std::string(1'500'000, ',') + "]");
  EXPECT_EQ(wide.id, "too-large");
  EXPECT_EQ(wide.location.column, 1);
}

/// The first message and its hint.
std::string yaml_message(const std::string& text) {
  Diagnostics diagnostics;
  parse_yaml(text, "m.yaml", diagnostics);
  const std::vector<Diagnostic> all = diagnostics.sorted();
  return all.empty() ? "" : all.front().message + " | " + all.front().hint;
}

TEST(ReadYaml, TakesTabsInEmptyLinesAndBeforeCommentsOfTheirOwn) {
  const Document document = read_yaml_text("a: 1\n\t\nb:\n  c: 2\n  \t\n\t# note\n  d: [1,\n\t# note\n    2]\n");
  EXPECT_EQ(document.root().find("a")->text, "1");
  EXPECT_EQ(document.root().find("b")->find("d")->items.size(), 2u);
  EXPECT_EQ(errors("a:\n\tb: 1\n"), "2:1 yaml-syntax");
  EXPECT_EQ(errors("a: [1,\n\t2]\n"), "2:1 yaml-syntax");
}

TEST(ReadYaml, KeepsTabsInBlockScalars) {
  EXPECT_EQ(read_yaml_text("a: |  # note\n  x\n  \ty\n  \t\n  \t# z\nb: 1\n").root().find("a")->text,
            "x\n\ty\n\t\n\t# z\n");
}

TEST(ReadYaml, TakesACarriageReturnAsTheEndOfALine) {
  const Document document = read_yaml_text("a: 1\rb:\r  c: \"x\r    y\"\r");
  EXPECT_EQ(document.root().find("b")->find("c")->text, "x y");
  EXPECT_EQ(place(*document.root().find("b")->find("c")), "3:6+2");
  EXPECT_EQ(errors("a: 1\r\nb: 2\rb: 3\n"), "3:1 duplicate-key");
}

TEST(ReadYaml, RefusesWhatIsNoCharacter) {
  EXPECT_EQ(errors("a: \"\uFFFE\"\n"), "1:5 yaml-syntax");
  EXPECT_EQ(errors("a: \uFFFF\n"), "1:4 yaml-syntax");
  EXPECT_EQ(errors("a: \"\uFFFD\"\n"), "");
}

TEST(ReadYaml, PointsAtAnIncompleteEscape) {
  EXPECT_EQ(errors("a: 1\nb: \"a\\u12\"\nc: 2\n"), "2:6 yaml-syntax");
  EXPECT_EQ(errors("b: \"\\x4\"\n"), "1:5 yaml-syntax");
  EXPECT_NE(yaml_message("b: \"\\U12\"\n").find("8"), std::string::npos);
}

TEST(ReadYaml, SaysThatAValueHasEndedWhereMoreFollowsOnItsLine) {
  EXPECT_EQ(errors("a: 'b' c\n"), "1:8 yaml-syntax");
  EXPECT_EQ(yaml_message("a: 'b' c\n"), "the value before this has ended already | quote the value as a whole");
  EXPECT_EQ(yaml_message("a: &x 1\nb: &y *x\n"), "an alias cannot stand after something else | it is a whole value");
  EXPECT_EQ(yaml_message("a:\n    b: 1\n  c: 1\n").substr(0, 21), "this line is indented");
}

TEST(ReadYaml, PointsAtAnUnknownEscape) {
  EXPECT_EQ(errors("a: 1\nb: \"x\\q\"\n"), "2:6 yaml-syntax");
  EXPECT_EQ(errors("b: \"\\uD800\"\n"), "1:5 yaml-syntax");
  EXPECT_EQ(yaml_message("b: \"\\uD800\"\n").substr(0, 30), "this escape names no character");
}

TEST(ReadYaml, SaysWhyAWordIsRefused) {
  EXPECT_EQ(errors("a: {e: 1, b c\n  d: 1}\n"), "1:11 yaml-syntax");
  EXPECT_EQ(yaml_message("a: {b c\n  d: 1}\n"),
            "a key between brackets goes over more than one line here | write it on one line");
  EXPECT_EQ(yaml_message("a: [b c\n  d: 1]\n").substr(0, 22), "a key between brackets");
  EXPECT_EQ(yaml_message("a: {?b: 1}\n"), "a word that begins with '?' is not read between brackets | quote it");
  EXPECT_EQ(yaml_message("a: ,b\n"), "a value cannot begin with this character | quote the value");
  EXPECT_EQ(yaml_message("a: 1\n" + std::string(1100, 'k') + ": 1\n").substr(0, 31), "a key has at most 1024 characte");
  EXPECT_EQ(yaml_message("a: [1, 2\nb: 1\n").substr(0, 27), "this '[' is not closed befo");
  EXPECT_EQ(yaml_message("a: {b: 1\nc: 1\n").substr(0, 27), "this '{' is not closed befo");
}

}  // namespace
}  // namespace freeplay
