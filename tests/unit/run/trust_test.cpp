#include "run/trust.h"

#include <string>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TrustReason reason(const char* id, Trust level, const char* message = "") {
  return {.id = id, .level = level, .message = message};
}

std::string ids(const Verdict& verdict) {
  std::string text;
  for (const TrustReason& r : verdict.reasons()) text += r.id + " ";
  return text;
}

TEST(Verdict, IsGoodWithoutReasons) {
  EXPECT_EQ(Verdict().level(), Trust::good);
  EXPECT_STREQ(word(Verdict().level()), "good");
}

TEST(Verdict, IsThatOfItsWorstReason) {
  Verdict verdict;
  verdict.add(reason("a", Trust::doubtful));
  EXPECT_STREQ(word(verdict.level()), "doubtful");
  verdict.add(reason("b", Trust::bad));
  EXPECT_STREQ(word(verdict.level()), "bad");
}

TEST(Verdict, PutsTheWorstFirstAndKeepsTheOrderElse) {
  Verdict verdict;
  for (const char* id : {"a", "c"}) verdict.add(reason(id, Trust::doubtful));
  for (const char* id : {"d", "b"}) verdict.add(reason(id, Trust::bad));
  EXPECT_EQ(ids(verdict), "d b a c ");
}

TEST(Verdict, LeavesOutWhatItHasAndWhatIsGood) {
  Verdict verdict;
  verdict.add(reason("a", Trust::doubtful, "x"));
  verdict.add(reason("a", Trust::doubtful, "x"));
  verdict.add(reason("a", Trust::doubtful, "y"));
  verdict.add(reason("b", Trust::good));
  EXPECT_EQ(ids(verdict), "a a ");
}

}  // namespace
}  // namespace freeplay
