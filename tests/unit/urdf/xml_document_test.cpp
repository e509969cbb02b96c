#include "urdf/xml_document.h"

#include <string>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

std::optional<XmlElement> parse(const std::string& text, std::string& report) {
  Diagnostics diagnostics;
  auto root = parse_xml(text, "r.xml", "bad-xml", diagnostics);
  report.clear();
  for (const Diagnostic& d : diagnostics.sorted()) {
    report += std::to_string(d.location.line) + ":" + std::to_string(d.location.column) + " " + d.id;
  }
  return root;
}

XmlElement good(const std::string& text) {
  std::string report;
  auto root = parse(text, report);
  EXPECT_EQ(report, "");
  return root ? *root : XmlElement();
}

std::string fault(const std::string& text) {
  std::string report;
  EXPECT_FALSE(parse(text, report).has_value()) << text;
  return report;
}

TEST(ParseXml, KeepsElementsAttributesTextAndPlaces) {
  const XmlElement root =
      good("<?xml version=\"1.0\"?>\n<!-- note -->\n<a  b = 'x'\n c=\"&lt;&#x41;&quot;\">\n t <d/>u</a>\n");
  EXPECT_EQ(root.name, "a");
  EXPECT_EQ(root.place.line, 3);
  EXPECT_EQ(root.name_place.column, 2);
  ASSERT_EQ(root.attributes.size(), 2u);
  EXPECT_EQ(root.attribute("b")->value, "x");
  EXPECT_EQ(root.attribute("c")->value, "<A\"");
  EXPECT_EQ(root.attribute("c")->place.line, 4);
  EXPECT_EQ(root.attribute("c")->place.column, 2);
  EXPECT_EQ(root.text, "\n t u");
  EXPECT_EQ(root.text_place.line, 5);
  EXPECT_EQ(root.text_place.column, 2);
  ASSERT_NE(root.child("d"), nullptr);
  EXPECT_EQ(root.child("d")->place.column, 4);
}

TEST(ParseXml, TakesCommentsCdataAndCharactersOutsideOfAscii) {
  EXPECT_EQ(good("<a><![CDATA[1 < 2]]></a><!-- end -->").text, "1 < 2");
  EXPECT_EQ(good("\xEF\xBB\xBF<a n='\xC3\xA4'/>").attribute("n")->value, "\xC3\xA4");
  // Columns count characters, not bytes.
  EXPECT_EQ(good("<a n='\xC3\xA4' m=''/>").attribute("m")->place.column, 10);
}

TEST(ParseXml, TakesADeclarationOnlyAtTheBeginningAndOnlyTheEncodingThatTheFileHas) {
  good("\xEF\xBB\xBF<?xml version='1.0' encoding='utf-8'?><a/>");
  good("<?xml version='1.0' encoding=\"ISO-8859-1\"?><a/>");
  good("<a><?xml-stylesheet href='x'?></a>");
  EXPECT_EQ(fault("\n<?xml version='1.0'?><a/>"), "2:1 bad-xml");
  EXPECT_EQ(fault("<a/><?xml version='1.0'?>"), "1:5 bad-xml");
  EXPECT_EQ(fault("<?xml version='1.0' encoding='UTF-16'?><a/>"), "1:31 bad-xml");
  EXPECT_EQ(fault("<?xml version='1.0' encoding='latin1'?><a n='\xC3\xA4'/>"), "1:31 bad-xml");
  EXPECT_EQ(fault("<a n='\uFFFE'/>"), "1:7 bad-xml");
  EXPECT_EQ(fault("<a n='&#xFFFF;'/>"), "1:7 bad-xml");
}

TEST(ParseXml, RefusesWhatIsNotWellFormed) {
  EXPECT_EQ(fault(""), "1:1 bad-xml");
  EXPECT_EQ(fault("  \n "), "1:1 bad-xml");
  EXPECT_EQ(fault("<a><b></a>"), "1:7 bad-xml");
  EXPECT_EQ(fault("<a></b></a>"), "1:4 bad-xml");
  EXPECT_EQ(fault("<a>"), "1:4 bad-xml");
  EXPECT_EQ(fault("<a/><b/>"), "1:5 bad-xml");
  EXPECT_EQ(fault("<a/> text"), "1:6 bad-xml");
  EXPECT_EQ(fault("<a b='1' b='2'/>"), "1:10 bad-xml");
  EXPECT_EQ(fault("<a b='1'c='2'/>"), "1:9 bad-xml");
  EXPECT_EQ(fault("<a b/>"), "1:4 bad-xml");
  EXPECT_EQ(fault("<a b=1/>"), "1:4 bad-xml");
  EXPECT_EQ(fault("<a b='<'/>"), "1:4 bad-xml");
  EXPECT_EQ(fault("<a>&who;</a>"), "1:4 bad-xml");
  EXPECT_EQ(fault("<a>&</a>"), "1:4 bad-xml");
  EXPECT_EQ(fault("<a>&#0;</a>"), "1:4 bad-xml");
  EXPECT_EQ(fault("<a>\x01</a>"), "1:4 bad-xml");
  EXPECT_EQ(fault("<a>\xFF</a>"), "1:4 bad-xml");
  EXPECT_EQ(fault("<a><!-- - -- - --></a>"), "1:11 bad-xml");
  EXPECT_EQ(fault("<a><!-- "), "1:4 bad-xml");
  EXPECT_EQ(fault("<!DOCTYPE a [<!ENTITY b 'c'>]><a/>"), "1:1 bad-xml");
  EXPECT_EQ(fault("< a/>"), "1:1 bad-xml");
}

TEST(ParseXml, RefusesWhatWouldEatMemoryOrTime) {
  std::string deep;
  for (int i = 0; i < 100; ++i) deep += "<a>";
  EXPECT_TRUE(fault(deep).ends_with("too-large"));
  std::string many = "<a>";
  for (int i = 0; i < 1'000'001; ++i) many += "<b/>";
  EXPECT_TRUE(fault(many + "</a>").ends_with("too-large"));
  std::string attributes = "<a";
  for (int i = 0; i < 300; ++i) attributes += " b" + std::to_string(i) + "=''";
  EXPECT_TRUE(fault(attributes + "/>").ends_with("too-large"));
  std::string text = "<a>";
  for (int i = 0; i < 200'000; ++i) text += "<b c='d'>e</b> &amp; ";
  good(text + "</a>");  // read in linear time: a reader that were quadratic would run past the limit of any test
}

std::string message(const std::string& text) {
  Diagnostics diagnostics;
  EXPECT_FALSE(parse_xml(text, "r.xml", "bad-xml", diagnostics).has_value()) << text;
  return diagnostics.sorted().empty() ? "" : diagnostics.sorted().front().message;
}

TEST(ParseXml, NamesReferencesAsTheyStandInTheFile) {
  EXPECT_EQ(message("<a n='b&#0;'/>"), "'&#0;' stands for a character that XML does not allow");
  EXPECT_EQ(message("<a n='b&#x1b;'/>"), "'&#x1b;' stands for a character that XML does not allow");
  EXPECT_EQ(message("<a n='b&#x110000000000000000;'/>"),
            "'&#x110000000000000000;' stands for a character that XML does not allow");
  EXPECT_EQ(message("<a n='b&#q;'/>"), "'&#q;' is not the number of a character");
  EXPECT_EQ(message("<a n='b&nbsp;'/>"), "unknown entity '&nbsp;'");
}

TEST(ParseXml, SaysWhatAnEndTagHolds) {
  EXPECT_EQ(message("<a></a n='b'>"), "an end tag holds nothing but its name: </a>");
}

}  // namespace
}  // namespace freeplay
