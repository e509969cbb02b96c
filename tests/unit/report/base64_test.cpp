#include "report/base64.h"

#include <vector>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(Base64, IsThatOfRfc4648) {
  const std::pair<const char*, const char*> pairs[] = {{"", ""},
                                                       {"f", "Zg=="},
                                                       {"fo", "Zm8="},
                                                       {"foo", "Zm9v"},
                                                       {"foob", "Zm9vYg=="},
                                                       {"fooba", "Zm9vYmE="},
                                                       {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, text] : pairs) {
    EXPECT_EQ(base64(plain), text);
    EXPECT_EQ(base64_size(std::string_view(plain).size()), std::string_view(text).size());
  }
  EXPECT_EQ(base64("\xfb\xff\xfe"), "+//+");
}

TEST(Base64, OfNumbersIsLittleEndian) {
  EXPECT_EQ(base64_numbers<std::int32_t>(std::vector<std::int32_t>{1, 256}), "AQAAAAABAAA=");
  EXPECT_EQ(base64_floats(std::vector{3.5}, 2.5), "AACAPw==");  // 1.0f
}

}  // namespace
}  // namespace freeplay
