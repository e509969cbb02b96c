#include "results/comparison.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"

namespace freeplay {
namespace {

bool fits(std::string_view pattern, std::string_view name) {
  std::size_t p = 0, n = 0, star = std::string_view::npos, from = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++, from = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++p, ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1, n = ++from;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

/// Row of b at a time of a, or between which two rows.
struct Place {
  std::size_t row = 0;
  double fraction = 0.0;  ///< towards the next row; 0: the row itself
};

std::optional<Place> place(const std::vector<double>& time, double t, double same) {
  const auto after = std::ranges::lower_bound(time, t);
  const auto row = static_cast<std::size_t>(after - time.begin());
  if (after != time.end() && *after - t <= same) return Place{row, 0.0};
  if (row > 0 && t - time[row - 1] <= same) return Place{row - 1, 0.0};
  if (row == 0 || after == time.end()) return std::nullopt;
  return Place{row - 1, (t - time[row - 1]) / (*after - time[row - 1])};
}

double value_at(const std::vector<double>& values, const Place& p) {
  return p.fraction == 0.0 ? values[p.row] : values[p.row] + p.fraction * (values[p.row + 1] - values[p.row]);
}

class Comparer {
 public:
  Comparer(const ResultTable& a, const ResultTable& b, const ComparisonRules& rules) : a_(a), b_(b), rules_(rules) {}

  Comparison compare() {
    match_rows();
    for (const std::string& pattern : rules_.channels) {
      const auto some = [&](const ResultTable& r) {
        return std::any_of(r.names.begin() + 1, r.names.end(), [&](const std::string& n) { return fits(pattern, n); });
      };
      if (!some(a_) && !some(b_)) {
        throw Error(Error::Category::usage, "bad-value", fmt::format("no channel fits --channels '{}'", pattern));
      }
    }
    for (std::size_t c = 1; c < a_.names.size(); ++c) {
      if (!wanted(a_.names[c])) continue;
      const int other = b_.find(a_.names[c]);
      if (other < 0) {
        add_missing(a_.names[c], b_);
      } else {
        add(a_.names[c], a_.values[c], b_.values[static_cast<std::size_t>(other)]);
      }
    }
    for (std::size_t c = 1; c < b_.names.size(); ++c) {
      if (wanted(b_.names[c]) && a_.find(b_.names[c]) < 0) {
        add_missing(b_.names[c], a_);
      }
    }
    sort();
    return std::move(result_);
  }

 private:
  bool wanted(const std::string& name) const {
    return std::ranges::any_of(rules_.channels, [&](const std::string& pattern) { return fits(pattern, name); });
  }

  static double interval(const std::vector<double>& time) {
    return time.size() < 2 ? 0.0 : (time.back() - time.front()) / static_cast<double>(time.size() - 1);
  }

  bool inside(double t, double same) const { return t >= rules_.from - same && t <= rules_.until + same; }

  void match_rows() {
    const std::vector<double>&first = a_.time(), &second = b_.time();
    const double same = 1e-9 * std::max(interval(first), interval(second));
    std::size_t unmatched = 0, exact = 0;
    for (std::size_t r = 0; r < first.size(); ++r) {
      if (!inside(first[r], same)) continue;
      if (const auto p = place(second, first[r], same)) {
        rows_.push_back({r, *p});
        exact += p->fraction == 0.0 ? 1 : 0;
      } else {
        ++unmatched;
      }
    }
    result_.rows = rows_.size();
    result_.interpolated = exact < rows_.size();
    if (unmatched > 0) {
      result_.missing.push_back(fmt::format("{} rows of {} lie outside the times of {}", unmatched, a_.file, b_.file));
    }
    // Rows of b between those of a are what interpolation is for; rows beyond are missing.
    const auto beyond = std::ranges::count_if(second, [&](double t) {
      return inside(t, same) && (first.empty() || t < first.front() - same || t > first.back() + same);
    });
    if (beyond > 0) {
      result_.missing.push_back(fmt::format("{} rows of {} lie outside the times of {}", beyond, b_.file, a_.file));
    }
    if (rows_.empty()) result_.missing.push_back("no rows at common times");
  }

  void add(const std::string& name, const std::vector<double>& a, const std::vector<double>& b) {
    ChannelDifference d{.name = name};
    double size = 0.0, squares = 0.0;
    for (const auto& [row, p] : rows_) {
      const double x = a[row], y = value_at(b, p);
      if (std::isnan(x) && std::isnan(y)) continue;
      size = std::fmax(size, std::abs(x));
      const double off = x == y ? 0.0 : std::abs(x - y);
      squares += off * off;
      if (!(off <= d.largest)) d.largest = off, d.at_time = a_.time()[row];
      if (std::isnan(off)) break;
    }
    const double allowed = rules_.absolute + rules_.relative * size;
    d.relative = d.largest == 0.0 ? 0.0 : d.largest / size;
    d.rms = std::sqrt(squares / static_cast<double>(rows_.size()));
    if (rows_.empty()) d.largest = d.relative = d.at_time = std::numeric_limits<double>::quiet_NaN();
    d.agrees = d.largest <= allowed;
    result_.channels.push_back(d);
    weight_.push_back(std::isnan(d.largest) ? std::numeric_limits<double>::infinity()
                                            : (d.largest == 0.0 ? 0.0 : d.largest / allowed));
  }

  void add_missing(const std::string& name, const ResultTable& where) {
    result_.missing.push_back(fmt::format("channel '{}' is missing in {}", name, where.file));
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    result_.channels.push_back({name, nan, nan, nan, nan, false});
    weight_.push_back(std::numeric_limits<double>::infinity());
  }

  void sort() {
    std::vector<std::size_t> order(weight_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, [&](std::size_t i, std::size_t k) { return weight_[i] > weight_[k]; });
    std::vector<ChannelDifference> sorted;
    for (const std::size_t i : order) sorted.push_back(std::move(result_.channels[i]));
    result_.channels = std::move(sorted);
  }

  const ResultTable& a_;
  const ResultTable& b_;
  const ComparisonRules& rules_;
  std::vector<std::pair<std::size_t, Place>> rows_;
  std::vector<double> weight_;
  Comparison result_;
};

}  // namespace

bool Comparison::agree() const {
  return missing.empty() && std::ranges::all_of(channels, [](const ChannelDifference& d) { return d.agrees; });
}

Comparison compare(const ResultTable& a, const ResultTable& b, const ComparisonRules& rules) {
  return Comparer(a, b, rules).compare();
}

}  // namespace freeplay
