// RowHash: the fingerprint of all rows, whatever files they go to.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/sha256.h"
#include "results/record.h"

namespace freeplay {

/// SHA-256 of the numbers of all rows as little-endian doubles, row by row; what is no number counts as one quiet NaN,
/// as text has it.
class RowHash : public RecordWriter {
 public:
  void write(const RecordBlock& block) override {
    std::span<const double> rows = block.rows;
    if (std::ranges::any_of(rows, [](double x) { return std::isnan(x); })) {
      plain_.assign(rows.begin(), rows.end());
      std::ranges::replace_if(
          plain_, [](double x) { return std::isnan(x); }, std::numeric_limits<double>::quiet_NaN());
      rows = plain_;
    }
    if (!rows.empty()) hash_.add(rows.data(), rows.size_bytes());
  }
  void flush() override {}
  void sync() override {}
  void close() override {}
  void look_after() override {}
  const std::string& failure() const override { return none_; }
  std::string digits() const { return hash_.digits(); }

 private:
  Sha256 hash_;
  std::vector<double> plain_;
  std::string none_;
};

}  // namespace freeplay
