#include "results/hdf5_reader.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"
#include "results/hdf5_call.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr hsize_t block_rows = 4096;                        // a multiple of any chunk
constexpr std::size_t most_numbers = std::size_t{1} << 20;  // of a block
// The library waits 1 ns, 2 ns, 4 ns ... for what does not fit its checksum, as while it is written: half a second in
// all, where its own hundred attempts would never end in a damaged file.
constexpr unsigned most_attempts = 29;

herr_t note_name(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

/// Text of a fixed or a variable length; empty without.
std::string text_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return {};
  const Hdf5Id attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose), type(H5Aget_type(attribute), H5Tclose);
  if (H5Tget_class(type) != H5T_STRING) return {};
  if (checked(H5Tis_variable_str(type)) > 0) {
    char* text = nullptr;
    checked(H5Aread(attribute, type, &text));
    std::string result = text != nullptr ? text : "";
    H5free_memory(text);
    return result;
  }
  std::string text(H5Tget_size(type), '\0');
  checked(H5Aread(attribute, type, text.data()));
  return text.substr(0, text.find('\0'));
}

std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> list;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    if (end > at) list.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return list;
}

template <class Act>
auto guarded(const std::string& file, Act&& act) {
  const Hdf5Lock lock;
  require_memory_for_hdf5();
  try {
    return act();
  } catch (const Hdf5Failure& failure) {
    unreadable_result(file, failure.what(), 0, what_to_do_with_a_damaged_file);
  }
}

hsize_t length(hid_t dataset) {
  const Hdf5Id space(H5Dget_space(dataset), H5Sclose);
  hsize_t size[H5S_MAX_RANK] = {0};
  return checked(H5Sget_simple_extent_dims(space, size, nullptr)) == 1 ? size[0] : 0;
}

/// The first `count` numbers of each of some datasets.
class Hdf5Rows : public RowSource {
 public:
  Hdf5Rows(std::string file, std::vector<Hdf5Id> datasets, hsize_t count)
      : file_(std::move(file)), datasets_(std::move(datasets)), count_(count) {
    const hsize_t most = std::max<hsize_t>(most_numbers / datasets_.size() / block_rows, 1) * block_rows;
    column_.resize(std::min(most, count_));
    block_.resize(column_.size() * datasets_.size());
  }
  ~Hdf5Rows() override {
    const Hdf5Lock lock;
    datasets_.clear();
  }

  std::span<const double> next() override {
    const hsize_t some = std::min<hsize_t>(column_.size(), count_ - first_);
    if (some > 0) guarded(file_, [&] { read(some); });
    first_ += some;
    return std::span<const double>(block_).first(some * datasets_.size());
  }

 private:
  void read(hsize_t some) {
    const std::size_t width = datasets_.size();
    const Hdf5Id memory(H5Screate_simple(1, &some, nullptr), H5Sclose);
    for (std::size_t c = 0; c < width; ++c) {
      const Hdf5Id space(H5Dget_space(datasets_[c]), H5Sclose);
      if (length(datasets_[c]) < first_ + some) throw Hdf5Failure("a dataset is shorter than 'time'");
      checked(H5Sselect_hyperslab(space, H5S_SELECT_SET, &first_, nullptr, &some, nullptr));
      checked(H5Dread(datasets_[c], H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, column_.data()));
      for (hsize_t r = 0; r < some; ++r) block_[r * width + c] = column_[r];
    }
  }

  const std::string file_;
  std::vector<Hdf5Id> datasets_;
  const hsize_t count_;
  hsize_t first_ = 0;  // row of the next block
  std::vector<double> column_, block_;
};

class Hdf5File : public OpenHdf5 {
 public:
  explicit Hdf5File(const fs::path& path) : OpenHdf5(path.string()) {
    guarded(file_, [&] {
      open_file();
      read_layout();
    });
  }
  ~Hdf5File() override {
    const Hdf5Lock lock;
    Hdf5Id last = std::move(id_);
  }

  bool sealed() const override { return sealed_; }

  std::unique_ptr<RowSource> open_rows(std::span<const std::size_t> columns) override {
    return guarded(file_, [&] {
      require_memory_for_hdf5(2 * block_rows * sizeof(double) * columns.size());  // a chunk of each is kept
      std::vector<Hdf5Id> datasets;
      for (const std::size_t column : columns)
        datasets.push_back(open("/" + dataset_name(layout_.columns[column].name)));
      return std::make_unique<Hdf5Rows>(file_, std::move(datasets), row_count_);
    });
  }

  std::unique_ptr<RowSource> open_events() override {
    if (layout_.events.empty()) unreadable_result(file_, "it has no events");
    return guarded(file_, [&] {
      std::vector<Hdf5Id> datasets;
      for (const RecordColumn& column : layout_.events) datasets.push_back(open("/events/" + column.name));
      return std::make_unique<Hdf5Rows>(file_, std::move(datasets), event_count_);
    });
  }

  std::vector<double> bearing(const std::string& quantity) override {
    std::vector<double> numbers;
    guarded(file_, [&] {
      const Hdf5Id table = open("/bearing/" + quantity), space(H5Dget_space(table), H5Sclose);
      numbers.resize(static_cast<std::size_t>(std::max<hssize_t>(H5Sget_simple_extent_npoints(space), 0)));
      if (numbers.empty()) return;
      checked(H5Dread(table, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()));
    });
    return numbers;
  }

  std::string summary() override {
    std::string text;
    guarded(file_, [&] {
      if (H5Lexists(id_, "summary", H5P_DEFAULT) <= 0) return;
      const Hdf5Id letters(H5Dopen2(id_, "/summary", H5P_DEFAULT), H5Dclose), type(H5Dget_type(letters), H5Tclose);
      if (H5Tget_class(type) != H5T_STRING || H5Tget_size(type) != 1) return;
      text.resize(static_cast<std::size_t>(length(letters)));
      if (!text.empty()) checked(H5Dread(letters, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()));
    });
    return text;
  }

 private:
  // A file that is written, or whose writer was killed, is open for one that reads along with it.
  void open_file() {
    const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    checked(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG));
    checked(H5Pset_file_locking(access, false, true));
    const hid_t plain = H5Fopen(file_.c_str(), H5F_ACC_RDONLY, access);
    sealed_ = plain >= 0;
    checked(H5Pset_metadata_read_attempts(access, most_attempts));
    id_ = Hdf5Id(plain >= 0 ? plain : H5Fopen(file_.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access), H5Fclose);
  }

  Hdf5Id open(const std::string& name) const {
    const Hdf5Id access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
    checked(H5Pset_chunk_cache(access, 1, block_rows * sizeof(double), 1.0));
    return Hdf5Id(H5Dopen2(id_, name.c_str(), access), H5Dclose);
  }

  std::vector<std::string> names(const char* group_name) const {
    const Hdf5Id group(H5Gopen2(id_, group_name, H5P_DEFAULT), H5Gclose);
    std::vector<std::string> names;
    hsize_t at = 0;
    if (H5Literate(group, H5_INDEX_CRT_ORDER, H5_ITER_INC, &at, note_name, &names) < 0) {
      names.clear();
      at = 0;
      checked(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, &at, note_name, &names));
    }
    return names;
  }

  // Lengths first: what comes later has at least as many rows.
  void read_layout() {
    if (H5Lexists(id_, "time", H5P_DEFAULT) <= 0) throw Hdf5Failure("it has no dataset 'time'");
    row_count_ = length(open("/time"));
    const bool events = H5Lexists(id_, "events", H5P_DEFAULT) > 0 && H5Lexists(id_, "events/event", H5P_DEFAULT) > 0;
    if (events) event_count_ = length(open("/events/event"));
    add_columns("/", layout_.columns);
    if (events) add_columns("/events", layout_.events);
    const auto time = std::ranges::find(layout_.columns, "time", &RecordColumn::name);
    if (time == layout_.columns.end()) throw Hdf5Failure("'time' is no list of numbers");
    std::rotate(layout_.columns.begin(), time, time + 1);
    if (H5Lexists(id_, "bearing", H5P_DEFAULT) > 0 && H5Lexists(id_, "bearing/joint", H5P_DEFAULT) > 0) {
      layout_.bearings = words(text_attribute(open("/bearing/joint"), "flag_meanings"));
    }
    const Hdf5Id root(H5Gopen2(id_, "/", H5P_DEFAULT), H5Gclose);
    for (const char* name :
         {"Conventions", "title", "freeplay_version", "model", "model_sha256", "inputs", "settings", "provenance"}) {
      if (std::string text = text_attribute(root, name); !text.empty())
        layout_.attributes.emplace_back(name, std::move(text));
    }
  }

  /// Lists of numbers; those of words, as joints and kinds of events, too.
  void add_columns(const std::string& group, std::vector<RecordColumn>& columns) {
    for (const std::string& name : names(group.c_str())) {
      const std::string path = (group == "/" ? "" : group) + "/" + name;
      H5O_info_t info;
      checked(H5Oget_info_by_name1(id_, path.c_str(), &info, H5P_DEFAULT));
      if (info.type != H5O_TYPE_DATASET) continue;
      const Hdf5Id dataset = open(path), type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
      const H5T_class_t kind = H5Tget_class(type);
      if (H5Sget_simple_extent_ndims(space) != 1 || (kind != H5T_FLOAT && kind != H5T_INTEGER)) continue;
      const std::string label = text_attribute(dataset, "NAME");
      if (label.starts_with("This is a netCDF dimension but not a netCDF variable")) continue;
      const std::string unit = text_attribute(dataset, "units");
      std::string channel = name;
      if (channel.starts_with("frame.")) std::ranges::replace(channel, ':', '/');
      columns.push_back({channel, unit, text_attribute(dataset, "long_name"), text_attribute(dataset, "source")});
      if (group != "/events") continue;
      if (name == "joint") layout_.joints = words(text_attribute(dataset, "flag_meanings"));
      if (name == "kind") layout_.kinds = words(text_attribute(dataset, "flag_meanings"));
    }
  }

  Hdf5Id id_;
  bool sealed_ = false;
  hsize_t row_count_ = 0, event_count_ = 0;
};

}  // namespace

std::unique_ptr<OpenHdf5> open_hdf5_here(const fs::path& path) { return std::make_unique<Hdf5File>(path); }

}  // namespace freeplay
