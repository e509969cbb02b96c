#include "results/kept_part.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>

#include "base/error.h"
#include "results/reader.h"
#include "results/record_thread.h"
#include "results/text_writers.h"
#include "unit/scratch_folder.h"

namespace freeplay {
namespace {

using testing::HasSubstr;

constexpr double unset = std::numeric_limits<double>::quiet_NaN();

RecordLayout two_columns() {
  RecordLayout layout;
  layout.columns = {{"time", "s", "time", "grid"}, {"joint.pin.fn", "N", "normal force", "a law"}};
  layout.events = {{"time", "s", "time", "events"},
                   {"joint", "1", "joint", "events"},
                   {"kind", "1", "kind", "events"},
                   {"speed", "m/s", "speed", "events"}};
  layout.joints = {"pin", "slide"};
  layout.kinds = {"contact_begin", "contact_end"};
  return layout;
}

/// Rows first ... last - 1, an event after every fifth.
RecordBuffer part_of_run(int first, int last) {
  RecordBuffer block;
  for (int i = first; i < last; ++i) {
    const double x = i;
    block.rows.insert(block.rows.end(), {0.1 * x, i % 7 == 3 ? unset : std::sin(x)});
    if (i % 5 == 0) block.events.insert(block.events.end(), {0.1 * x, i % 2 * 1.0, 0.0, i % 10 == 0 ? unset : x / 3.0});
  }
  return block;
}

/// Files of a run of so many rows.
struct RunFiles {
  RunFiles(const ScratchFolder& folder, const RecordLayout& layout, int rows)
      : row_text(folder.file("results.csv"), layout),
        event_text(folder.file("events.csv"), layout),
        hdf5(folder.file("results.h5"), layout, {.expected_rows = 100}) {
    const RecordBuffer block = part_of_run(0, rows);
    for (RecordWriter* writer : {static_cast<RecordWriter*>(&row_text), static_cast<RecordWriter*>(&event_text),
                                 static_cast<RecordWriter*>(&hdf5), static_cast<RecordWriter*>(&row_hash)}) {
      writer->write(block);
      writer->close();
    }
    hdf5.finish({}, "{}");
  }
  RowTextWriter row_text;
  EventTextWriter event_text;
  Hdf5Writer hdf5;
  RowHash row_hash;
};

/// So many rows and events of it as a checkpoint counts them.
KeptPart counted(std::int64_t rows, std::int64_t events, const RecordLayout& layout) {
  const ScratchFolder folder;
  const RecordBuffer all = part_of_run(0, 200);
  RowHash row_hash;
  EventTextWriter event_text(folder.file("events.csv"), layout);
  row_hash.write({.rows = std::span(all.rows).first(2 * static_cast<std::size_t>(rows)), .events = {}});
  event_text.write({.rows = {}, .events = std::span(all.events).first(4 * static_cast<std::size_t>(events))});
  return {.rows = rows, .events = events, .row_digits = row_hash.digits(), .event_digits = event_text.digits()};
}

std::vector<double> numbers(ResultReader& reader, bool of_events) {
  std::vector<double> all;
  const auto take = [&](std::span<const double> some) { all.insert(all.end(), some.begin(), some.end()); };
  const std::size_t columns[] = {0, 1};
  of_events ? reader.events(take) : reader.rows(columns, {}, take);
  for (double& number : all) {
    if (std::isnan(number)) number = -1e300;
  }
  return all;
}

/// What read_kept() says of files that do not fit their checkpoint.
std::string refusal_of_kept(const std::filesystem::path& folder, const KeptPart& part, ResultFormat format,
                            const RecordLayout& layout) {
  try {
    read_kept(folder, part, format, layout, {});
  } catch (const Error& error) {
    EXPECT_EQ("bad-checkpoint", error.id());
    return error.message();
  }
  return "not refused";
}

TEST(KeptPart, OfARunThatGoesOnGivesTheFilesOfOneThatNeverStopped) {
  const ScratchFolder folder, whole_folder;
  const RecordLayout layout = two_columns();
  RunFiles(folder, layout, 140);
  folder.write("run.log", "");
  const RunFiles whole(whole_folder, layout, 200);
  {
    KeptFiles kept =
        read_kept(folder.path(), counted(83, 17, layout), ResultFormat::both, layout, {.expected_rows = 100});
    EXPECT_EQ(83, kept.text_rows.count);
    EXPECT_EQ(0.1 * 82.0, kept.text_rows.last_time);
    cut_back(folder.path(), kept, ResultFormat::both);
    RowTextWriter rows(folder.file("results.csv"), layout, kept.text_rows);
    EventTextWriter events(folder.file("events.csv"), layout, kept.event_text);
    const RecordBuffer block = part_of_run(83, 200);
    for (RecordWriter* writer :
         {static_cast<RecordWriter*>(&rows), static_cast<RecordWriter*>(&events),
          static_cast<RecordWriter*>(kept.hdf5.get()), static_cast<RecordWriter*>(kept.row_hash.get())}) {
      writer->write(block);
      writer->look_after();
      writer->close();
      EXPECT_EQ("", writer->failure());
    }
    kept.hdf5->finish({}, "{}");
    EXPECT_EQ("", kept.hdf5->failure());
    EXPECT_EQ(whole.row_hash.digits(), kept.row_hash->digits());
    EXPECT_EQ(whole.event_text.digits(), events.digits());
  }
  EXPECT_EQ(whole_folder.read("results.csv"), folder.read("results.csv"));
  EXPECT_EQ(whole_folder.read("events.csv"), folder.read("events.csv"));
  const auto there = ResultReader::open(folder.file("results.h5"));
  const auto reference = ResultReader::open(whole_folder.file("results.h5"));
  for (const bool of_events : {false, true}) EXPECT_EQ(numbers(*reference, of_events), numbers(*there, of_events));
  EXPECT_FALSE(std::filesystem::exists(folder.file(".results.h5.part")));
}

TEST(KeptPart, OfTextAloneHasTheSameHashOfRows) {
  const ScratchFolder folder;
  const RecordLayout layout = two_columns();
  RunFiles(folder, layout, 60);
  const KeptPart part = counted(60, 12, layout);
  const KeptFiles text = read_kept(folder.path(), part, ResultFormat::csv, layout, {});
  const KeptFiles both = read_kept(folder.path(), part, ResultFormat::both, layout, {});
  EXPECT_EQ(both.row_hash->digits(), text.row_hash->digits());
  EXPECT_EQ(nullptr, text.hdf5);
}

TEST(KeptPart, RefusesFilesThatHoldLessAndLeavesThemAsTheyAre) {
  const ScratchFolder folder;
  const RecordLayout layout = two_columns();
  RunFiles(folder, layout, 60);
  std::filesystem::resize_file(folder.file("events.csv"), std::filesystem::file_size(folder.file("events.csv")) - 3);
  const auto before = folder.read("results.csv") + folder.read("events.csv") + folder.read("results.h5");
  const auto refused = [&](const KeptPart& part, ResultFormat format) {
    return refusal_of_kept(folder.path(), part, format, layout);
  };
  EXPECT_THAT(refused(counted(60, 12, layout), ResultFormat::both),
              HasSubstr("events.csv' does not fit its checkpoint: it holds 11 events, the checkpoint counts 12"));
  EXPECT_THAT(refused(counted(61, 5, layout), ResultFormat::csv),
              HasSubstr("it holds 60 rows, the checkpoint counts 61"));
  EXPECT_THAT(refused(counted(61, 5, layout), ResultFormat::hdf5), HasSubstr("results.h5' does not fit"));
  EXPECT_EQ(before, folder.read("results.csv") + folder.read("events.csv") + folder.read("results.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder.file(".results.h5.part")));
}

TEST(KeptPart, RefusesRowsAndEventsThatAreNotThoseOfTheCheckpoint) {
  const RecordLayout layout = two_columns();
  const KeptPart part = counted(60, 12, layout);
  const auto refused = [&](const ScratchFolder& folder, ResultFormat format) {
    return refusal_of_kept(folder.path(), part, format, layout);
  };
  const auto edited = [&](const char* name, const std::string& from, const std::string& to, ResultFormat format) {
    const ScratchFolder folder;
    RunFiles(folder, layout, 60);
    EXPECT_EQ("not refused", refused(folder, format));
    std::string text = folder.read(name);
    const std::size_t at = text.rfind(from);
    EXPECT_NE(std::string::npos, at) << from;
    folder.write(name, text.replace(at, from.size(), to));
    return refused(folder, format);
  };
  EXPECT_THAT(edited("results.csv", "\n1,", "\n1.01,", ResultFormat::both),
              HasSubstr("results.csv' was changed: its rows"));
  EXPECT_THAT(edited("results.csv", "\n1,", "\n1.0,", ResultFormat::csv), HasSubstr("results.csv' was changed"));
  EXPECT_THAT(edited("events.csv", "slide", "pin", ResultFormat::hdf5),
              HasSubstr("events.csv' was changed: its events"));
  const auto other_hdf5 = [&](const RecordBuffer& other) {
    const ScratchFolder folder;
    RunFiles(folder, layout, 60);
    Hdf5Writer hdf5(folder.file("results.h5"), layout, {.expected_rows = 100});
    hdf5.write(other);
    hdf5.finish({}, "{}");
    return refused(folder, ResultFormat::both);
  };
  RecordBuffer other = part_of_run(0, 60);
  EXPECT_EQ("not refused", other_hdf5(other));
  other.rows[23] += 1e-15;
  EXPECT_THAT(other_hdf5(other), HasSubstr("results.h5' was changed: its rows"));
  for (const auto& [place, value] : {std::pair(4, 0.25), {5, 0.0}, {5, 7.0}, {6, -1.0}}) {
    other = part_of_run(0, 60);
    other.events[static_cast<std::size_t>(place)] = value;
    EXPECT_THAT(other_hdf5(other), HasSubstr("results.h5' was changed: its events"));
  }
}

}  // namespace
}  // namespace freeplay
