#include "results/directory.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "base/error.h"
#include "base/sha256.h"
#include "unit/scratch_folder.h"

namespace freeplay {
namespace {

TEST(ResultName, ReplacesWhatAFolderShouldNotBeCalled) {
  EXPECT_EQ("3-rrr_v1.2", result_name("3-rrr_v1.2", false));
  EXPECT_EQ("__a_b_c", result_name("..a b/c", false));
  EXPECT_EQ("_ber", result_name("\xc3\xbc"
                                "ber",
                                false));
  EXPECT_EQ("rod-ideal", result_name("rod", true));
}

TEST(ResultDirectory, RemovesAnEarlierResultAndNothingElse) {
  const ScratchFolder folder;
  folder.write("summary.json", R"({"freeplay": {"version": "0", "schema": 1}})");
  folder.write("results.csv", "old");
  folder.write("notes.txt", "mine");
  const ResultDirectory directory(folder.path(), false);
  EXPECT_EQ((std::vector<std::string>{"notes.txt", "run.log"}), directory.files());
}

TEST(ResultDirectory, RefusesOtherContentUnlessForced) {
  const ScratchFolder folder;
  folder.write("notes.txt", "mine");
  EXPECT_THROW(check_result_directory(folder.path(), false), Error);
  EXPECT_NO_THROW(check_result_directory(folder.path(), true));
  EXPECT_NO_THROW(check_result_directory(folder.file("not/there/yet"), false));
}

TEST(ResultDirectory, IsFreeWhereARunWasEndedBeforeItHadRows) {
  const ScratchFolder folder;
  const auto refused = [&] {
    try {
      check_result_directory(folder.path(), false);
    } catch (const Error& error) {
      return error.message();
    }
    return std::string();
  };
  folder.write("run.log", "");
  folder.write("model.yaml", "freeplay: 1\n");
  folder.write(".results.h5.part", "some");
  folder.write("events.csv", "");
  folder.write("results.csv", "");
  EXPECT_EQ("", refused());
  folder.write("results.csv", "time,a\n");
  EXPECT_EQ("", refused());
  folder.write("results.csv", "time,a\n0,1\n");
  EXPECT_NE(std::string::npos, refused().find("a run that did not end"));
  folder.write("results.csv", "time,a\n");
  folder.write("results.h5", "no longer to be read");
  EXPECT_NE(std::string::npos, refused().find("a run that did not end"));
  folder.write("results.h5", "");
  std::filesystem::create_directory(folder.file("twin"));
  folder.write("twin/results.csv", "time,a\n0,1\n");
  EXPECT_NE(std::string::npos, refused().find("a run that did not end"));
}

TEST(ResultDirectory, WritesNothingIntoAnotherInItsPlace) {
  const ScratchFolder folder;
  const ResultDirectory directory(folder.file("a"), false);
  EXPECT_TRUE(directory.there());
  std::filesystem::rename(folder.file("a"), folder.file("b"));
  EXPECT_FALSE(directory.there());
  EXPECT_THROW(directory.write("summary.json", "text"), Error);
  EXPECT_FALSE(std::filesystem::exists(folder.file("a")));
  const ResultDirectory other(folder.file("a"), false);
  EXPECT_FALSE(directory.there());
  EXPECT_THROW(directory.write("summary.json", "text"), Error);
  EXPECT_EQ((std::vector<std::string>{"run.log"}), other.files());
}

TEST(ResultDirectory, WritesWholeFiles) {
  const ScratchFolder folder;
  const ResultDirectory directory(folder.file("a/b"), false);
  directory.write("summary.json", "text");
  EXPECT_EQ("text", folder.read("a/b/summary.json"));
  EXPECT_EQ((std::vector<std::string>{"run.log", "summary.json"}), directory.files());
}

TEST(ResultDirectory, WritesIntoAFolderOfItsOwn) {
  const ScratchFolder folder;
  const ResultDirectory directory(folder.file("a"), false);
  directory.write("inputs/motor.csv", "t,x");
  EXPECT_EQ("t,x", folder.read("a/inputs/motor.csv"));
  EXPECT_EQ((std::vector<std::string>{"inputs", "run.log"}), directory.files());
}

TEST(ResultDirectory, BelongsToOneAtATime) {
  const ScratchFolder folder;
  folder.write("run.log", "old\n");
  const auto refused = [&](bool force) {
    try {
      check_result_directory(folder.path(), force);
    } catch (const Error& error) {
      EXPECT_EQ("result-in-use", error.id());
      EXPECT_NE(std::string::npos, error.message().find("process " + std::to_string(::getpid()))) << error.message();
      return true;
    }
    return false;
  };
  {
    const ResultDirectory first(folder.path(), true);
    EXPECT_TRUE(first.guarded());
    EXPECT_TRUE(refused(false));
    EXPECT_TRUE(refused(true));
    EXPECT_THROW(ResultDirectory(folder.path(), true), Error);
    EXPECT_EQ("old\n", folder.read("run.log"));
  }
  EXPECT_FALSE(refused(true));
}

// FIPS 180-2, appendix B.1.
TEST(Sha256, OfAbc) { EXPECT_EQ("ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad", sha256("abc")); }

}  // namespace
}  // namespace freeplay
