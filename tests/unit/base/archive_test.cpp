#include "base/archive.h"

#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"

namespace freeplay {
namespace {

enum class Colour { red, green };

struct ArchivedPart {
  double x = 0.0;
  int n = 0;
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.x, self.n);
  }
};

struct Whole {
  double number = 0.0;
  bool flag = false;
  Colour colour = Colour::red;
  std::uint64_t bits = 0;
  std::vector<double> fixed{0.0, 0.0};
  std::vector<ArchivedPart> parts{{}, {}}, list{};
  std::array<char, 2> letters{};
  double plain[2] = {};
  std::optional<ArchivedPart> there, missing;
  std::string text;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.number, self.flag, self.colour, self.bits, self.fixed, self.parts, self.letters, self.plain);
    archive(self.there, self.missing, self.text);
    archive.list(self.list);
  }
};

Whole some_whole() {
  Whole out;
  out.number = -0.0;
  out.flag = true;
  out.colour = Colour::green;
  out.bits = ~std::uint64_t{0};
  out.fixed = {std::numeric_limits<double>::quiet_NaN(), 2.0};
  out.parts = {{1.5, -3}, {2.5, 4}};
  out.list = {{7.0, 8}};
  out.letters = {'a', '\0'};
  out.plain[1] = 9.0;
  out.there = ArchivedPart{3.0, 1};
  out.text = "words";
  return out;
}

Archive written(const Whole& whole) {
  Archive out;
  ArchiveWriter write(out);
  write(whole);
  return out;
}

TEST(Archive, GivesBackWhatWasWritten) {
  const Archive first = written(some_whole());
  Whole copy;
  copy.missing = ArchivedPart{};
  copy.list = {{}, {}, {}};
  ArchiveReader read(first);
  read(copy);
  read.finish();
  EXPECT_TRUE(written(copy) == first);
  EXPECT_FALSE(copy.missing.has_value());
  EXPECT_EQ(copy.list.size(), 1u);
  EXPECT_EQ(copy.text, "words");
}

TEST(Archive, IsRefusedByAListOfAnotherLength) {
  const Archive archive = written(some_whole());
  Whole other;
  other.fixed.push_back(0.0);
  ArchiveReader read(archive);
  EXPECT_THROW(read(other), Error);
}

TEST(Archive, IsRefusedWhereNumbersAreMissingOrLeft) {
  const Archive archive = written(some_whole());
  for (const bool of_reals : {true, false}) {
    Archive shorter = archive;
    of_reals ? shorter.reals.pop_back() : shorter.integers.pop_back();
    Whole copy;
    ArchiveReader read(shorter);
    EXPECT_THROW(read(copy), Error);
  }
  Archive longer = archive;
  longer.reals.push_back(0.0);
  Whole copy;
  ArchiveReader read(longer);
  read(copy);
  EXPECT_THROW(read.finish(), Error);
}

TEST(Archive, DoesNotMakeRoomForAListThatCannotBeThere) {
  Archive archive;
  archive.integers.push_back(std::numeric_limits<std::int64_t>::max());
  std::vector<double> list;
  ArchiveReader read(archive);
  EXPECT_THROW(read.list(list), Error);
}

TEST(Archive, TellsZeroFromMinusZero) { EXPECT_FALSE((Archive{{0.0}, {}}) == (Archive{{-0.0}, {}})); }

}  // namespace
}  // namespace freeplay
