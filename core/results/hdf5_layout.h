// Hdf5Layout: what a file of results has before its first row.
#pragma once

#include <string>
#include <vector>

#include "results/hdf5_attributes.h"
#include "results/hdf5_call.h"
#include "results/record.h"

namespace freeplay {

inline constexpr hsize_t event_chunk = 256, summary_chunk = 8192, bearing_chunk = 16;
inline constexpr std::size_t first_field = 3;  // of events: after time, joint and kind

/// Makes the groups, datasets and attributes of docs/results.md in an open file that has none; all are empty but for
/// the centres of the bearing sectors. Throws Hdf5Failure.
struct Hdf5Layout {
  const hid_t file;
  const RecordLayout& layout;
  const bool grows;     ///< else chunks are compressed
  const hsize_t chunk;  ///< rows of a chunk of a column

  void make() const;

 private:
  void make_events(hid_t group) const;
  void make_bearing(hid_t group) const;
  Hdf5Id make_dataset(hid_t group, const std::string& name, hid_t type, std::vector<hsize_t> size, hsize_t per_chunk,
                      const void* fill) const;
  Hdf5Id make_column(hid_t group, const RecordColumn& column, hsize_t per_chunk, DimensionScale* scale) const;
};

}  // namespace freeplay
