// TextWriters: results.csv and events.csv.
#pragma once

#include <filesystem>

#include "base/growing_file.h"
#include "base/sha256.h"
#include "results/record.h"

namespace freeplay {

/// The first line of a file with these columns.
std::string text_header(std::span<const RecordColumn> columns);

/// UTF-8, LF, comma, one header row, no quoting; a value that is NaN is an empty field.
class TextWriter : public RecordWriter {
 public:
  void flush() override { file_.flush(), note(); }
  void sync() override { file_.sync(), note(); }
  void close() override;
  void look_after() override { file_.look_after(), note(); }
  bool disturbed() const override { return file_.disturbed(); }
  const std::string& failure() const override { return failure_; }

 protected:
  /// Throws Error{file}.
  TextWriter(const std::filesystem::path& path, std::span<const RecordColumn> columns, GrowingFile::Begin begin);
  /// After each call of the file.
  virtual void note();

  std::size_t width_;
  GrowingFile file_;

 private:
  std::string failure_;
};

/// results.csv, one line per row.
class RowTextWriter : public TextWriter {
 public:
  /// Throws Error{file}.
  RowTextWriter(const std::filesystem::path& path, const RecordLayout& layout)
      : TextWriter(path, layout.columns, GrowingFile::Begin::empty) {}
  /// Goes on in a file that holds `kept`.
  RowTextWriter(const std::filesystem::path& path, const RecordLayout& layout, const HeldRows& kept)
      : TextWriter(path, layout.columns, GrowingFile::Begin::append), given_(kept), held_(kept) {}
  void write(const RecordBlock& block) override;
  const HeldRows* held() const override { return &held_; }

 protected:
  void note() override;

 private:
  HeldRows given_, held_;
};

/// events.csv, one line per event. `layout` outlives it.
class EventTextWriter : public TextWriter {
 public:
  /// Appends the line of one event, without its end.
  static void append(std::string& line, const RecordLayout& layout, std::span<const double> event);
  /// Throws Error{file}.
  EventTextWriter(const std::filesystem::path& path, const RecordLayout& layout)
      : TextWriter(path, layout.events, GrowingFile::Begin::empty), layout_(layout) {
    const std::string header = text_header(layout.events);
    hash_.add(header.data(), header.size());
  }
  /// Goes on in a file that has `kept` as its text.
  EventTextWriter(const std::filesystem::path& path, const RecordLayout& layout, const Sha256& kept)
      : TextWriter(path, layout.events, GrowingFile::Begin::append), layout_(layout), hash_(kept) {}
  void write(const RecordBlock& block) override;
  /// SHA-256 of the file's text so far.
  std::string digits() const { return hash_.digits(); }

 private:
  const RecordLayout& layout_;
  Sha256 hash_;
};

}  // namespace freeplay
