#include "results/hdf5_layout.h"

#include <cstdint>
#include <limits>
#include <numbers>
#include <span>

#include "results/hdf5_writer.h"

namespace freeplay {
namespace {

constexpr BearingQuantity quantities[] = {
    {"contact_time", "s", "time in contact by bearing sector"},
    {"impulse", "N*s", "impulse of the normal force by bearing sector"},
    {"sliding", "m", "sliding distance by bearing sector"},
    {"work", "J", "work of normal force over sliding by bearing sector"},
    {"pv_mean", "Pa*m/s", "mean pressure-velocity product by bearing sector"},
    {"pv_max", "Pa*m/s", "largest pressure-velocity product by bearing sector"},
};

}  // namespace

std::span<const BearingQuantity> bearing_quantities() { return quantities; }

Hdf5Id Hdf5Layout::make_dataset(hid_t group, const std::string& name, hid_t type, std::vector<hsize_t> size,
                                hsize_t per_chunk, const void* fill) const {
  const Hdf5Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  std::vector<hsize_t> most = size, chunks = size;
  most[0] = H5S_UNLIMITED;
  chunks[0] = per_chunk;
  const int rank = static_cast<int>(size.size());
  checked(H5Pset_chunk(creation, rank, chunks.data()));
  if (fill != nullptr) checked(H5Pset_fill_value(creation, type, fill));
  checked(H5Pset_alloc_time(creation, H5D_ALLOC_TIME_INCR));
  checked(H5Pset_obj_track_times(creation, false));
  checked(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  if (!grows) {
    checked(H5Pset_shuffle(creation));
    checked(H5Pset_deflate(creation, 1));
  }
  const Hdf5Id space(H5Screate_simple(rank, size.data(), most.data()), H5Sclose);
  return Hdf5Id(H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
}

Hdf5Id Hdf5Layout::make_column(hid_t group, const RecordColumn& column, hsize_t per_chunk,
                               DimensionScale* scale) const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::string name = dataset_name(column.name);
  Hdf5Id dataset = make_dataset(group, name, H5T_NATIVE_DOUBLE, {0}, per_chunk, &none);
  put_column(dataset, column);
  if (scale != nullptr) put_along(dataset, object_reference(group, name), {scale});
  return dataset;
}

void Hdf5Layout::make() const {
  const Hdf5Id root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
  for (const auto& [name, text] : layout.attributes) put_text(root, name.c_str(), text);
  Hdf5Id time = make_column(root, layout.columns.front(), chunk, nullptr);
  put_scale(time, "time");
  DimensionScale along_time{object_reference(root, "time"), {}};
  for (const RecordColumn& column : std::span(layout.columns).subspan(1)) {
    make_column(root, column, chunk, &along_time).close();
  }
  put_users(time, along_time);
  time.close();

  Hdf5Id length = make_dataset(root, "summary_length", H5T_IEEE_F32BE, {0}, summary_chunk, nullptr);
  put_column(length, {"summary_length", "1", "number of characters of the summary", "text of summary.json"});
  put_scale(length, bare_dimension(0));
  DimensionScale along_length{object_reference(root, "summary_length"), {}};
  const Hdf5Id letter = string_type(1, H5T_CSET_ASCII);
  Hdf5Id summary = make_dataset(root, "summary", letter, {0}, summary_chunk, nullptr);
  put_column(summary, {"summary", "1", "what the run came to, as JSON", "text of summary.json"});
  put_along(summary, object_reference(root, "summary"), {&along_length});
  put_users(length, along_length);
  length.close();
  summary.close();

  const Hdf5Id creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  checked(H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  checked(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  Hdf5Id of_events(H5Gcreate2(root, "events", H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose);
  make_events(of_events);
  of_events.close();
  Hdf5Id of_bearing(H5Gcreate2(root, "bearing", H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose);
  make_bearing(of_bearing);
  of_bearing.close();
}

void Hdf5Layout::make_events(hid_t group) const {
  Hdf5Id counter = make_dataset(group, "event", H5T_IEEE_F32BE, {0}, event_chunk, nullptr);
  put_column(counter, {"event", "1", "number of events", "events of joints"});
  put_scale(counter, bare_dimension(0));
  DimensionScale along_event{object_reference(group, "event"), {}};
  constexpr std::int32_t none = -1;
  for (std::size_t i = 0; i < layout.events.size(); ++i) {
    const RecordColumn& column = layout.events[i];
    if (i == 0 || i >= first_field) {
      make_column(group, column, event_chunk, &along_event).close();
      continue;
    }
    Hdf5Id dataset = make_dataset(group, column.name, H5T_NATIVE_INT32, {0}, event_chunk, &none);
    put_column(dataset, column);
    put_words(dataset, i == 1 ? layout.joints : layout.kinds);
    put_along(dataset, object_reference(group, column.name), {&along_event});
    dataset.close();
  }
  put_users(counter, along_event);
  counter.close();
}

void Hdf5Layout::make_bearing(hid_t group) const {
  const hsize_t sectors = bearing_sectors;
  const Hdf5Id space(H5Screate_simple(1, &sectors, nullptr), H5Sclose);
  const Hdf5Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  checked(H5Pset_obj_track_times(creation, false));
  checked(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  Hdf5Id angle(H5Dcreate2(group, "angle", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
  std::vector<double> centres(bearing_sectors);
  for (std::size_t k = 0; k < centres.size(); ++k) {
    centres[k] = (static_cast<double>(k) + 0.5) * (2.0 * std::numbers::pi / static_cast<double>(bearing_sectors));
  }
  checked(H5Dwrite(angle, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, centres.data()));
  put_column(angle, {"angle", "rad", "centre of the bearing sector", "72 sectors of the bearing"});
  put_scale(angle, "angle");
  constexpr std::int32_t no_joint = -1;
  Hdf5Id joint = make_dataset(group, "joint", H5T_NATIVE_INT32, {0}, bearing_chunk, &no_joint);
  put_column(joint, {"joint", "1", "joint with play", "the model"});
  put_words(joint, layout.bearings);
  put_scale(joint, "joint");
  DimensionScale along_joint{object_reference(group, "joint"), {}}, along_angle{object_reference(group, "angle"), {}};
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (const BearingQuantity& quantity : quantities) {
    Hdf5Id table = make_dataset(group, quantity.name, H5T_NATIVE_DOUBLE, {0, bearing_sectors}, bearing_chunk, &none);
    put_column(table, {quantity.name, quantity.unit, quantity.long_name, "integrals over accepted steps"});
    put_along(table, object_reference(group, quantity.name), {&along_joint, &along_angle});
    table.close();
  }
  put_users(joint, along_joint);
  put_users(angle, along_angle);
  joint.close();
  angle.close();
}

}  // namespace freeplay
