#include "results/hdf5_writer.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <new>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/whole_file.h"
#include "results/hdf5_attributes.h"
#include "results/hdf5_call.h"
#include "results/hdf5_headers.h"
#include "results/hdf5_layout.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr hsize_t least_chunk = 64, largest_chunk = 1024;
constexpr std::size_t enough_to_flush = 1 << 18;  // bytes of rows
// Columns written between flushes: the library's own time for one grows with the square of what waits for it.
constexpr std::size_t most_unflushed = 512;

void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool good = descriptor >= 0 && (::fsync(descriptor) == 0 || errno == EINVAL);
  const int reason = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!good) throw Hdf5Failure(std::strerror(reason));
}

}  // namespace

/// The open file. Members hold plain handles: closing the file closes them, and after a failure nothing is.
struct Hdf5Writer::File {
  File(const fs::path& path, const RecordLayout& layout, const Options& options);

  void write(const RecordBlock& block);
  void flush();
  void finish(const BearingTables& tables, const std::string& summary);
  void sync() const;
  void put_in_place();
  /// Throws Hdf5Failure where another program changed the file since the last call. Asked after every write, for the
  /// next one may make a file that was cut as long as it had been.
  void look();

  const fs::path path, part;
  const RecordLayout& layout;
  const bool grows;
  const hsize_t chunk;
  ino_t inode = 0;  // of a file that grows
  dev_t device = 0;
  bool disturbed = false;  // by another program
  hid_t file = -1;
  std::vector<hid_t> columns, event_columns;
  hid_t event = -1;
  HeldRows held;

 private:
  void make(hid_t access);
  hid_t open_dataset(const std::string& name) const { return checked(H5Dopen2(file, name.c_str(), H5P_DEFAULT)); }
  hid_t column(std::size_t c);
  void write_columns();
  void write_events();
  static void extend(hid_t dataset, hsize_t size) { checked(H5Dset_extent(dataset, &size)); }
  static void put(hid_t dataset, hid_t type, hsize_t first, hsize_t count, const void* numbers);

  std::vector<double> waiting;  // of the chunk in hand, column by column
  hsize_t rows = 0;             // all
  hsize_t in_chunk = 0, done_in_chunk = 0;
  std::vector<double> times;  // not yet written: rows are complete as far as they are
  std::vector<double> events;
  hsize_t events_written = 0;
  std::int64_t size = 0;  // bytes at the last look
};

Hdf5Writer::File::File(const fs::path& p, const RecordLayout& l, const Options& options)
    : path(p),
      part(options.grows ? part_of(p) : p),
      layout(l),
      grows(options.grows),
      chunk(std::clamp<hsize_t>(std::bit_ceil(options.expected_rows), least_chunk, largest_chunk)) {
  const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  checked(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG));
  checked(H5Pset_file_locking(access, false, true));
  checked(H5Pset_cache(access, 0, 1, chunk * sizeof(double), 1.0));  // one chunk of each dataset
  make(access);
  if (grows && !options.named_later) put_in_place();
  columns.push_back(open_dataset(layout.columns.front().name));
  for (const RecordColumn& one : layout.events) event_columns.push_back(open_dataset("events/" + one.name));
  event = open_dataset("events/event");
  waiting.resize(layout.columns.size() * chunk);
}

/// A file that others read while it is written is closed in between: what making it took is given back, and headers
/// come back in the order of the columns, with those of their chunks beside them, which makes H5Fclose() quick.
void Hdf5Writer::File::make(hid_t access) {
  const Hdf5Id creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  checked(H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  checked(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  checked(grows ? H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110)
                : H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V18));
  file = checked(H5Fcreate(part.c_str(), H5F_ACC_TRUNC, creation, access));
  Hdf5Layout{file, layout, grows, chunk}.make();
  if (!grows) {
    checked(H5Fflush(file, H5F_SCOPE_GLOBAL));
    return;
  }
  checked(H5Fclose(std::exchange(file, -1)));
  keep_headers(access);
  file = checked(H5Fopen(part.c_str(), H5F_ACC_RDWR | H5F_ACC_SWMR_WRITE, access));
}

void Hdf5Writer::File::look() {
  if (inode == 0) return;
  struct stat there {};
  const bool same = ::stat(path.c_str(), &there) == 0 && there.st_ino == inode && there.st_dev == device;
  disturbed = !same || there.st_size < size;
  if (disturbed) {
    throw Hdf5Failure(same ? "another program cut it while it was written"
                           : "it was removed or replaced while it was written");
  }
  size = there.st_size;
}

void Hdf5Writer::File::put_in_place() {
  struct stat made {};
  if (::stat(part.c_str(), &made) != 0) throw Hdf5Failure(std::strerror(errno));
  inode = made.st_ino;
  device = made.st_dev;
  if (::rename(part.c_str(), path.c_str()) != 0) throw Hdf5Failure(std::strerror(errno));
  sync_folder(path.parent_path());
}

/// Opened when it is first written.
hid_t Hdf5Writer::File::column(std::size_t c) {
  while (columns.size() <= c) columns.push_back(open_dataset(dataset_name(layout.columns[columns.size()].name)));
  return columns[c];
}

void Hdf5Writer::File::put(hid_t dataset, hid_t type, hsize_t first, hsize_t count, const void* numbers) {
  const Hdf5Id memory(H5Screate_simple(1, &count, nullptr), H5Sclose), space(H5Dget_space(dataset), H5Sclose);
  checked(H5Sselect_hyperslab(space, H5S_SELECT_SET, &first, nullptr, &count, nullptr));
  checked(H5Dwrite(dataset, type, memory, space, H5P_DEFAULT, numbers));
}

void Hdf5Writer::File::write(const RecordBlock& block) {
  const std::size_t width = layout.columns.size();
  for (std::size_t at = 0; at < block.rows.size(); at += width) {
    times.push_back(block.rows[at]);
    for (std::size_t c = 1; c < width; ++c) waiting[c * chunk + in_chunk] = block.rows[at + c];
    ++rows;
    if (++in_chunk < chunk) continue;
    write_columns();
    if (grows && times.size() * width * sizeof(double) >= enough_to_flush) flush();
  }
  events.insert(events.end(), block.events.begin(), block.events.end());
}

/// All but the time of what waits.
void Hdf5Writer::File::write_columns() {
  const hsize_t count = in_chunk - done_in_chunk, first = rows - count;
  for (std::size_t c = 1; c < layout.columns.size() && count > 0; ++c) {
    extend(column(c), rows);
    put(column(c), H5T_NATIVE_DOUBLE, first, count, waiting.data() + c * chunk + done_in_chunk);
    if (grows && c % most_unflushed == 0) checked(H5Fflush(file, H5F_SCOPE_GLOBAL));
    look();
  }
  done_in_chunk = in_chunk;
  if (in_chunk == chunk) in_chunk = done_in_chunk = 0;
}

void Hdf5Writer::File::write_events() {
  const std::size_t width = event_columns.size();
  if (events.empty()) return;
  const hsize_t count = events.size() / width;
  std::vector<double> column(count);
  std::vector<std::int32_t> indices(count);
  for (std::size_t c = 0; c < width && count > 0; ++c) {
    for (std::size_t i = 0; i < count; ++i) column[i] = events[i * width + c];
    extend(event_columns[c], events_written + count);
    if (c == 0 || c >= first_field) {
      put(event_columns[c], H5T_NATIVE_DOUBLE, events_written, count, column.data());
      continue;
    }
    for (std::size_t i = 0; i < count; ++i) indices[i] = static_cast<std::int32_t>(column[i]);
    put(event_columns[c], H5T_NATIVE_INT32, events_written, count, indices.data());
  }
  events_written += count;
  events.clear();
}

/// A kill may come at any instant: what says how many rows and events are complete follows them. H5Fflush() goes on
/// where numbers cannot be written, and would leave instants without them: H5Dflush() ends there.
void Hdf5Writer::File::flush() {
  if (times.empty() && events.empty()) return;
  const bool some_events = !events.empty();
  write_columns();
  write_events();
  checked(H5Fflush(file, H5F_SCOPE_GLOBAL));
  look();
  if (!times.empty()) {
    extend(columns.front(), rows);
    put(columns.front(), H5T_NATIVE_DOUBLE, rows - times.size(), times.size(), times.data());
    checked(H5Dflush(columns.front()));
    look();
  }
  if (some_events) extend(event, events_written);
  checked(H5Fflush(file, H5F_SCOPE_GLOBAL));
  if (!times.empty()) held = {static_cast<long>(rows), times.back()};
  times.clear();
}

void Hdf5Writer::File::sync() const {
  const int descriptor = ::open((inode != 0 || !grows ? path : part).c_str(), O_RDONLY | O_CLOEXEC);
  const bool good = descriptor >= 0 && (::fdatasync(descriptor) == 0 || errno == EINVAL || errno == EROFS);
  const int reason = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!good) throw Hdf5Failure(std::strerror(reason));
}

void Hdf5Writer::File::finish(const BearingTables& tables, const std::string& summary) {
  flush();
  if (!tables.empty() && !layout.bearings.empty()) {
    const hsize_t count = layout.bearings.size();
    std::vector<std::int32_t> joints(count);
    for (std::size_t i = 0; i < joints.size(); ++i) joints[i] = static_cast<std::int32_t>(i);
    for (const auto& [name, numbers] : tables) {
      const hid_t table = open_dataset("bearing/" + name);
      const hsize_t size[] = {count, bearing_sectors};
      checked(H5Dset_extent(table, size));
      checked(H5Dwrite(table, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()));
    }
    const hid_t joint = open_dataset("bearing/joint");
    extend(joint, count);
    put(joint, H5T_NATIVE_INT32, 0, count, joints.data());
  }
  if (!summary.empty()) {
    const hid_t text = open_dataset("summary"), length = open_dataset("summary_length");
    extend(text, summary.size());
    put(text, string_type(1, H5T_CSET_ASCII), 0, summary.size(), summary.data());
    extend(length, summary.size());
  }
  checked(H5Fflush(file, H5F_SCOPE_GLOBAL));
  look();
  checked(H5Fclose(std::exchange(file, -1)));
  size = 0;  // the library may give space back
  sync();
}

Hdf5Writer::Hdf5Writer(fs::path path, const RecordLayout& layout, const Options& options)
    : path_(std::move(path)), layout_(layout), options_(options) {}

// Closing is for finish(): a file that was not ended stays as it was flushed.
Hdf5Writer::~Hdf5Writer() {
  if (file_ != nullptr && file_->file >= 0 && failure_.empty()) {
    const Hdf5Lock lock;
    H5Fclose(file_->file);
  }
  std::error_code ignored;
  if (options_.named_later && file_ != nullptr && file_->inode == 0) fs::remove(file_->part, ignored);
}

void Hdf5Writer::fail(const char* reason) {
  failure_ = words(reason);
  std::error_code ignored;
  fs::remove(part_of(path_), ignored);
  if (file_ == nullptr) return;
  try {
    file_->sync();                // what was handed over before is to stay
  } catch (const Hdf5Failure&) {  // the first failure is the one to report
  }
}

bool Hdf5Writer::placed() const { return file_ != nullptr && file_->inode != 0; }

template <class Act>
void Hdf5Writer::attempt(Act&& act) {
  look_after();  // more rows would hide what another program cut
  if (!failure_.empty()) return;
  const Hdf5Lock lock;
  try {
    require_memory_for_hdf5(2 * largest_chunk * sizeof(double) * layout_.columns.size());  // one chunk of each is kept
    if (file_ == nullptr) file_ = std::make_unique<File>(path_, layout_, options_);
    act(*file_);
    file_->look();
  } catch (const Hdf5Failure& failure) {
    look_after();  // a file that was cut fails in the library, too
    if (failure_.empty()) fail(failure.what());
  } catch (const std::bad_alloc&) {
    fail(std::strerror(ENOMEM));
  }
  if (file_ != nullptr) held_ = file_->held;
}

void Hdf5Writer::write(const RecordBlock& block) {
  attempt([&](File& file) { file.write(block); });
}

void Hdf5Writer::flush() {
  attempt([](File& file) { file.flush(); });
}

void Hdf5Writer::sync() {
  attempt([](File& file) {
    file.flush();
    file.sync();
  });
}

void Hdf5Writer::put_in_place() {
  attempt([](File& file) {
    file.flush();
    file.sync();
    file.put_in_place();
  });
}

void Hdf5Writer::look_after() {
  if (file_ == nullptr || !failure_.empty()) return;
  try {
    file_->look();
  } catch (const Hdf5Failure& failure) {
    failure_ = words(failure.what());
  }
}

bool Hdf5Writer::disturbed() const { return file_ != nullptr && file_->disturbed; }

std::string Hdf5Writer::words(const char* reason) const {
  return fmt::format("cannot write '{}': {}", path_.string(), reason);
}

void Hdf5Writer::finish(const BearingTables& tables, const std::string& summary) {
  attempt([&](File& file) { file.finish(tables, summary); });
}

}  // namespace freeplay
