#include "study/segment_reader.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"

namespace freeplay {
namespace {

constexpr std::size_t first_room = std::size_t{1} << 20;

/// The text up to the next tab, which is taken away with it.
std::string_view take_field(std::string_view& rest) {
  const std::size_t end = std::min(rest.find('\t'), rest.size());
  const std::string_view field = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return field;
}

template <class Number>
bool take_number(std::string_view& rest, Number& number) {
  const std::string_view field = take_field(rest);
  const auto [end, fault] = std::from_chars(field.data(), field.data() + field.size(), number);
  return fault == std::errc() && end == field.data() + field.size();
}

std::string_view without_last_tab(std::string_view text) {
  return text.ends_with('\t') ? text.substr(0, text.size() - 1) : text;
}

}  // namespace

SegmentReader::SegmentReader(std::filesystem::path path, Damage damage)
    : path_(std::move(path)),
      damage_(std::move(damage)),
      descriptor_(::open(path_.c_str(), O_RDONLY | O_CLOEXEC)),
      buffer_(first_room) {
  if (descriptor_ < 0) {
    throw Error(Error::Category::file, "file-not-found",
                fmt::format("cannot read '{}': {}", path_.string(), std::strerror(errno)));
  }
  std::string_view line;
  bool last = false;
  if (!read_line(line, last)) return;
  header_ = SegmentHeader::parse(line);
  if (!header_ && !last) damaged();
  begin_ = at_;
}

SegmentReader::~SegmentReader() { ::close(descriptor_); }

void SegmentReader::damaged() {
  hurt_ = true;
  damage_(path_, line_number_);
}

/// What waits stays; it moves to the front of the buffer.
bool SegmentReader::refill() {
  if (ended_) return false;
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    for (Line& line : waiting_) line.from -= begin_;
    at_ -= begin_;
    end_ -= begin_;
    begin_ = 0;
  }
  if (end_ == buffer_.size()) buffer_.resize(2 * buffer_.size());
  ssize_t count = -1;
  do {
    count = ::read(descriptor_, buffer_.data() + end_, buffer_.size() - end_);
  } while (count < 0 && errno == EINTR);
  if (count < 0) {
    throw Error(Error::Category::file, "file-not-found",
                fmt::format("cannot read '{}': {}", path_.string(), std::strerror(errno)));
  }
  ended_ = count == 0;
  end_ += static_cast<std::size_t>(count);
  return !ended_;
}

/// False at the end, also where the last line has no line feed: its writer was killed, or writes it just now.
bool SegmentReader::read_line(std::string_view& line, bool& last) {
  std::size_t searched = at_;
  const void* found = nullptr;
  while ((found = std::memchr(buffer_.data() + searched, '\n', end_ - searched)) == nullptr) {
    const std::size_t done = end_ - at_;
    if (!refill()) return false;
    searched = at_ + done;
  }
  const auto end = static_cast<std::size_t>(static_cast<const char*>(found) - buffer_.data());
  const std::size_t size = end - at_;
  if (end + 1 == end_) refill();  // moves what is here
  line = {buffer_.data() + at_, size};
  at_ += size + 1;
  last = at_ == end_ && ended_;
  ++line_number_;
  return true;
}

const SegmentRow* SegmentReader::next(const RowLayout& layout) {
  if (!header_) return nullptr;
  std::string_view line;
  bool last = false;
  begin_ = at_;
  waiting_.clear();
  while (read_line(line, last)) {
    const std::string_view text = unsealed(line);
    if (text.empty()) {
      if (!last) damaged();
      continue;
    }
    if (text[0] == '+' || text[0] == '!' || text[0] == '@') {
      waiting_.push_back({static_cast<std::size_t>(text.data() - buffer_.data()), text.size()});
      continue;
    }
    const bool whole = take(text, layout);
    if (!whole && !hurt_) damaged();
    hurt_ = false;
    if (whole) return &row_;
    begin_ = at_;
    waiting_.clear();
  }
  return nullptr;
}

/// The row with the lines before it that are of the same point; false unless all that it needs is there.
bool SegmentReader::take(std::string_view row, const RowLayout& layout) {
  row_.samples.clear();
  row_.message = row_.start = row_.state = {};
  row_.origin = 0;
  if (!take_number(row, row_.index)) return false;
  row_.hash = take_field(row);
  if (!take_number(row, row_.exit_code)) return false;
  row_.error = take_field(row);
  row_.wall = take_field(row);
  row_.cpu = take_field(row);
  row_.run = take_field(row);
  row_.values = without_last_tab(row);
  const auto columns = static_cast<std::size_t>(std::ranges::count(row, '\t'));
  if (columns != (row_.good() ? layout.columns.size() : 0)) return false;
  bool message = false, state = false;
  for (const Line& waiting : waiting_) {
    std::string_view line(buffer_.data() + waiting.from + 1, waiting.size - 1);
    const char kind = buffer_[waiting.from];
    std::uint64_t index = 0;
    if (!take_number(line, index) || index != row_.index) continue;
    if (kind == '!') {
      row_.message = take_field(line);
      message = true;
    } else if (kind == '@') {
      row_.start = take_field(line);
      state = take_number(line, row_.origin);
      row_.state = take_field(line);
    } else if (row_.samples.size() < layout.samples.size() && take_field(line) == layout.samples[row_.samples.size()]) {
      row_.samples.push_back(without_last_tab(line));
    }
  }
  if (row_.good() && row_.samples.size() != layout.samples.size()) return false;
  if (!row_.good()) row_.samples.clear();
  return message == !row_.good() && state == layout.chained;
}

}  // namespace freeplay
