#include "base/philox.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace freeplay {
namespace {

using ::testing::ElementsAre;

// The known answers that come with Random123, file kat_vectors, philox4x64 10.
TEST(Philox, GivesTheKnownAnswers) {
  EXPECT_THAT(philox({0, 0, 0, 0}, {0, 0}),
              ElementsAre(0x16554d9eca36314cu, 0xdb20fe9d672d0fdcu, 0xd7e772cee186176bu, 0x7e68b68aec7ba23bu));
  constexpr std::uint64_t ones = ~std::uint64_t{0};
  EXPECT_THAT(philox({ones, ones, ones, ones}, {ones, ones}),
              ElementsAre(0x87b092c3013fe90bu, 0x438c3c67be8d0224u, 0x9cc7d7c69cd777b6u, 0xa09caebf594f0ba0u));
  EXPECT_THAT(philox({0x243f6a8885a308d3u, 0x13198a2e03707344u, 0xa4093822299f31d0u, 0x082efa98ec4e6c89u},
                     {0x452821e638d01377u, 0xbe5466cf34e90c6cu}),
              ElementsAre(0xa528f45403e61d95u, 0x38c72dbd566e9788u, 0xa5a1610e72fd18b5u, 0x57bd43b5e52b7fe6u));
}

TEST(Philox, UnitNumbersLieStrictlyBetweenZeroAndOne) {
  EXPECT_EQ(0x1p-53, unit_number(0));
  EXPECT_EQ(1.0 - 0x1p-53, unit_number(~std::uint64_t{0}));
}

}  // namespace
}  // namespace freeplay
