#include "run/state_bytes.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/sha256.h"

namespace freeplay {
namespace {

RunState some_state() {
  RunState state{.time = 0.25, .steps = 7, .rows = 3};
  state.features = {{1.0, -0.0}, {2, -5}};
  state.numbers = {{std::numeric_limits<double>::quiet_NaN(), 5e-324, std::numeric_limits<double>::infinity()},
                   {std::numeric_limits<std::int64_t>::min(), 1, 0}};
  return state;
}

std::string refusal(const std::string& bytes) {
  try {
    state_of(bytes);
    return "none";
  } catch (const Error& error) {
    EXPECT_EQ(error.category(), Error::Category::input);
    return error.id();
  }
}

TEST(StateBytes, KeepEveryBit) {
  const RunState state = some_state();
  EXPECT_TRUE(state_of(bytes_of(state)) == state);
  EXPECT_TRUE(state_of(bytes_of(RunState{})) == RunState{});
}

TEST(StateBytes, AreLittleEndianAndTellTheirSize) {
  const std::string bytes = bytes_of(some_state());
  EXPECT_EQ(bytes.substr(0, 16), std::string("FPSTATE\n\1\0\0\0\0\0\0\0", 16));
  // Mark, nine numbers that every state has, ten of this one, digest.
  ASSERT_EQ(bytes.size(), 8u + 8u * (9 + 10) + 64u);
  EXPECT_EQ(static_cast<unsigned char>(bytes[16]), bytes.size());
  EXPECT_EQ(bytes.substr(24, 8), std::string("\0\0\0\0\0\0\xd0\x3f", 8));  // 0.25
  EXPECT_EQ(bytes.substr(32, 8), std::string("\7\0\0\0\0\0\0\0", 8));
}

TEST(StateBytes, AreRefusedWhereAnyOneIsChanged) {
  const std::string bytes = bytes_of(some_state());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ 0x10);
    EXPECT_EQ(refusal(changed), i < 16 ? "state-format" : "state-damaged") << i;
  }
}

TEST(StateBytes, AreRefusedWhereSomeAreMissingOrAdded) {
  const std::string bytes = bytes_of(some_state());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_EQ(refusal(bytes.substr(0, size)), size < 8 ? "state-format" : "state-damaged") << size;
  }
  EXPECT_EQ(refusal(bytes + '\0'), "state-damaged");
}

TEST(StateBytes, AreRefusedWhereAListIsLongerThanTheRest) {
  std::string bytes = bytes_of(some_state());
  bytes[48 + 6] = '\x7f';  // the length of the first list
  bytes.resize(bytes.size() - 64);
  bytes += sha256(bytes);
  EXPECT_EQ(refusal(bytes), "state-damaged");
}

TEST(StateBytes, OfAnotherVersionAreNamedAsSuch) {
  std::string bytes = bytes_of(some_state());
  bytes[8] = 2;
  try {
    state_of(bytes);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), "state-format");
    EXPECT_NE(error.message().find("version 2"), std::string::npos);
  }
}

}  // namespace
}  // namespace freeplay
