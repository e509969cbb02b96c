#include "base/growing_file.h"

#include <filesystem>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/number_text.h"
#include "unit/scratch_folder.h"

namespace freeplay {
namespace {

TEST(GrowingFile, HoldsWholeLinesOnlyUntilItIsClosed) {
  const ScratchFolder folder;
  GrowingFile file(folder.file("rows"));
  std::size_t written = 0;
  for (int i = 0; i < 20000; ++i) {
    file.line() += "some text of a row";
    file.end_line();
    written += 19;
  }
  const std::string early = folder.read("rows");
  EXPECT_GT(early.size(), written / 2);
  EXPECT_EQ('\n', early.back());
  file.close();
  EXPECT_EQ(written, folder.read("rows").size());
}

TEST(GrowingFile, KeepsTheFirstFailureAndThrowsItAtTheEnd) {
  GrowingFile file("/dev/full");
  file.line() += "x";
  file.end_line();
  EXPECT_THROW(file.close(), Error);
  EXPECT_FALSE(file.ok());
}

TEST(GrowingFile, TellsThatItWasRemovedOrReplaced) {
  const ScratchFolder folder;
  GrowingFile removed(folder.file("removed")), replaced(folder.file("replaced"));
  std::filesystem::remove(folder.file("removed"));
  folder.write("other", "text");
  std::filesystem::rename(folder.file("other"), folder.file("replaced"));
  EXPECT_THROW(removed.close(), Error);
  EXPECT_THROW(replaced.close(), Error);
}

TEST(GrowingFile, CannotBeMadeInAFolderThatIsNotThere) {
  try {
    GrowingFile file("/nowhere/at/all");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(6, error.exit_code());
    EXPECT_NE(std::string::npos, error.message().find("/nowhere/at/all"));
  }
}

TEST(NumberText, IsTheShortestThatReadsBack) {
  EXPECT_EQ("0.1", number_text(0.1));
  EXPECT_EQ("2e-06", number_text(2e-6));
  EXPECT_EQ("1", number_text(1.0));
  EXPECT_EQ("0.30000000000000004", number_text(0.1 + 0.2));
  EXPECT_EQ("", number_text(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace freeplay
