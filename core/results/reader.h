// ResultReader: rows and events of a result, whatever files it has.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "model/model.h"
#include "results/record.h"

namespace freeplay {

/// Which rows: from <= time <= until, to 1e-9 of the interval, and of these every N-th, the first included.
struct RowWindow {
  double from = -std::numeric_limits<double>::infinity(), until = std::numeric_limits<double>::infinity();
  std::size_t every = 1;
};

/// Rows that are read as they are asked for.
class RowSource {
 public:
  virtual ~RowSource() = default;
  /// The next block of whole rows, valid until the next call; empty at the end.
  virtual std::span<const double> next() = 0;
};

/// Reads what is complete of a result that may belong to a run that goes on or was killed.
class ResultReader {
 public:
  using Take = std::function<void(std::span<const double>)>;

  /// A result directory (its results.h5, or results.csv where that cannot be read), a CSV or an HDF5 file, a MAT-file
  /// or JSON of `export`. Throws Error{file} "unreadable-result" that says why, as the functions below do.
  static std::unique_ptr<ResultReader> open(const std::filesystem::path& path);
  virtual ~ResultReader() = default;

  /// What is read, for messages.
  const std::string& file() const { return file_; }
  /// Why a results.h5 beside it is not read, as a message; empty where none is passed over.
  const std::string& passed_over() const { return passed_over_; }
  /// Names of the columns, the first is time; units and sources where the file has them.
  const RecordLayout& layout() const { return layout_; }
  /// False for an HDF5 file that is still written, or whose writer was killed: not every program opens it.
  virtual bool sealed() const { return true; }
  /// Index of a column in the layout, or its size.
  std::size_t find(std::string_view name) const;
  /// Gives columns without a unit that of the channel of this model with their name.
  void know_units(const Model& model);
  /// Numbers of some columns, row after row. Only these are read; `columns` begins with time. The reader must outlive
  /// what it gives.
  virtual std::unique_ptr<RowSource> open_rows(std::span<const std::size_t> columns) = 0;
  /// The same of the rows in a window, in blocks of whole rows.
  void rows(std::span<const std::size_t> columns, const RowWindow& window, const Take& take);
  /// Numbers of all events as RecordLayout says, in blocks of whole events.
  virtual void events(const Take& take) = 0;
  /// Numbers of a table by bearing sector (BearingQuantity), 72 for each of RecordLayout::bearings; empty where the
  /// file has none.
  virtual std::vector<double> bearing(const std::string&) { return {}; }
  /// Text of the summary of the run; empty while there is none.
  virtual std::string summary() { return {}; }

 protected:
  explicit ResultReader(std::string file) : file_(std::move(file)) {}

  std::string file_, passed_over_;
  RecordLayout layout_;
};

/// What is the same for all ways to name a result: its directory, also of its results.csv or results.h5.
std::filesystem::path whole_result(const std::filesystem::path& path);

[[noreturn]] void unreadable_result(const std::string& file, const std::string& why, int line = 0,
                                    const std::string& hint = {});

/// Picks rows that come in blocks.
class RowPicker {
 public:
  RowPicker(const RowWindow& window, std::size_t width, const ResultReader::Take& take)
      : window_(window), width_(width), take_(take) {}

  /// Whole rows, time first.
  void add(std::span<const double> rows);
  /// Gives the last rows of all; without it they wait.
  void finish();
  /// No row to come can be wanted.
  bool over() const { return over_; }

 private:
  bool inside(double time) const;

  const RowWindow window_;
  const std::size_t width_;
  const ResultReader::Take& take_;
  std::vector<double> held_;  // the first row, until the second tells the interval
  double same_ = 0.0;
  std::size_t seen_ = 0, met_ = 0;
  std::vector<double> picked_;
  bool over_ = false;
};

std::unique_ptr<ResultReader> open_csv(const std::filesystem::path& path);
std::unique_ptr<ResultReader> open_hdf5(const std::filesystem::path& path);
/// Tables of rows that were exported.
std::unique_ptr<ResultReader> open_mat(const std::filesystem::path& path);
std::unique_ptr<ResultReader> open_json(const std::filesystem::path& path);

}  // namespace freeplay
