// RowHash: the fingerprint of all rows, whatever files they go to.
#pragma once

#include "base/sha256.h"
#include "results/record.h"

namespace freeplay {

/// SHA-256 of the numbers of all rows as little-endian doubles, row by row.
class RowHash : public RecordWriter {
 public:
  void write(const RecordBlock& block) override {
    if (!block.rows.empty()) hash_.add(block.rows.data(), block.rows.size() * sizeof(double));
  }
  void flush() override {}
  void sync() override {}
  void close() override {}
  void look_after() override {}
  const std::string& failure() const override { return none_; }
  std::string digits() const { return hash_.digits(); }

 private:
  Sha256 hash_;
  std::string none_;
};

}  // namespace freeplay
