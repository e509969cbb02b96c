// Hdf5Attributes: what HDF5 and netCDF read beside the numbers of a dataset.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "results/hdf5_call.h"
#include "results/record.h"

namespace freeplay {

/// Fixed length.
Hdf5Id string_type(std::size_t size, H5T_cset_t set);
/// Fixed length, as long as its bytes; an empty one is left out.
void put_text(hid_t object, const char* name, const std::string& text);
/// What makes a dataset a dimension for HDF5 and netCDF: with a null at the end.
void put_scale(hid_t dataset, const std::string& name);
/// The words that its numbers stand for.
void put_words(hid_t dataset, const std::vector<std::string>& words);
/// Unit, phrase and source.
void put_column(hid_t dataset, const RecordColumn& column);
/// What netCDF calls a dimension that is no variable; `number` tells those of one file apart.
std::string bare_dimension(int number);

/// A dimension and the datasets along it.
struct DimensionScale {
  hobj_ref_t self;
  struct User {
    hobj_ref_t dataset;
    std::int32_t dimension;
  };
  std::vector<User> users;
};

hobj_ref_t object_reference(hid_t group, const std::string& name);
/// Lists on both sides, each in one go.
void put_along(hid_t dataset, hobj_ref_t self, const std::vector<DimensionScale*>& scales);
void put_users(hid_t dataset, const DimensionScale& scale);

}  // namespace freeplay
