#include "study/row_sorter.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"

namespace freeplay {
namespace {

constexpr std::uint64_t most_bytes = std::uint64_t{64} << 20, most_buckets = 128;
constexpr std::size_t most_held = std::size_t{1} << 17;

struct RecordHead {
  std::uint64_t index;
  std::uint32_t segment;
  std::int32_t exit_code;
  std::uint64_t bytes;  ///< of the texts after it, each ended by a line feed
};

std::string_view take_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end + 1);
  return line;
}

RecordHead head_of(const char* record) {
  RecordHead head;
  std::memcpy(&head, record, sizeof head);
  return head;
}

void read_record(const char* record, SortedRow& row) {
  const RecordHead head = head_of(record);
  row.index = head.index;
  row.segment = head.segment;
  row.exit_code = head.exit_code;
  std::string_view rest(record + sizeof head, head.bytes);
  for (std::string_view* text :
       {&row.hash, &row.error, &row.wall, &row.cpu, &row.run, &row.values, &row.message, &row.start}) {
    *text = take_line(rest);
  }
  row.samples.clear();
  while (!rest.empty()) row.samples.push_back(take_line(rest));
}

}  // namespace

/// Records one after the other: in memory while they are few, then in a file without a name.
class RowSorter::Bucket {
 public:
  Bucket(std::filesystem::path folder, std::uint64_t first_point, std::uint64_t end_point)
      : first(first_point), end(end_point), folder_(std::move(folder)) {}
  ~Bucket() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Bucket(const Bucket&) = delete;
  Bucket& operator=(const Bucket&) = delete;

  void put(std::string_view record, std::size_t most) {
    held_ += record;
    if (held_.size() >= most) write();
  }
  std::uint64_t size() const { return written_ + held_.size(); }
  /// All of it, from memory.
  std::string take() {
    if (written_ == 0) return std::exchange(held_, {});
    write();
    std::string all(written_, '\0');
    read(all.data(), all.size(), 0);
    return all;
  }
  /// Piece by piece; `each` gets whole records.
  template <class Each>
  void for_each(Each&& each) {
    write();
    std::string piece(most_held, '\0');
    for (std::uint64_t at = 0; at < written_;) {
      RecordHead head{};
      read(reinterpret_cast<char*>(&head), sizeof head, at);
      const std::size_t size = sizeof head + head.bytes;
      piece.resize(std::max(piece.size(), size));
      read(piece.data(), size, at);
      each(head.index, std::string_view(piece).substr(0, size));
      at += size;
    }
  }

  const std::uint64_t first, end;

 private:
  [[noreturn]] void fail() const {
    throw Error(Error::Category::file, "cannot-write",
                fmt::format("cannot write into '{}': {}", folder_.string(), std::strerror(errno)));
  }
  void write() {
    if (descriptor_ < 0) {
      std::string name = (folder_ / ".merge-XXXXXX").string();
      descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
      if (descriptor_ < 0) fail();
      ::unlink(name.c_str());
    }
    std::string_view rest = held_;
    while (!rest.empty()) {
      const ssize_t count = ::write(descriptor_, rest.data(), rest.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail();
      rest.remove_prefix(static_cast<std::size_t>(count));
    }
    written_ += held_.size();
    held_.clear();
  }
  void read(char* to, std::size_t size, std::uint64_t at) const {
    while (size > 0) {
      const ssize_t count = ::pread(descriptor_, to, size, static_cast<off_t>(at));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) fail();
      to += count;
      at += static_cast<std::uint64_t>(count);
      size -= static_cast<std::size_t>(count);
    }
  }

  std::filesystem::path folder_;
  std::string held_;
  int descriptor_ = -1;
  std::uint64_t written_ = 0;
};

RowSorter::RowSorter(std::filesystem::path folder, std::uint64_t points, std::uint64_t expected)
    : RowSorter(std::move(folder), 0, points, expected) {}

RowSorter::RowSorter(std::filesystem::path folder, std::uint64_t first, std::uint64_t end, std::uint64_t expected)
    : folder_(std::move(folder)), first_(first), end_(end) {
  const std::uint64_t span = std::max<std::uint64_t>(end - first, 1);
  // Three quarters of the room: rows are never spread quite evenly.
  const std::uint64_t wanted = expected / (most_bytes / 4 * 3) + 1, count = std::min({wanted, most_buckets, span});
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto at = [&](std::uint64_t k) {
      __extension__ using Product = unsigned __int128;
      return first + static_cast<std::uint64_t>((Product{span} * k + count - 1) / count);
    };
    buckets_.push_back(std::make_unique<Bucket>(folder_, at(i), at(i + 1)));
  }
}

RowSorter::~RowSorter() = default;

void RowSorter::put(std::uint64_t index, std::string_view record) {
  __extension__ using Product = unsigned __int128;
  const std::uint64_t count = buckets_.size(), span = std::max<std::uint64_t>(end_ - first_, 1);
  const auto bucket = static_cast<std::size_t>(Product{index - first_} * count / span);
  buckets_[bucket]->put(record, count == 1 ? most_bytes : most_held);
}

void RowSorter::put(const SegmentRow& row, std::uint32_t segment) {
  record_.assign(sizeof(RecordHead), '\0');
  for (const std::string_view text :
       {row.hash, row.error, row.wall, row.cpu, row.run, row.values, row.message, row.start}) {
    (record_ += text) += '\n';
  }
  for (const std::string_view sample : row.samples) (record_ += sample) += '\n';
  const RecordHead head{row.index, segment, row.exit_code, record_.size() - sizeof(RecordHead)};
  std::memcpy(record_.data(), &head, sizeof head);
  put(row.index, record_);
}

void RowSorter::visit(const Visit& each) {
  for (auto& bucket : buckets_) {
    visit(*bucket, each);
    bucket.reset();  // its file is not needed any more
  }
}

void RowSorter::visit(Bucket& bucket, const Visit& each) const {
  if (bucket.size() > most_bytes && bucket.end - bucket.first > 1) {
    RowSorter finer(folder_, bucket.first, bucket.end, bucket.size());
    bucket.for_each([&](std::uint64_t index, std::string_view record) { finer.put(index, record); });
    finer.visit(each);
    return;
  }
  const std::string records = bucket.take();
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (std::size_t at = 0; at < records.size();) {
    const RecordHead head = head_of(records.data() + at);
    order.emplace_back(head.index, at);
    at += sizeof head + head.bytes;
  }
  std::ranges::sort(order);
  std::vector<SortedRow> rows;
  for (std::size_t i = 0; i < order.size();) {
    std::size_t count = 0;
    for (; i < order.size() && (count == 0 || order[i].first == rows.front().index); ++i, ++count) {
      if (rows.size() <= count) rows.emplace_back();
      read_record(records.data() + order[i].second, rows[count]);
    }
    rows.resize(count);
    each(rows);
  }
}

}  // namespace freeplay
