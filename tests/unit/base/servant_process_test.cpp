#include "base/servant_process.h"

#include <csignal>
#include <cstring>
#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace freeplay {
namespace {

using Send = ServantProcess::Send;

ServantProcess::Serve answers() {
  return [asked = 0](std::string_view question, const Send& send) mutable {
    ++asked;
    if (question == "crash") std::raise(SIGSEGV);
    for (volatile bool on = question == "hang"; on;) asked = 0;
    if (question == "numbers") {
      const std::vector<double> many(1 << 20, 0.5);
      return send(7, {reinterpret_cast<const char*>(many.data()), many.size() * sizeof(double)});
    }
    send(static_cast<std::uint64_t>(asked), question);
  };
}

std::string why_gone(ServantProcess& servant, const char* question) {
  try {
    servant.ask(question);
  } catch (const ServantGone& gone) {
    return gone.what();
  }
  return "";
}

TEST(ServantProcess, AnswersOneQuestionAfterTheOther) {
  ServantProcess servant(answers);
  EXPECT_EQ("a", servant.ask("a").text());
  EXPECT_EQ("", servant.ask("").text());
  EXPECT_EQ(3, servant.ask("abc").kind);
  const ServantProcess::Answer numbers = servant.ask("numbers");
  EXPECT_EQ(7, numbers.kind);
  ASSERT_EQ(1 << 20, numbers.body.size());
  EXPECT_EQ(0.5, numbers.body.back());
}

TEST(ServantProcess, MayCrashOrHangWithoutHarm) {
  ServantProcess other(answers);
  {
    ServantProcess servant(answers);
    EXPECT_EQ("crashes", why_gone(servant, "crash"));
    EXPECT_EQ("crashes", why_gone(servant, "a"));
  }
  ServantProcess servant(answers, 0.3);
  EXPECT_EQ("a", servant.ask("a").text());
  EXPECT_EQ("does not come to an end", why_gone(servant, "hang"));
  EXPECT_EQ("a", other.ask("a").text());
}

}  // namespace
}  // namespace freeplay
