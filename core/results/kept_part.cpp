#include "results/kept_part.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "base/number_text.h"
#include "results/reader.h"
#include "results/text_writers.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& what) {
  throw Error(Error::Category::file, "bad-checkpoint",
              fmt::format("'{}' does not fit its checkpoint: {}", file.string(), what), {}, "run the model again");
}

void require_enough(const fs::path& file, const char* things, std::int64_t there, std::int64_t kept) {
  if (there < kept) refuse(file, fmt::format("it holds {} {}, the checkpoint counts {}", there, things, kept));
}

void require_columns(const fs::path& file, const RecordLayout& there, const RecordLayout& layout) {
  if (!std::ranges::equal(there.columns, layout.columns, {}, &RecordColumn::name, &RecordColumn::name)) {
    refuse(file, "it has other columns");
  }
}

/// The first rows of a result, in blocks; gives how many there are.
template <class Take>
std::int64_t first_rows(ResultReader& reader, std::int64_t count, Take&& take) {
  const std::size_t width = reader.layout().columns.size();
  std::vector<std::size_t> all(width);
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::int64_t given = 0;
  reader.rows(all, {}, [&](std::span<const double> rows) {
    const auto some = std::min<std::int64_t>(count - given, static_cast<std::int64_t>(rows.size() / width));
    if (some > 0) take(rows.first(static_cast<std::size_t>(some) * width));
    given += some;
  });
  return given;
}

template <class Take>
std::int64_t first_events(ResultReader& reader, std::int64_t count, Take&& take) {
  const std::size_t width = reader.layout().events.size();
  std::int64_t given = 0;
  if (width == 0) return given;
  reader.events([&](std::span<const double> events) {
    const auto some = std::min<std::int64_t>(count - given, static_cast<std::int64_t>(events.size() / width));
    if (some > 0) take(events.first(static_cast<std::size_t>(some) * width));
    given += some;
  });
  return given;
}

void require_unchanged(const fs::path& file, const char* things, const std::string& there, const std::string& then) {
  if (there == then) return;
  throw Error(Error::Category::file, "bad-checkpoint",
              fmt::format("'{}' was changed: its {} are not those that the checkpoint counts", file.string(), things),
              {}, "run the model again");
}

/// Fingerprint of events as that of the text of events.csv.
class EventHash {
 public:
  explicit EventHash(const RecordLayout& layout) : layout_(layout) {
    line_ = text_header(layout.events);
    hash_.add(line_.data(), line_.size());
  }
  void add(std::span<const double> events) {
    for (std::size_t i = 0; i < events.size(); i += layout_.events.size()) {
      const std::span<const double> event = events.subspan(i, layout_.events.size());
      if (!(event[1] >= 0.0 && event[1] < static_cast<double>(layout_.joints.size())) ||
          !(event[2] >= 0.0 && event[2] < static_cast<double>(layout_.kinds.size()))) {
        continue;  // of no joint or kind: not an event that was written
      }
      line_.clear();
      EventTextWriter::append(line_, layout_, event);
      line_ += '\n';
      hash_.add(line_.data(), line_.size());
    }
  }
  std::string digits() const { return hash_.digits(); }

 private:
  const RecordLayout& layout_;
  std::string line_;
  Sha256 hash_;
};

/// Words of events are numbered as they come in a text, and as in the model in a file of this run.
void renumber(std::span<double> events, std::size_t width, std::size_t column, const std::vector<std::string>& from,
              const std::vector<std::string>& to) {
  if (from == to) return;
  for (std::size_t i = column; i < events.size(); i += width) {
    if (!(events[i] >= 0.0 && events[i] < static_cast<double>(from.size()))) continue;
    events[i] = static_cast<double>(std::ranges::find(to, from[static_cast<std::size_t>(events[i])]) - to.begin());
  }
}

void copy_rows(const fs::path& file, const KeptPart& part, const RecordLayout& layout, Hdf5Writer& copy,
               RowHash& row_hash) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) require_enough(file, "rows", 0, std::max<std::int64_t>(part.rows, 1));
  const auto reader = ResultReader::open(file);
  require_columns(file, reader->layout(), layout);
  if (reader->layout().events.size() != layout.events.size()) refuse(file, "it has other columns of events");
  EventHash event_hash(layout);
  const std::int64_t rows = first_rows(*reader, part.rows, [&](std::span<const double> some) {
    copy.write({.rows = some, .events = {}});
    row_hash.write({.rows = some, .events = {}});
  });
  std::vector<double> own;
  const std::int64_t events = first_events(*reader, part.events, [&](std::span<const double> some) {
    own.assign(some.begin(), some.end());
    renumber(own, layout.events.size(), 1, reader->layout().joints, layout.joints);
    renumber(own, layout.events.size(), 2, reader->layout().kinds, layout.kinds);
    copy.write({.rows = {}, .events = own});
    event_hash.add(own);
  });
  require_enough(file, "rows", rows, part.rows);
  require_enough(file, "events", events, part.events);
  require_unchanged(file, "rows", row_hash.digits(), part.row_digits);
  require_unchanged(file, "events", event_hash.digits(), part.event_digits);
  copy.flush();
  if (!copy.failure().empty()) throw Error(Error::Category::file, "cannot-write", copy.failure());
}

}  // namespace

WholeLines whole_lines(const fs::path& file, std::int64_t most, Sha256* hash) {
  WholeLines found;
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> piece(1 << 16);
  std::uintmax_t before = 0;
  std::string open;  // of a line that has not ended
  while (stream && !found.more) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const char *at = piece.data(), *const end = at + stream.gcount();
    while (at != end && found.lines < most) {
      const void* feed = std::memchr(at, '\n', static_cast<std::size_t>(end - at));
      if (feed == nullptr) break;
      const char* const next = static_cast<const char*>(feed) + 1;
      if (hash != nullptr) {
        hash->add(open.data(), open.size());
        hash->add(at, static_cast<std::size_t>(next - at));
      }
      open.clear();
      at = next;
      ++found.lines;
      found.bytes = before + static_cast<std::uintmax_t>(at - piece.data());
    }
    found.more = at != end && found.lines == most;
    if (hash != nullptr) open.append(at, end);
    before += static_cast<std::uintmax_t>(end - piece.data());
  }
  found.more = before > found.bytes;
  return found;
}

void cut_file(const fs::path& file, std::uintmax_t bytes) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  const bool good = descriptor >= 0 && ::ftruncate(descriptor, static_cast<off_t>(bytes)) == 0;
  const int reason = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (good) return;
  throw Error(Error::Category::file, "cannot-write",
              fmt::format("cannot write '{}': {}", file.string(), std::strerror(reason)));
}

namespace {

/// The rows of results.csv, whose text is to be that of their numbers.
void read_text(const fs::path& file, const KeptPart& part, const RecordLayout& layout, KeptFiles& kept) {
  Sha256 text_hash, number_hash;
  const WholeLines lines = whole_lines(file, part.rows + 1, &text_hash);
  require_enough(file, "rows", lines.lines - 1, part.rows);
  kept.row_bytes = lines.bytes;
  const auto reader = ResultReader::open(file);
  require_columns(file, reader->layout(), layout);
  std::string text = text_header(layout.columns);
  first_rows(*reader, part.rows, [&](std::span<const double> some) {
    kept.row_hash->write({.rows = some, .events = {}});
    for (std::size_t i = 0; i < some.size(); ++i) {
      append_number(text, some[i]);
      text += (i + 1) % layout.columns.size() == 0 ? '\n' : ',';
    }
    number_hash.add(text.data(), text.size());
    text.clear();
    kept.text_rows = {static_cast<long>(part.rows), some[some.size() - layout.columns.size()]};
  });
  require_unchanged(file, "rows", kept.row_hash->digits(), part.row_digits);
  require_unchanged(file, "rows", text_hash.digits(), number_hash.digits());
}

}  // namespace

KeptFiles read_kept(const fs::path& directory, const KeptPart& part, ResultFormat format, const RecordLayout& layout,
                    const Hdf5Writer::Options& options) {
  KeptFiles kept;
  const fs::path events = directory / "events.csv";
  const WholeLines event_lines = whole_lines(events, part.events + 1, &kept.event_text);
  require_enough(events, "events", event_lines.lines - 1, part.events);
  require_unchanged(events, "events", kept.event_text.digits(), part.event_digits);
  kept.event_bytes = event_lines.bytes;
  kept.row_hash = std::make_unique<RowHash>();
  if (format != ResultFormat::hdf5) read_text(directory / "results.csv", part, layout, kept);
  if (format == ResultFormat::csv) return kept;
  Hdf5Writer::Options later = options;
  later.named_later = true;
  const auto copy = [&](const char* name) {
    kept.hdf5.reset();
    kept.hdf5 = std::make_unique<Hdf5Writer>(directory / "results.h5", layout, later);
    kept.row_hash = std::make_unique<RowHash>();
    copy_rows(directory / name, part, layout, *kept.hdf5, *kept.row_hash);
  };
  try {
    copy("results.h5");
  } catch (const Error& error) {
    // A kill may cut the writing of a header in two; the text has the same rows.
    if (format != ResultFormat::both || error.id() != "unreadable-result") throw;
    copy("results.csv");
  }
  return kept;
}

namespace {

/// How many there are of the first so many, and their fingerprint.
struct First {
  std::int64_t count = 0;
  std::string digits;
};

First first_rows(const fs::path& file, std::int64_t count) {
  RowHash hash;
  First first;
  if (file.extension() != ".csv" || whole_lines(file, 1).lines > 0) {
    const auto reader = ResultReader::open(file);
    first.count =
        first_rows(*reader, count, [&](std::span<const double> some) { hash.write({.rows = some, .events = {}}); });
  }
  first.digits = hash.digits();
  return first;
}

First events_of(const fs::path& file, std::int64_t count) {
  if (file.extension() == ".csv") {
    Sha256 text;
    const std::int64_t lines = whole_lines(file, count + 1, &text).lines;
    return {std::max<std::int64_t>(lines - 1, 0), text.digits()};
  }
  const auto reader = ResultReader::open(file);
  EventHash hash(reader->layout());
  const std::int64_t there = first_events(*reader, count, [&](std::span<const double> some) { hash.add(some); });
  return {there, hash.digits()};
}

/// What is foreign of a text file and of results.h5, either of which may be missing.
std::string foreign(const char* things, const fs::path& text, const fs::path& hdf5, const First& kept,
                    First (*first_of)(const fs::path&, std::int64_t)) {
  const auto words = [&](const fs::path& file, const char* whose) {
    return fmt::format("'{}' was changed: its {} are not those {}", file.string(), things, whose);
  };
  std::error_code ignored;
  const bool has_text = fs::exists(text, ignored), has_hdf5 = fs::exists(hdf5, ignored);
  if (!kept.digits.empty()) {
    const char* const whose = "that the checkpoint counts";
    if (has_text && first_of(text, kept.count).digits != kept.digits) return words(text, whose);
    if (has_hdf5 && first_of(hdf5, kept.count).digits != kept.digits) return words(hdf5, whose);
  }
  if (!has_text || !has_hdf5) return {};
  const First both = first_of(hdf5, whole_lines(text, std::numeric_limits<std::int64_t>::max()).lines - 1);
  return both.count <= 0 || first_of(text, both.count).digits == both.digits ? "" : words(text, "of results.h5");
}

}  // namespace

std::string foreign_part(const fs::path& directory, const KeptPart& part) {
  const fs::path hdf5 = directory / "results.h5";
  const std::string rows = foreign("rows", directory / "results.csv", hdf5, {part.rows, part.row_digits}, first_rows);
  if (!rows.empty()) return rows;
  return foreign("events", directory / "events.csv", hdf5, {part.events, part.event_digits}, events_of);
}

void cut_back(const fs::path& directory, const KeptFiles& kept, ResultFormat format) {
  cut_file(directory / "events.csv", kept.event_bytes);
  if (format != ResultFormat::hdf5) cut_file(directory / "results.csv", kept.row_bytes);
  if (kept.hdf5 == nullptr) return;
  kept.hdf5->put_in_place();
  if (!kept.hdf5->failure().empty()) throw Error(Error::Category::file, "cannot-write", kept.hdf5->failure());
}

}  // namespace freeplay
