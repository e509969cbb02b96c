#include "results/column_file.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <limits>
#include <map>
#include <new>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "results/hdf5_attributes.h"
#include "results/hdf5_call.h"

namespace freeplay {
namespace {

constexpr std::uint64_t least_rows_a_chunk = 64, most_rows_a_chunk = 8192;

/// Of one type in memory and file; numbers wait until a chunk is full.
struct FileColumn {
  RecordColumn description;
  ColumnFile::Kind kind = ColumnFile::Kind::number;
  std::string sample_dimension{};
  hid_t dataset = -1;
  std::vector<double> numbers{};
  std::vector<std::int64_t> wholes{};
  std::vector<std::int32_t> codes{};
  std::vector<std::string> words{};  ///< in the order of their first use
  std::map<std::string, std::int32_t, std::less<>> code_of{};
};

struct FileDimension {
  std::string name;
  std::uint64_t most = 0, chunk = 0, rows = 0, waiting = 0;
  std::vector<std::size_t> columns{};
};

hid_t memory_type(ColumnFile::Kind kind) {
  return kind == ColumnFile::Kind::number  ? H5T_NATIVE_DOUBLE
         : kind == ColumnFile::Kind::whole ? H5T_NATIVE_INT64
                                           : H5T_NATIVE_INT32;
}

/// The words of a netCDF attribute are apart by blanks.
std::string flag_word(std::string word) {
  std::ranges::replace(word, ' ', '_');
  return word.empty() ? "empty" : word;
}

}  // namespace

struct ColumnFile::File {
  File(const std::filesystem::path& path, const std::vector<std::pair<std::string, std::string>>& attributes);

  void make();
  void write(FileDimension& dimension);
  void finish();

  hid_t file = -1;
  bool made = false;
  std::vector<FileColumn> columns;
  std::vector<FileDimension> dimensions;

 private:
  Hdf5Id make_dataset(const std::string& name, hid_t type, const FileDimension& dimension) const;
  void make_dimension(FileDimension& dimension, int number);
};

ColumnFile::File::File(const std::filesystem::path& path,
                       const std::vector<std::pair<std::string, std::string>>& attributes) {
  const Hdf5Id creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose), access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  checked(H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  checked(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  checked(H5Pset_obj_track_times(creation, false));
  checked(H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V18));
  checked(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG));
  file = checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access));
  const Hdf5Id root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
  for (const auto& [name, text] : attributes) put_text(root, name.c_str(), text);
}

Hdf5Id ColumnFile::File::make_dataset(const std::string& name, hid_t type, const FileDimension& dimension) const {
  const Hdf5Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose), access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  const hsize_t chunk = dimension.chunk;
  checked(H5Pset_chunk(creation, 1, &chunk));
  checked(H5Pset_alloc_time(creation, H5D_ALLOC_TIME_INCR));
  checked(H5Pset_obj_track_times(creation, false));
  checked(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  checked(H5Pset_shuffle(creation));
  checked(H5Pset_deflate(creation, 1));
  checked(H5Pset_chunk_cache(access, 1, dimension.chunk * sizeof(double), 1.0));
  const hsize_t none = 0, most = std::max<std::uint64_t>(dimension.most, 1);
  const Hdf5Id space(H5Screate_simple(1, &none, &most), H5Sclose);
  return Hdf5Id(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, creation, access), H5Dclose);
}

/// The dimension itself has no numbers; its columns name it and it names them.
void ColumnFile::File::make_dimension(FileDimension& dimension, int number) {
  Hdf5Id own = make_dataset(dimension.name, H5T_IEEE_F32BE, dimension);
  put_scale(own, bare_dimension(number));
  DimensionScale scale{object_reference(file, dimension.name), {}};
  for (const std::size_t i : dimension.columns) {
    FileColumn& column = columns[i];
    const std::string name = dataset_name(column.description.name);
    Hdf5Id dataset = make_dataset(name, memory_type(column.kind), dimension);
    put_column(dataset, column.description);
    put_text(dataset, "sample_dimension", column.sample_dimension);
    put_along(dataset, object_reference(file, name), {&scale});
    column.dataset = dataset;
    dataset.abandon();
  }
  put_users(own, scale);
  own.close();
}

void ColumnFile::File::make() {
  int number = 0;
  for (FileDimension& dimension : dimensions) make_dimension(dimension, number++);
  made = true;
}

void ColumnFile::File::write(FileDimension& dimension) {
  if (!made) make();
  if (dimension.waiting == 0) return;
  const hsize_t first = dimension.rows - dimension.waiting, count = dimension.waiting, rows = dimension.rows;
  const Hdf5Id memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
  for (const std::size_t i : dimension.columns) {
    FileColumn& column = columns[i];
    const void* values = column.kind == Kind::number  ? static_cast<const void*>(column.numbers.data())
                         : column.kind == Kind::whole ? static_cast<const void*>(column.wholes.data())
                                                      : static_cast<const void*>(column.codes.data());
    checked(H5Dset_extent(column.dataset, &rows));
    const Hdf5Id space(H5Dget_space(column.dataset), H5Sclose);
    checked(H5Sselect_hyperslab(space, H5S_SELECT_SET, &first, nullptr, &count, nullptr));
    checked(H5Dwrite(column.dataset, memory_type(column.kind), memory, space, H5P_DEFAULT, values));
    column.numbers.clear();
    column.wholes.clear();
    column.codes.clear();
  }
  dimension.waiting = 0;
}

void ColumnFile::File::finish() {
  if (!made) make();
  for (FileDimension& dimension : dimensions) {
    write(dimension);
    const Hdf5Id own(H5Dopen2(file, dimension.name.c_str(), H5P_DEFAULT), H5Dclose);
    const hsize_t rows = dimension.rows;
    checked(H5Dset_extent(own, &rows));
  }
  for (FileColumn& column : columns) {
    put_words(column.dataset, column.words);
    checked(H5Dclose(std::exchange(column.dataset, -1)));
  }
  checked(H5Fflush(file, H5F_SCOPE_GLOBAL));
  checked(H5Fclose(std::exchange(file, -1)));
}

template <class Act>
void ColumnFile::attempt(Act&& act) {
  const auto fail = [&](const char* reason) {
    if (file_) file_->file = -1;  // no call may be made on a file after one has failed
    throw Error(Error::Category::file, "cannot-write", fmt::format("cannot write '{}': {}", path_.string(), reason));
  };
  const Hdf5Lock lock;
  try {
    require_memory_for_hdf5(4 * most_rows_a_chunk * sizeof(double));
    act();
  } catch (const Hdf5Failure& failure) {
    fail(failure.what());
  } catch (const std::bad_alloc&) {
    fail(std::strerror(ENOMEM));
  }
}

ColumnFile::ColumnFile(std::filesystem::path path, const std::vector<std::pair<std::string, std::string>>& attributes)
    : path_(std::move(path)) {
  attempt([&] { file_ = std::make_unique<File>(path_, attributes); });
}

ColumnFile::~ColumnFile() {
  if (!file_ || file_->file < 0) return;
  const Hdf5Lock lock;
  H5Fclose(file_->file);
}

std::size_t ColumnFile::add_dimension(const std::string& name, std::uint64_t most) {
  const std::uint64_t chunk = std::bit_ceil(std::clamp(most, least_rows_a_chunk, most_rows_a_chunk));
  file_->dimensions.push_back({name, most, chunk});
  return file_->dimensions.size() - 1;
}

std::size_t ColumnFile::add_column(std::size_t dimension, const RecordColumn& column, Kind kind,
                                   const std::string& sample_dimension) {
  file_->columns.push_back({column, kind, sample_dimension});
  file_->dimensions[dimension].columns.push_back(file_->columns.size() - 1);
  return file_->columns.size() - 1;
}

void ColumnFile::put(std::size_t column, double value) { file_->columns[column].numbers.push_back(value); }

void ColumnFile::put_whole(std::size_t column, std::int64_t value) { file_->columns[column].wholes.push_back(value); }

void ColumnFile::put_word(std::size_t column, std::string_view word) {
  FileColumn& target = file_->columns[column];
  auto known = target.code_of.find(word);
  if (known == target.code_of.end()) {
    known = target.code_of.emplace(word, static_cast<std::int32_t>(target.words.size())).first;
    target.words.push_back(flag_word(std::string(word)));
  }
  target.codes.push_back(known->second);
}

void ColumnFile::end_row(std::size_t dimension) {
  FileDimension& ended = file_->dimensions[dimension];
  ++ended.rows;
  if (++ended.waiting == ended.chunk) attempt([&] { file_->write(ended); });
}

void ColumnFile::close() {
  attempt([&] { file_->finish(); });
  const int descriptor = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool good = descriptor >= 0 && (::fdatasync(descriptor) == 0 || errno == EINVAL || errno == EROFS);
  const int reason = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!good) {
    throw Error(Error::Category::file, "cannot-write",
                fmt::format("cannot write '{}': {}", path_.string(), std::strerror(reason)));
  }
}

}  // namespace freeplay
