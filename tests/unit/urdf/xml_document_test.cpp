#include "urdf/xml_document.h"

#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

std::unique_ptr<XmlDocument> parse(const std::string& text, std::string& report) {
  Diagnostics diagnostics;
  auto document = parse_xml(text, "r.xml", "bad-xml", diagnostics);
  report.clear();
  for (const Diagnostic& d : diagnostics.sorted()) {
    report += std::to_string(d.location.line) + ":" + std::to_string(d.location.column) + " " + d.id;
  }
  return document;
}

std::unique_ptr<XmlDocument> good(const std::string& text) {
  std::string report;
  auto document = parse(text, report);
  EXPECT_EQ(report, "");
  return document;
}

std::string fault(const std::string& text) {
  std::string report;
  EXPECT_EQ(parse(text, report), nullptr) << text;
  return report;
}

std::string text(const TextPlace& place) { return std::to_string(place.line) + ":" + std::to_string(place.column); }

std::string place(const XmlElement& element, const char* attribute) {
  return text(*place_of(element, *element.FindAttribute(attribute)));
}

TEST(ParseXml, KeepsElementsAttributesTextAndPlaces) {
  const auto document =
      good("<?xml version=\"1.0\"?>\n<!-- note -->\n<a  b = 'x'\n c=\"&lt;&#x41;&quot;\">\n t <d/>u</a>\n");
  XmlElement& root = document->root();
  EXPECT_STREQ(root.Name(), "a");
  EXPECT_EQ(text(places_of(root).begin), "3:1");
  EXPECT_EQ(text(places_of(root).name), "3:2");
  ASSERT_EQ(places_of(root).attributes.size(), 2u);
  EXPECT_STREQ(root.Attribute("b"), "x");
  EXPECT_STREQ(root.Attribute("c"), "<A\"");
  EXPECT_EQ(place(root, "b"), "3:5");
  EXPECT_EQ(place(root, "c"), "4:2");
  EXPECT_EQ(text_of(root), "\n t u");
  EXPECT_EQ(text(places_of(root).text), "5:2");
  ASSERT_NE(root.FirstChildElement("d"), nullptr);
  EXPECT_EQ(text(places_of(*root.FirstChildElement("d")).begin), "5:4");
}

TEST(ParseXml, TakesCommentsCdataAndCharactersOutsideOfAscii) {
  EXPECT_EQ(text_of(good("<a><![CDATA[1 < 2]]></a><!-- end -->")->root()), "1 < 2");
  EXPECT_STREQ(good("\xEF\xBB\xBF<a n='\xC3\xA4'/>")->root().Attribute("n"), "\xC3\xA4");
  // Columns count characters, not bytes.
  EXPECT_EQ(place(good("<a n='\xC3\xA4' m=''/>")->root(), "m"), "1:10");
  EXPECT_EQ(place(good("<a\r\n\tn=''\r\n\t\tm='>/'/>")->root(), "m"), "3:3");
}

TEST(ParseXml, TakesADeclarationOnlyAtTheBeginningAndOnlyTheEncodingThatTheFileHas) {
  good("\xEF\xBB\xBF<?xml version='1.0' encoding='utf-8'?><a/>");
  good("<?xml version='1.0' encoding=\"ISO-8859-1\"?><a/>");
  for (const char* other : {"<?xml verison='1.0'?><a/>", "<?xml?><a/>"}) good(other);  // as other people have it
  good("<a><?xml-stylesheet href='x'?></a>");
  EXPECT_EQ(fault("\n<?xml version='1.0'?><a/>"), "2:1 bad-xml");
  EXPECT_EQ(fault("<a/><?xml version='1.0'?>"), "1:5 bad-xml");
  EXPECT_EQ(fault("<?xml version='1.0'?><?xml version='1.0'?><a/>"), "1:22 bad-xml");
  EXPECT_EQ(fault("<?xml version='1.0' encoding='UTF-16'?><a/>"), "1:31 bad-xml");
  EXPECT_EQ(fault("<?xml version='1.0' encoding='latin1'?><a n='\xC3\xA4'/>"), "1:31 bad-xml");
  EXPECT_EQ(fault("<a n='\uFFFE'/>"), "1:7 bad-xml");
  EXPECT_EQ(fault("<a n='&#xFFFF;'/>"), "1:7 bad-xml");
}

/// Texts that tinyxml2 takes although they are not well-formed, and where that is seen here.
TEST(ParseXml, RefusesWhatTinyxml2LetsPass) {
  constexpr std::pair<const char*, const char*> cases[] = {
      {"<a/><b/>", "1:5 bad-xml"},           {"<a>&who;</a>", "1:4 bad-xml"},   {"<a>&#0;</a>", "1:4 bad-xml"},
      {"<a>\x01</a>", "1:4 bad-xml"},        {"<a>\xFF</a>", "1:4 bad-xml"},    {"<!DOCTYPE a><a/>", "1:1 bad-xml"},
      {"<a>x]]>y</a>", "1:5 bad-xml"},       {"<a b='<'/>", "1:7 bad-xml"},     {"<a\u00D7/>", "1:3 bad-xml"},
      {"<a><!-- -- --></a>", "1:9 bad-xml"}, {"<a b='1'c='2'/>", "1:9 bad-xml"}};
  for (const auto& [xml, where] : cases) {
    tinyxml2::XMLDocument document;
    EXPECT_EQ(document.Parse(xml), tinyxml2::XML_SUCCESS) << xml;
    EXPECT_EQ(fault(xml), where) << xml;
  }
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
  EXPECT_EQ(fault("<a b='<'/>"), "1:7 bad-xml");
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
  EXPECT_EQ(parse_xml(text, "r.xml", "bad-xml", diagnostics), nullptr) << text;
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

TEST(ParseXml, ReadsNoOtherEncodingThanUtf8) {
  EXPECT_EQ(message(std::string("\xFF\xFE<\0a\0/\0>\0", 10)), "this is not UTF-8 text");  // UTF-16, which Expat takes
  EXPECT_EQ(message("<?xml version='1.0'?><a n='\xE4'/>"), "this is not UTF-8 text");
}

TEST(ParseXml, SaysWhatIsWrongWhereItIs) {
  constexpr std::pair<const char*, const char*> cases[] = {
      {"", "1:1 the file holds no element: it is empty"},
      {"<!-- only -->\n", "1:1 the file holds no element: it is empty"},
      {"<a>\n<b>\n</a>", "2:4 the element 'b' is opened here and never closed"},
      {"<a>\n<b></b>", "1:4 the element 'a' is opened here and never closed"},
      {"<a></b></a>", "1:4 the end tag </b> closes nothing"},
      {"<a></a n='b'>", "1:4 an end tag holds nothing but its name: </a>"},
      {"<a></>", "1:4 the end tag </> closes nothing"},
      {"<a/>\n<b/>", "2:1 a second root element; a file holds one"},
      {"<a/>\n text", "2:2 text outside of the root element"},
      {"\n text <a/>", "2:2 text outside of the root element"},
      {"<a/><![CDATA[ b ]]>", "1:15 text outside of the root element"},
      {"< a/>", "1:1 a name must follow '<'"},
      {"<a b='1'", "1:9 the tag of 'a' is not closed: '>' is missing"},
      {"<a %/>", "1:4 an attribute or '>' is expected in 'a'"},
      {"<a b='1'c='2'/>", "1:9 a blank is missing between two attributes"},
      {"<a\n b/>", "2:2 the attribute 'b' has no value"},
      {"<a b=1/>", "1:4 the value of 'b' must stand in quotes"},
      {"<a b='x<'/>", "1:8 '<' cannot stand in the value of 'b'"},
      {"<a b='x < y' c='1'/>", "1:9 '<' cannot stand in the value of 'b'"},
      {"<a b='x>\n<c d='1'/>", "1:4 the value of 'b' is not closed: ' is missing"},
      {"<a b='x>\n<c/>", "1:4 the value of 'b' is not closed: ' is missing"},
      {"<a b='1' b='2'/>", "1:10 the attribute 'b' is given twice"},
      {"<a\u00E4 \u00D7='1'/>", "1:5 XML does not allow this character in a name"},
      {"<a>x & y</a>", "1:6 '&' begins a reference; write '&amp;'"},
      {"<a>&lt;&who;</a>", "1:8 unknown entity '&who;'"},
      {"<a>x]]>y</a>", "1:5 ']]>' cannot stand in text"},
      {"<a>\n<!-- b", "2:1 the comment never ends: '--' is missing"},
      {"<a><!-- - -- - --></a>", "1:11 '--' cannot stand inside of a comment"},
      {"<a><![CDATA[ b", "1:4 the CDATA section never ends: ']]>' is missing"},
      {"<a><?b", "1:4 the processing instruction never ends: '?>' is missing"},
      {"<a><? b?></a>", "1:4 a processing instruction begins with a name that is not 'xml'"},
      {"\n<?xml version='1.0'?><a/>", "2:1 the declaration '<?xml ...?>' can only begin the file"},
      {"<!DOCTYPE a [<!ENTITY b 'c'>]><a/>", "1:1 a document type (<!DOCTYPE>) with its entities is not allowed"},
      {"<a>\n<!ELEMENT b></a>", "2:1 a document type (<!DOCTYPE>) with its entities is not allowed"},
      {"<?xml version='1.0' encoding='UTF-16'?><a/>", "1:31 the file says that it is 'utf-16', but it is UTF-8"},
      {"<a>\u00E4\xFF</a>", "1:5 this is not UTF-8 text"},
      {"<a>\x01</a>", "1:4 XML allows no control characters"},
      {"<a n='\uFFFE'/>", "1:7 U+FFFE and U+FFFF are no characters"}};
  for (const auto& [xml, expected] : cases) {
    Diagnostics diagnostics;
    EXPECT_EQ(parse_xml(xml, "r.xml", "bad-xml", diagnostics), nullptr) << xml;
    ASSERT_EQ(diagnostics.sorted().size(), 1u) << xml;
    const Diagnostic found = diagnostics.sorted().front();
    EXPECT_EQ(text({found.location.line, found.location.column}) + " " + found.message, expected) << xml;
  }
}

}  // namespace
}  // namespace freeplay
