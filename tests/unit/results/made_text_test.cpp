#include "results/made_text.h"

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(FieldText, IsWhatStandsThereByteForByte) {
  const std::string object = R"( { "a" : 1e-06, "b":[{"runs": "}]\"{"}, [2]] , "runs" : { "x": [1,2] } ,"c":true} )";
  EXPECT_EQ("1e-06", field_text(object, "a"));
  EXPECT_EQ(R"([{"runs": "}]\"{"}, [2]])", field_text(object, "b"));
  EXPECT_EQ(R"({ "x": [1,2] })", field_text(object, "runs"));
  EXPECT_EQ("true", field_text(object, "c"));
  EXPECT_EQ("", field_text(object, "x"));
}

TEST(FieldText, EndsWithATextThatIsCut) {
  for (const char* text :
       {"", "{", "{\"", "{\"a", "{\"a\"", "{\"a\":", "{\"a\":[", "{\"a\":\"x\\", "[1]", "{]", "{\"a\" 1}"}) {
    EXPECT_EQ("", field_text(text, "b")) << text;
  }
}

TEST(MadeText, OfAPictureIsItWithoutItsRecord) {
  const std::string plain = "<?xml version=\"1.0\"?>\n<svg width=\"3\">\n<path/>\n</svg>\n";
  const Json record{{"made", "plot"}, {"model", {{"text", "a < b & c > d \"</metadata>\""}}}};
  const std::string picture = picture_with_record(plain, record);
  EXPECT_NE(plain, picture);
  const MadeText parts = split_picture(picture);
  EXPECT_EQ(record, parts.record);
  EXPECT_EQ(plain, parts.data);
  EXPECT_TRUE(split_picture(plain).record.is_null());
  EXPECT_EQ(Json({{"a", 1}}), split_picture("<svg><metadata id=\"x\"><![CDATA[{\"a\": 1}]]></metadata></svg>").record);
}

TEST(MadeText, OfAPageIsTheTextOfItsRuns) {
  const std::string page =
      "<!doctype html>\n<script type=\"application/json\" id=\"freeplay-data\">"
      "{\"schema\":1,\"provenance\":{\"made\":\"report\"},\"runs\":[{\"name\":\"a\\u003cb\"}]}</script>\n<p>";
  const MadeText parts = split_page(page);
  EXPECT_EQ(Json({{"made", "report"}}), parts.record);
  EXPECT_EQ("[{\"name\":\"a\\u003cb\"}]", parts.data);
  EXPECT_TRUE(split_page("<!doctype html><title>x</title>").record.is_null());
  EXPECT_TRUE(split_page(page.substr(0, page.find("</script>"))).record.is_null());
}

TEST(MadeText, OfJsonEndsBeforeItsRecord) {
  const Json record{{"made", "export"}};
  const std::string text = json_text({{"rows", {1, 2}}, {"provenance", record}});
  const MadeText parts = split_json(text);
  EXPECT_EQ(record, parts.record);
  EXPECT_EQ("{\n  \"rows\": [\n    1,\n    2\n  ],", parts.data);
  EXPECT_EQ("{\"rows\":[1]}", split_json(R"({"provenance":{"a":1},"rows":[1]})").data);
}

}  // namespace
}  // namespace freeplay
