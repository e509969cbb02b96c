// Hdf5Writer: results.h5, at once HDF5 and netCDF-4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "results/record.h"

namespace freeplay {

/// Tables by bearing sector: for each quantity 72 numbers for each of RecordLayout::bearings.
using BearingTables = std::map<std::string, std::vector<double>>;

/// What a table of bearing sectors holds besides.
struct BearingQuantity {
  const char *name, *unit, *long_name;
};
inline constexpr std::size_t bearing_sectors = 72;
std::span<const BearingQuantity> bearing_quantities();

/// Writes the layout of docs/results.md. A file that grows may be read all the time, and after a kill; it has its name
/// once it can be. Rows are complete as far as `time` goes, which is written last.
class Hdf5Writer : public RecordWriter {
 public:
  struct Options {
    std::size_t expected_rows = 1024;  ///< sets the size of chunks
    bool grows = true;                 ///< else a file for any reader, compressed
    bool named_later = false;          ///< a file that grows takes the place of another one by put_in_place()
  };
  /// `layout` outlives it. Nothing is done before the first call.
  Hdf5Writer(std::filesystem::path path, const RecordLayout& layout, const Options& options);
  ~Hdf5Writer() override;

  void write(const RecordBlock& block) override;
  void flush() override;
  void sync() override;
  /// Hands over the rest; the file stays open for finish().
  void close() override { flush(); }
  void look_after() override;
  bool disturbed() const override;
  const HeldRows* held() const override { return &held_; }
  const std::string& failure() const override { return failure_; }
  /// Whether the file had its name once; another program took it away where it is not there then.
  bool placed() const;
  /// Gives the file its name, with what was written so far.
  void put_in_place();

  /// Writes the tables and the text of the summary and closes the file: any reader opens it then. A quantity that
  /// `tables` does not have is left empty.
  void finish(const BearingTables& tables, const std::string& summary);

 private:
  struct File;
  template <class Act>
  void attempt(Act&& act);
  void fail(const char* reason);
  std::string words(const char* reason) const;

  std::filesystem::path path_;
  const RecordLayout& layout_;
  Options options_;
  std::unique_ptr<File> file_;
  HeldRows held_;
  std::string failure_;
};

}  // namespace freeplay
