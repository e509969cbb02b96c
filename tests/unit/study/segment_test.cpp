#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "study/row_text.h"
#include "study/segment_reader.h"
#include "study/segment_writer.h"
#include "unit/scratch_folder.h"

namespace freeplay {
namespace {

const SegmentHeader second_shard{std::string(64, 'a'),  "0.1.0/b", "0123456789abcdef", {2, 3}, "host",
                                 "2026-01-01T00:00:00Z"};
const RowLayout layout{{{"force", "N"}, {"mean", "m"}}, {"section"}, false};

std::string lines_of(std::uint64_t index, double force) {
  StudyOutcome outcome;
  outcome.values = {force, std::numeric_limits<double>::quiet_NaN()};
  outcome.samples = {{{0.5, 1.5}, {1.0, -2.0}}};
  std::string lines;
  append_point(lines, index, std::string(24, 'c'), outcome, layout);
  return lines;
}

std::string failed_lines(std::uint64_t index) {
  std::string lines;
  append_point(lines, index, std::string(24, 'c'), {.exit_code = 3, .error = "out-of-range", .message = "two\nlines"},
               layout);
  return lines;
}

/// Indices of the rows of a segment with this text, and the numbers of its damaged lines.
struct Read {
  std::vector<std::uint64_t> rows;
  std::vector<std::size_t> damaged;
};

Read read_segment_text(const std::string& text) {
  const ScratchFolder folder;
  folder.write("a.rows", text);
  Read result;
  SegmentReader reader(folder.file("a.rows"),
                       [&](const std::filesystem::path&, std::size_t line) { result.damaged.push_back(line); });
  while (const SegmentRow* row = reader.next(layout)) result.rows.push_back(row->index);
  return result;
}

using Numbers = std::vector<std::uint64_t>;
using Lines = std::vector<std::size_t>;

TEST(Segment, ChecksumIsThatOfZlib) {
  EXPECT_EQ(0xcbf43926u, row_checksum("123456789"));  // the check value of CRC-32
}

TEST(Segment, RowIsThatOfTheContract) {
  const std::string lines = lines_of(7, 1.25), samples = "+7\tsection\t0.5:1.5\t1:-2\t";
  ASSERT_TRUE(lines.starts_with(samples)) << lines;
  const std::string row = lines.substr(lines.find('\n') + 1);
  const std::string fields = "7\t" + std::string(24, 'c') + "\t0\t\t0\t0\t0\t1.25\t\t";
  ASSERT_TRUE(row.starts_with(fields)) << row;
  EXPECT_EQ(fields, unsealed(std::string_view(row).substr(0, row.size() - 1)));
}

TEST(Segment, WhatIsWrittenIsReadBack) {
  const ScratchFolder folder;
  SegmentWriter writer(folder.path(), second_shard, 1.0);
  writer.put(lines_of(3, 1e-300));
  writer.put(failed_lines(4));
  writer.close();
  std::filesystem::path segment;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) segment = entry.path();
  EXPECT_TRUE(segment.filename().string().starts_with("2-of-3.host.")) << segment;
  SegmentReader reader(segment, [](const auto&, std::size_t line) { ADD_FAILURE() << "line " << line; });
  ASSERT_TRUE(reader.header());
  EXPECT_EQ((Shard{2, 3}), reader.header()->shard);
  EXPECT_EQ(second_shard.study, reader.header()->study);
  const SegmentRow* row = reader.next(layout);
  ASSERT_NE(nullptr, row);
  EXPECT_EQ("1e-300\t", row->values);
  ASSERT_EQ(1u, row->samples.size());
  EXPECT_EQ("0.5:1.5\t1:-2", row->samples[0]);
  row = reader.next(layout);
  ASSERT_NE(nullptr, row);
  EXPECT_EQ("out-of-range", row->error);
  EXPECT_EQ("two lines", row->message);
  EXPECT_EQ(nullptr, reader.next(layout));
}

TEST(Segment, TornLastLineIsNoRowAndNoDamage) {
  const std::string text = second_shard.text() + lines_of(1, 1.0) + lines_of(2, 2.0);
  const std::size_t second = text.rfind("+2");
  for (std::size_t size = second_shard.text().size(); size < text.size(); ++size) {
    const Read result = read_segment_text(text.substr(0, size));
    EXPECT_EQ(size >= second ? Numbers{1} : Numbers{}, result.rows) << size;
    EXPECT_TRUE(result.damaged.empty()) << size;
  }
}

TEST(Segment, EveryFlippedBitCostsOnePointAndIsSaid) {
  const std::string text = second_shard.text() + lines_of(1, 1.0) + lines_of(2, 2.0) + lines_of(3, 3.0);
  const std::size_t from = text.find("\n+2") + 1, row = text.find("\n2\t") + 1, end = text.find("\n+3");
  for (std::size_t at = from; at < end; ++at) {
    std::string changed = text;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    if (changed[at] == '\n' || text[at] == '\n') continue;
    const Read result = read_segment_text(changed);
    EXPECT_EQ((Numbers{1, 3}), result.rows) << at;
    EXPECT_EQ(at < row ? Lines{4} : Lines{5}, result.damaged) << at;
  }
}

TEST(Segment, RowWithoutItsSamplesIsNone) {
  const std::string whole = lines_of(1, 1.0), bare = whole.substr(whole.find('\n') + 1);
  const Read result = read_segment_text(second_shard.text() + bare + lines_of(2, 2.0));
  EXPECT_EQ((Numbers{2}), result.rows);
  EXPECT_EQ((Lines{2}), result.damaged);
}

TEST(Segment, ForeignFileHasNoRows) {
  EXPECT_EQ((Lines{1}), read_segment_text("hello\n" + lines_of(1, 1.0)).damaged);
  EXPECT_TRUE(read_segment_text("hello\n" + lines_of(1, 1.0)).rows.empty());
  EXPECT_TRUE(read_segment_text("").damaged.empty());
}

TEST(Segment, LinesLongerThanTheBufferAreRead) {
  StudyOutcome outcome;
  outcome.values = {1.0, 2.0};
  outcome.samples.resize(1);
  for (int k = 0; k < 300'000; ++k) outcome.samples[0].emplace_back(k, 0.1 * k);
  std::string lines;
  append_point(lines, 1, std::string(24, 'c'), outcome, layout);
  EXPECT_EQ((Numbers{1, 2, 1}), read_segment_text(second_shard.text() + lines + lines_of(2, 1.0) + lines).rows);
}

TEST(Segment, NoSpaceIsAnErrorThatNamesTheFile) {
  const ScratchFolder folder;
  SegmentWriter writer(folder.path() / "missing", second_shard, 1.0);
  EXPECT_THROW(writer.put(lines_of(1, 1.0)), Error);
}

TEST(Segment, ShardsMeetWhereTheyShareAUnit) {
  for (std::uint64_t n = 1; n <= 6; ++n) {
    for (std::uint64_t m = 1; m <= 6; ++m) {
      for (std::uint64_t i = 1; i <= n; ++i) {
        for (std::uint64_t j = 1; j <= m; ++j) {
          bool share = false;
          for (std::uint64_t unit = 0; unit < n * m; ++unit) share |= Shard{i, n}.has(unit) && Shard{j, m}.has(unit);
          EXPECT_EQ(share, (Shard{i, n}.meets({j, m}))) << i << '/' << n << ' ' << j << '/' << m;
        }
      }
    }
  }
}

}  // namespace
}  // namespace freeplay
