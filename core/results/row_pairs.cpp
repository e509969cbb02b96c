#include "results/row_pairs.h"

#include <algorithm>

namespace freeplay {
namespace {

constexpr double same_time = 1e-9;        // of the interval
constexpr std::size_t only_time[] = {0};  // column

}  // namespace

double RowPairs::Extent::interval() const { return rows < 2 ? 0.0 : (last - first) / static_cast<double>(rows - 1); }

RowPairs::Extent RowPairs::extent(ResultReader& reader) {
  Extent out;
  const std::unique_ptr<RowSource> source = reader.open_rows(only_time);
  for (auto times = source->next(); !times.empty(); times = source->next()) {
    if (out.rows == 0) out.first = times.front();
    out.last = times.back();
    out.rows += times.size();
  }
  return out;
}

bool RowPairs::Walk::next() {
  block_ = block_.subspan(there_ ? width_ : 0);
  if (block_.empty() && left_ > 0) block_ = source_->next();
  there_ = left_ > 0 && !block_.empty();
  if (there_) --left_;
  return there_;
}

RowPairs::RowPairs(ResultReader& first, std::span<const std::size_t> first_columns, ResultReader& second,
                   std::span<const std::size_t> second_columns, double from, double until)
    : from_(from),
      until_(until),
      first_extent_(extent(first)),
      second_extent_(extent(second)),
      same_(same_time * std::max(first_extent_.interval(), second_extent_.interval())),
      first_(first, first_columns, first_extent_.rows),
      second_(second, second_columns, second_extent_.rows),
      between_(second_columns.size()) {
  advance_second();
}

// Rows between those of the first result are what interpolation is for; rows beyond are missing there.
void RowPairs::advance_second() {
  if (second_.there()) before_.assign(second_.row().begin(), second_.row().end());
  if (!second_.next() || !inside(second_.time())) return;
  const double time = second_.time();
  const bool within =
      first_extent_.rows > 0 && time >= first_extent_.first - same_ && time <= first_extent_.last + same_;
  if (!within) ++second_alone_;
}

// The second result at a time, in second_row_. False where it has none.
bool RowPairs::place(double time) {
  while (second_.there() && second_.time() < time) advance_second();
  if (second_.there() && second_.time() - time <= same_) {
    second_row_ = second_.row();
    return true;
  }
  if (before_.empty()) return false;
  if (time - before_.front() <= same_) {
    second_row_ = before_;
    return true;
  }
  if (!second_.there()) return false;
  const double fraction = (time - before_.front()) / (second_.time() - before_.front());
  const std::span<const double> after = second_.row();
  for (std::size_t i = 0; i < between_.size(); ++i) between_[i] = before_[i] + fraction * (after[i] - before_[i]);
  second_row_ = between_;
  return interpolated_ = true;
}

bool RowPairs::next() {
  while (first_.next() && first_.time() <= until_ + same_) {
    if (!inside(first_.time())) continue;
    if (place(first_.time())) {
      ++rows_;
      return true;
    }
    ++first_alone_;
  }
  while (second_.there() && second_.time() <= until_ + same_) advance_second();
  return false;
}

}  // namespace freeplay
