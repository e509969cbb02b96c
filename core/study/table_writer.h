// TableWriter: the files that a merged study consists of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "study/merge.h"
#include "study/row_sorter.h"

namespace freeplay {

/// Takes the rows that count, in the order of their points. The files are there when it is closed: all, or those of
/// before.
class TableWriter {
 public:
  /// Throws Error{file} "cannot-write", as all that follows.
  TableWriter(const std::filesystem::path& folder, const MergePlan& plan);
  ~TableWriter();

  void put(const SortedRow& row, const std::string& host);
  void close();

 private:
  struct Files;
  void put_samples(const SortedRow& row);
  void put_columns(const SortedRow& row);

  const MergePlan& plan_;
  std::filesystem::path folder_;
  std::unique_ptr<Files> files_;
  std::vector<std::string> cells_;
};

}  // namespace freeplay
