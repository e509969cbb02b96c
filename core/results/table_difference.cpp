#include "results/table_difference.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/number_text.h"

namespace freeplay {
namespace {

constexpr std::size_t most_kept = std::size_t{1} << 25;  // numbers of one side at a time
constexpr std::size_t no_place = std::numeric_limits<std::size_t>::max();

std::string shown(const std::string& field) { return field.empty() ? "nothing" : field; }

std::string words_for(const TableRules& rules, std::size_t row, const std::string& time, const std::string& column,
                      const std::string& then, const std::string& now) {
  const std::string at = time.empty() ? std::string() : fmt::format(", t = {} s", time);
  return fmt::format("{} {}{}, {}: {} recorded, {} now", rules.row, row, at, column, shown(then), shown(now));
}

/// What more rows or fewer of them mean.
void compare_counts(const TableRules& rules, TableDifference& found) {
  if (!found.first.empty() || found.rows == found.rows_now) return;
  if (found.rows < found.rows_now && rules.as_far_as_it_goes) return;
  const std::size_t row = std::min(found.rows, found.rows_now);
  found.first =
      fmt::format("{} {}: {}", rules.row, row, found.rows > row ? "recorded, none now" : "none recorded, one now");
}

bool compare_names(const std::vector<std::string>& then, const std::vector<std::string>& now, TableDifference& found) {
  found.columns = then.size();
  const auto [a, b] = std::ranges::mismatch(then, now);
  if (a == then.end() && b == now.end()) return true;
  found.first = fmt::format("column {}: {} recorded, {} now", a - then.begin(),
                            a == then.end() ? "nothing" : fmt::format("'{}'", *a),
                            b == now.end() ? "nothing" : fmt::format("'{}'", *b));
  return false;
}

std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.emplace_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

/// Lines of a text, the last one only with its end.
class TextLines {
 public:
  explicit TextLines(const std::filesystem::path& path) : file_(path, std::ios::binary) {
    if (!file_) unreadable_result(path.string(), std::strerror(errno));
  }
  bool next(std::string& line) { return static_cast<bool>(std::getline(file_, line)) && !file_.eof(); }

 private:
  std::ifstream file_;
};

struct Mismatch {
  std::size_t row = no_place, column = 0;
  double time = 0.0, then = 0.0, now = 0.0;
};

bool same_number(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

using Give = std::function<void(const ResultReader::Take&)>;
using Same = std::function<bool(std::size_t column, double then, double now)>;

/// Numbers of some columns, time first, of one side against those of the other as they come.
Mismatch first_mismatch(const Give& then, const Give& now, std::size_t width, const Same& same,
                        TableDifference& found) {
  std::vector<double> kept;
  then([&](std::span<const double> rows) { kept.insert(kept.end(), rows.begin(), rows.end()); });
  Mismatch mismatch;
  std::size_t at = 0;
  now([&](std::span<const double> rows) {
    const std::size_t both = std::min(rows.size(), kept.size() - std::min(at, kept.size()));
    for (std::size_t i = 0; i < both && mismatch.row == no_place; ++i) {
      const double a = kept[at + i];
      if (same((at + i) % width, a, rows[i])) continue;
      const std::size_t row = (at + i) / width;
      mismatch = {row, (at + i) % width, kept[row * width], a, rows[i]};
    }
    at += rows.size();
  });
  found.rows = kept.size() / width;
  found.rows_now = at / width;
  return mismatch;
}

std::vector<std::string> names_of(const std::vector<RecordColumn>& columns) {
  std::vector<std::string> names;
  for (const RecordColumn& column : columns) names.push_back(column.name);
  return names;
}

std::size_t rows_in(ResultReader& reader) {
  const std::vector<std::size_t> time{0};
  std::size_t rows = 0;
  reader.rows(time, {}, [&](std::span<const double> block) { rows += block.size(); });
  return rows;
}

}  // namespace

TableDifference compare_csv(const std::filesystem::path& then, const std::filesystem::path& now,
                            const TableRules& rules) {
  TextLines a(then), b(now);
  std::string line, other;
  TableDifference found;
  const bool names = a.next(line), names_now = b.next(other);
  const std::vector<std::string> columns = fields_of(names ? line : "");
  if (!compare_names(columns, fields_of(names_now ? other : ""), found)) return found;
  const bool has_time = columns.front() == "time";
  for (;;) {
    const bool more = a.next(line), more_now = b.next(other);
    if (more && more_now && found.first.empty() && line != other) {
      const std::vector<std::string> fields = fields_of(line), fields_now = fields_of(other);
      const auto place = static_cast<std::size_t>(std::ranges::mismatch(fields, fields_now).in1 - fields.begin());
      found.first =
          words_for(rules, found.rows, has_time ? fields.front() : "",
                    place < columns.size() ? columns[place] : "a field more than names",
                    place < fields.size() ? fields[place] : "", place < fields_now.size() ? fields_now[place] : "");
    }
    found.rows += more ? 1 : 0;
    found.rows_now += more_now ? 1 : 0;
    if (!more && !more_now) break;
  }
  compare_counts(rules, found);
  return found;
}

TableDifference compare_rows(ResultReader& then, ResultReader& now, const TableRules& rules) {
  TableDifference found;
  const std::vector<std::string> names = names_of(then.layout().columns);
  if (!compare_names(names, names_of(now.layout().columns), found)) return found;
  found.rows = rows_in(then);
  const std::size_t group = std::max<std::size_t>(most_kept / std::max<std::size_t>(found.rows, 1), 1);
  Mismatch first;
  for (std::size_t begin = 0; begin < names.size(); begin += group) {
    std::vector<std::size_t> columns(std::min(group, names.size() - begin));
    std::iota(columns.begin(), columns.end(), begin);
    if (begin > 0) columns.insert(columns.begin(), 0);
    Mismatch one = first_mismatch([&](const auto& take) { then.rows(columns, {}, take); },
                                  [&](const auto& take) { now.rows(columns, {}, take); }, columns.size(),
                                  [](std::size_t, double a, double b) { return same_number(a, b); }, found);
    one.column = columns[one.column];
    if (one.row < first.row) first = one;
  }
  if (first.row != no_place) {
    found.first = words_for(rules, first.row, number_text(first.time), names[first.column], number_text(first.then),
                            number_text(first.now));
  }
  compare_counts(rules, found);
  return found;
}

TableDifference compare_events(ResultReader& then, ResultReader& now, const TableRules& rules) {
  TableDifference found;
  const std::vector<std::string> names = names_of(then.layout().events);
  if (!compare_names(names, names_of(now.layout().events), found) || names.empty()) return found;
  const auto word = [&](ResultReader& reader, std::size_t column, double number) {
    const RecordLayout& layout = reader.layout();
    const std::vector<std::string>& words = names[column] == "joint" ? layout.joints : layout.kinds;
    const bool is_word = names[column] == "joint" || names[column] == "kind";
    const bool known = is_word && number >= 0.0 && number < static_cast<double>(words.size());
    return known ? words[static_cast<std::size_t>(number)] : number_text(number);
  };
  const Mismatch first = first_mismatch(
      [&](const auto& take) { then.events(take); }, [&](const auto& take) { now.events(take); }, names.size(),
      [&](std::size_t column, double a, double b) {
        const bool is_word = names[column] == "joint" || names[column] == "kind";
        return is_word ? word(then, column, a) == word(now, column, b) : same_number(a, b);
      },
      found);
  if (first.row != no_place) {
    found.first = words_for(rules, first.row, number_text(first.time), names[first.column],
                            word(then, first.column, first.then), word(now, first.column, first.now));
  }
  compare_counts(rules, found);
  return found;
}

TableDifference compare_mat(const MatTable& then, const MatTable& now) {
  TableDifference found;
  found.rows = then.time.size();
  found.rows_now = now.time.size();
  if (!compare_names(then.channels, now.channels, found) || !compare_names(then.units, now.units, found)) return found;
  const auto numbers = [&](const std::vector<double>& a, const std::vector<double>& b, std::size_t first_column) {
    if (found.rows == 0 || found.rows != found.rows_now) return;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()) && found.first.empty(); ++i) {
      if (same_number(a[i], b[i])) continue;
      const std::size_t column = i / found.rows, row = i % found.rows;
      const std::string name = first_column == 0 ? "time" : column < then.channels.size() ? then.channels[column] : "";
      found.first = words_for({}, row, number_text(then.time[row]), name, number_text(a[i]), number_text(b[i]));
    }
  };
  numbers(then.time, now.time, 0);
  numbers(then.data, now.data, 1);
  compare_counts({}, found);
  if (found.first.empty() && then.data.size() != now.data.size()) {
    found.first = fmt::format("{} numbers recorded, {} now", then.data.size(), now.data.size());
  }
  return found;
}

}  // namespace freeplay
