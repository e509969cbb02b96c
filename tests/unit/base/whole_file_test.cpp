#include "base/whole_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "unit/scratch_folder.h"

namespace freeplay {
namespace {

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(WholeFile, ReplacesAFileAndMakesItsFolder) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder.path() / "new" / "a.txt";
  write_whole_file(path, "first, longer");
  write_whole_file(path, "second");
  EXPECT_EQ(content(path), "second");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path.parent_path()), {}), 1);
}

TEST(WholeFile, WritesIntoAPipeThatStays) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = content(path); });
  write_whole_file(path, "text\n");
  reader.join();
  EXPECT_EQ(read, "text\n");
  EXPECT_TRUE(std::filesystem::is_fifo(path));
}

TEST(WholeFile, FollowsALinkThatStays) {
  const ScratchFolder folder;
  const std::filesystem::path target = folder.path() / "target", link = folder.path() / "link";
  write_whole_file(target, "old");
  std::filesystem::create_symlink("target", link);
  write_whole_file(link, "new");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(content(target), "new");
}

}  // namespace
}  // namespace freeplay
