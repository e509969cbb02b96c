#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/input_text.h"
#include "results/reader.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t read_size = 1 << 20;      // bytes read at a time
constexpr std::size_t block_numbers = 1 << 16;  // given at a time

template <class Take>
void for_each_field(std::string_view line, Take&& take) {
  for (;;) {
    const std::size_t comma = line.find(',');
    take(line.substr(0, comma));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

/// Whole lines of a file; what follows the last line feed is a line that is still written, and left out.
class Lines {
 public:
  explicit Lines(const std::string& file) : file_(file), stream_(file, std::ios::binary) {
    if (!stream_) unreadable_result(file, fmt::format("it cannot be opened: {}", std::strerror(errno)));
  }

  /// False at the end. The line is valid until the next call.
  bool next(std::string_view& line) {
    std::size_t end = text_.find('\n', at_);
    while (end == std::string::npos) {
      text_.erase(0, std::exchange(at_, 0));
      const std::size_t had = text_.size();
      text_.resize(had + read_size);
      stream_.read(text_.data() + had, static_cast<std::streamsize>(read_size));
      text_.resize(had + static_cast<std::size_t>(stream_.gcount()));
      if (stream_.bad()) unreadable_result(file_, std::strerror(errno));
      if (text_.size() == had) return false;
      end = text_.find('\n', had);
    }
    line = std::string_view(text_).substr(at_, end - at_);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    at_ = end + 1;
    ++number_;
    return true;
  }

  int number() const { return number_; }

 private:
  std::string file_;
  std::ifstream stream_;
  std::string text_;
  std::size_t at_ = 0;
  int number_ = 0;
};

double number(std::string_view field, const std::string& file, int line) {
  if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size()) {
    unreadable_result(file, fmt::format("line {}: '{}' is not a number", line, field.substr(0, 40)), line);
  }
  return value;
}

void require_fields(std::size_t fields, std::size_t names, const std::string& file, int line) {
  if (fields == names) return;
  unreadable_result(
      file, fmt::format("line {} has {} field{}, the header {}", line, fields, fields == 1 ? "" : "s", names), line);
}

double index_of(std::string_view word, std::vector<std::string>& words) {
  const auto found = std::ranges::find(words, word);
  const auto index = found - words.begin();
  if (found == words.end()) words.emplace_back(word);
  return static_cast<double>(index);
}

class CsvRows : public RowSource {
 public:
  CsvRows(const std::string& file, std::span<const std::size_t> columns, std::size_t fields)
      : file_(file), lines_(file), place_(fields, columns.size()), row_(columns.size()) {
    for (std::size_t i = columns.size(); i-- > 0;) {
      // A column may be asked for several times: it is read in its first place.
      if (place_[columns[i]] < columns.size()) copies_.emplace_back(i, place_[columns[i]]);
      place_[columns[i]] = i;
    }
    std::string_view header;
    lines_.next(header);
  }

  std::span<const double> next() override {
    block_.clear();
    std::string_view line;
    while (block_.size() < block_numbers && lines_.next(line)) {
      read(line);
      block_.insert(block_.end(), row_.begin(), row_.end());
    }
    return block_;
  }

 private:
  void read(std::string_view line) {
    std::size_t field = 0;
    for_each_field(line, [&](std::string_view text) {
      if (field < place_.size() && place_[field] < row_.size())
        row_[place_[field]] = number(text, file_, lines_.number());
      ++field;
    });
    for (auto copy = copies_.rbegin(); copy != copies_.rend(); ++copy) row_[copy->second] = row_[copy->first];
    require_fields(field, place_.size(), file_, lines_.number());
    if (!(row_[0] > last_))
      unreadable_result(file_, fmt::format("line {}: time does not grow", lines_.number()), lines_.number());
    last_ = row_[0];
  }

  const std::string file_;
  Lines lines_;
  std::vector<std::size_t> place_;                           // of each field in a row that is given
  std::vector<std::pair<std::size_t, std::size_t>> copies_;  // places of one column, the first ones last
  std::vector<double> block_, row_;
  double last_ = -std::numeric_limits<double>::infinity();
};

class CsvReader : public ResultReader {
 public:
  explicit CsvReader(const fs::path& path) : ResultReader(path.string()), events_(path.parent_path() / "events.csv") {
    Lines lines(file_);
    std::string_view header;
    if (!lines.next(header)) unreadable_result(file_, "it has no whole line");
    for_each_field(header, [&](std::string_view name) { layout_.columns.push_back({std::string(name), "", "", ""}); });
    if (layout_.columns.front().name != "time") unreadable_result(file_, "its first column is not 'time'", 1);
    read_event_header();
  }

  std::unique_ptr<RowSource> open_rows(std::span<const std::size_t> columns) override {
    return std::make_unique<CsvRows>(file_, columns, layout_.columns.size());
  }

  void events(const Take& take) override {
    if (layout_.events.empty()) unreadable_result(events_.string(), "there is no such file");
    Lines lines(events_.string());
    std::string_view line;
    std::vector<double> block;
    for (lines.next(line); lines.next(line);) {
      std::size_t field = 0;
      for_each_field(line, [&](std::string_view text) {
        if (field == 1) {
          block.push_back(index_of(text, layout_.joints));
        } else if (field == 2) {
          block.push_back(index_of(text, layout_.kinds));
        } else {
          block.push_back(number(text, events_.string(), lines.number()));
        }
        ++field;
      });
      require_fields(field, layout_.events.size(), events_.string(), lines.number());
      if (block.size() < block_numbers) continue;
      take(block);
      block.clear();
    }
    if (!block.empty()) take(block);
  }

  std::string summary() override {
    std::string text;
    const fs::path beside = fs::path(file_).parent_path() / "summary.json";
    return read_input(beside.string(), text).empty() ? text : std::string();
  }

 private:
  void read_event_header() {
    std::error_code ignored;
    if (!fs::exists(events_, ignored)) return;
    Lines lines(events_.string());
    std::string_view header;
    if (!lines.next(header) || !header.starts_with("time,joint,kind")) return;
    for_each_field(header, [&](std::string_view name) { layout_.events.push_back({std::string(name), "", "", ""}); });
  }

  fs::path events_;
};

}  // namespace

std::unique_ptr<ResultReader> open_csv(const fs::path& path) { return std::make_unique<CsvReader>(path); }

}  // namespace freeplay
