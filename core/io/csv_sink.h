// CsvSink: results.csv, one row per output instant.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "io/growing_file.h"
#include "run/sink.h"

namespace freeplay {

/// UTF-8, LF, comma, one header row, no quoting; a value that is NaN is an empty field.
class CsvSink : public Sink {
 public:
  /// `columns`: indices into Channels::all(). Throws Error{file}.
  CsvSink(const std::filesystem::path& path, const Channels& channels, std::vector<std::size_t> columns);

  void row(std::span<const double> values) override;
  void event(const EventRecord&) override {}
  bool ok() const override { return file_.ok(); }
  void flush_if_due() { file_.flush_if_due(); }
  /// Throws Error{file} if anything could not be written.
  void close() { file_.close(); }

 private:
  std::vector<std::size_t> columns_;
  GrowingFile file_;
};

}  // namespace freeplay
