#include "results/reader.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "results/hdf5_writer.h"
#include "results/text_writers.h"
#include "unit/scratch_folder.h"

namespace freeplay {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

RecordLayout small_layout() {
  RecordLayout layout;
  layout.columns = {{"time", "s", "time", "grid"},
                    {"joint.pin.fn", "N", "normal force", "a law"},
                    {"frame.rod/tip.x", "m", "position x", "equations of motion"}};
  layout.events = {{"time", "s", "time", "events"},
                   {"joint", "1", "joint", "events"},
                   {"kind", "1", "kind", "events"},
                   {"speed", "m/s", "speed", "events"}};
  layout.joints = {"pin", "slide"};
  layout.kinds = {"contact_begin", "contact_end"};
  layout.bearings = {"pin"};
  layout.attributes = {{"title", "small"}, {"model", "text of the model"}};
  return layout;
}

RecordBuffer some_rows(std::size_t first, std::size_t count) {
  RecordBuffer block;
  for (std::size_t i = first; i < first + count; ++i) {
    const double x = static_cast<double>(i);
    block.rows.insert(block.rows.end(), {0.1 * x, i % 7 == 3 ? no_number : std::sin(x), -x / 3.0});
  }
  return block;
}

std::vector<std::size_t> all_columns(const ResultReader& reader) {
  std::vector<std::size_t> columns(reader.layout().columns.size());
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  return columns;
}

std::vector<double> rows_of(ResultReader& reader, const RowWindow& window = {}) {
  std::vector<double> rows;
  reader.rows(all_columns(reader), window,
              [&](std::span<const double> some) { rows.insert(rows.end(), some.begin(), some.end()); });
  return rows;
}

std::vector<double> events_of(ResultReader& reader) {
  std::vector<double> events;
  reader.events([&](std::span<const double> some) { events.insert(events.end(), some.begin(), some.end()); });
  return events;
}

std::vector<std::uint64_t> bits(const std::vector<double>& numbers) {
  std::vector<std::uint64_t> bits;
  for (const double number : numbers) bits.push_back(std::bit_cast<std::uint64_t>(number));
  return bits;
}

std::vector<double> times(ResultReader& reader, const RowWindow& window) {
  std::vector<double> times;
  const std::size_t column[] = {0};
  reader.rows(column, window,
              [&](std::span<const double> some) { times.insert(times.end(), some.begin(), some.end()); });
  return times;
}

TEST(Hdf5Result, GivesBackEveryBitOverSeveralChunks) {
  const ScratchFolder folder;
  const RecordLayout layout = small_layout();
  const RecordBuffer rows = some_rows(0, 300);
  Hdf5Writer writer(folder.file("results.h5"), layout, {.expected_rows = 10});
  writer.write(some_rows(0, 70));
  writer.flush();
  writer.write(some_rows(70, 230));
  writer.finish({}, "{}");
  ASSERT_EQ("", writer.failure());
  const auto reader = ResultReader::open(folder.file("results.h5"));
  EXPECT_EQ(bits(rows.rows), bits(rows_of(*reader)));
}

TEST(Hdf5Result, GivesBackNamesUnitsWordsAndAttributes) {
  const ScratchFolder folder;
  const RecordLayout layout = small_layout();
  Hdf5Writer writer(folder.file("results.h5"), layout, {});
  writer.write(RecordBuffer{.rows = {0.0, 1.0, 2.0}, .events = {0.25, 1.0, 0.0, no_number, 0.5, 0.0, 1.0, 3.0}});
  writer.finish({}, "{}");
  const auto reader = ResultReader::open(folder.path());
  const RecordLayout& read = reader->layout();
  ASSERT_EQ(3U, read.columns.size());
  EXPECT_EQ("frame.rod/tip.x", read.columns[2].name);
  EXPECT_EQ("N", read.columns[1].unit);
  EXPECT_EQ("a law", read.columns[1].source);
  EXPECT_EQ(layout.attributes, read.attributes);
  EXPECT_EQ(bits({0.25, 1.0, 0.0, no_number, 0.5, 0.0, 1.0, 3.0}), bits(events_of(*reader)));
  EXPECT_EQ(layout.joints, read.joints);
  EXPECT_EQ(layout.kinds, read.kinds);
}

TEST(Hdf5Result, CanBeReadWhileItGrows) {
  const ScratchFolder folder;
  const RecordLayout layout = small_layout();
  Hdf5Writer writer(folder.file("results.h5"), layout, {});
  writer.write(some_rows(0, 5));
  writer.flush();
  writer.write(some_rows(5, 5));
  EXPECT_EQ(15U, rows_of(*ResultReader::open(folder.file("results.h5"))).size());
  writer.flush();
  EXPECT_EQ(30U, rows_of(*ResultReader::open(folder.file("results.h5"))).size());
}

TEST(Hdf5Result, KeepsFlushedRowsOfAWriterThatDied) {
  const ScratchFolder folder;
  const RecordLayout layout = small_layout();
  const pid_t child = ::fork();
  if (child == 0) {
    Hdf5Writer writer(folder.file("results.h5"), layout, {});
    writer.write(some_rows(0, 77));
    writer.flush();
    writer.write(some_rows(77, 5));
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(bits(some_rows(0, 77).rows), bits(rows_of(*ResultReader::open(folder.file("results.h5")))));
}

TEST(Hdf5Result, OfADamagedFileIsReadOrRefused) {
  const ScratchFolder folder;
  const RecordLayout layout = small_layout();
  Hdf5Writer growing(folder.file("growing.h5"), layout, {}),
      whole(folder.file("whole.h5"), layout, {.expected_rows = 100, .grows = false});
  for (Hdf5Writer* writer : {&growing, &whole}) {
    writer->write(some_rows(0, 100));
    writer->finish({}, "{}");
  }
  std::mt19937 random(1);
  int read = 0, refused = 0;
  for (const char* name : {"growing.h5", "whole.h5"}) {
    const std::string bytes = folder.read(name);
    for (int i = 0; i < 100; ++i) {
      std::string damaged = bytes;
      for (int left = i % 3 == 0 ? 1 : 30; left > 0; --left) {
        damaged[random() % damaged.size()] ^= static_cast<char>(1U << random() % 8);
      }
      folder.write("damaged.h5", damaged);
      try {
        const auto reader = ResultReader::open(folder.file("damaged.h5"));
        rows_of(*reader);
        events_of(*reader);
        reader->summary();
        ++read;
      } catch (const Error& error) {
        EXPECT_EQ("unreadable-result", error.id());
        EXPECT_THAT(error.message(), HasSubstr("damaged.h5' cannot be read: "));
        ++refused;
      }
    }
  }
  EXPECT_GT(read, 5);
  EXPECT_GT(refused, 50);
}

TEST(Hdf5Result, KeepsBearingTables) {
  const ScratchFolder folder;
  const RecordLayout layout = small_layout();
  Hdf5Writer writer(folder.file("results.h5"), layout, {});
  BearingTables tables;
  for (const BearingQuantity& quantity : bearing_quantities()) tables[quantity.name].assign(bearing_sectors, 1.5);
  writer.finish(tables, "{}");
  EXPECT_EQ("", writer.failure());
}

TEST(Hdf5Result, SaysWhyItCannotBeWritten) {
  const ScratchFolder folder;
  const RecordLayout layout = small_layout();
  Hdf5Writer writer(folder.file("missing/results.h5"), layout, {});
  writer.flush();
  EXPECT_THAT(writer.failure(), HasSubstr("results.h5': No such file or directory"));
}

TEST(CsvResult, LeavesAnIncompleteLastLineOut) {
  const ScratchFolder folder;
  folder.write("results.csv", "time,a\n0,1\n0.5,\n1,2");
  const auto reader = ResultReader::open(folder.path());
  EXPECT_EQ(bits({0.0, 1.0, 0.5, no_number}), bits(rows_of(*reader)));
}

TEST(CsvResult, IsWhatTheTextWriterWrote) {
  const ScratchFolder folder;
  const RecordLayout layout = small_layout();
  RowTextWriter rows(folder.file("results.csv"), layout);
  EventTextWriter events(folder.file("events.csv"), layout);
  const RecordBuffer block{.rows = some_rows(0, 20).rows, .events = {0.25, 1.0, 0.0, no_number, 0.5, 0.0, 1.0, 3.0}};
  rows.write(block);
  events.write(block);
  rows.close();
  events.close();
  const auto reader = ResultReader::open(folder.path());
  EXPECT_EQ(bits(block.rows), bits(rows_of(*reader)));
  ASSERT_EQ(8U, events_of(*reader).size());
  EXPECT_THAT(reader->layout().joints, ElementsAre("slide", "pin"));  // in the order of their events
}

TEST(CsvResult, RefusesWhatIsNoTable) {
  const ScratchFolder folder;
  folder.write("words.csv", "time,a\n0,1\n1,one\n");
  folder.write("short.csv", "time,a\n0\n");
  folder.write("back.csv", "time,a\n1,0\n0,0\n");
  folder.write("other.csv", "t,a\n0,1\n");
  const auto why = [&](const char* name) -> std::string {
    try {
      rows_of(*ResultReader::open(folder.file(name)));
    } catch (const Error& error) {
      return error.message();
    }
    return "";
  };
  EXPECT_THAT(why("words.csv"), HasSubstr("line 3: 'one' is not a number"));
  EXPECT_THAT(why("short.csv"), HasSubstr("line 2 has 1 field, the header 2"));
  EXPECT_THAT(why("back.csv"), HasSubstr("line 3: time does not grow"));
  EXPECT_THAT(why("other.csv"), HasSubstr("its first column is not 'time'"));
  EXPECT_THAT(why("none.csv"), HasSubstr("there is no such file"));
}

TEST(RowWindow, PicksRowsByTimeAndNumber) {
  const ScratchFolder folder;
  folder.write("a.csv", "time\n0\n0.1\n0.2\n0.30000000001\n0.4\n0.5\n");
  const auto reader = ResultReader::open(folder.file("a.csv"));
  EXPECT_THAT(times(*reader, {.from = 0.1, .until = 0.3}), ElementsAre(0.1, 0.2, 0.30000000001));
  EXPECT_THAT(times(*reader, {.from = 0.1, .every = 2}), ElementsAre(0.1, 0.30000000001, 0.5));
  EXPECT_THAT(times(*reader, {.until = -1.0}), ElementsAre());
  folder.write("one.csv", "time\n0.5\n");
  EXPECT_THAT(times(*ResultReader::open(folder.file("one.csv")), {}), ElementsAre(0.5));
}

}  // namespace
}  // namespace freeplay
