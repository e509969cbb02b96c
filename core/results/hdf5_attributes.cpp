#include "results/hdf5_attributes.h"

#include <cstddef>

#include <fmt/format.h>

namespace freeplay {
namespace {

void put_attribute(hid_t object, const char* name, hid_t type, hid_t space, const void* value) {
  Hdf5Id attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  checked(H5Awrite(attribute, type, value));
  attribute.close();
}

void put_numbers(hid_t object, const char* name, const std::vector<std::int32_t>& numbers) {
  const hsize_t count = numbers.size();
  const Hdf5Id space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  put_attribute(object, name, H5T_NATIVE_INT32, space, numbers.data());
}

}  // namespace

Hdf5Id string_type(std::size_t size, H5T_cset_t set) {
  Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  checked(H5Tset_size(type, size));
  checked(H5Tset_cset(type, set));
  return type;
}

void put_text(hid_t object, const char* name, const std::string& text) {
  if (text.empty()) return;
  const Hdf5Id type = string_type(text.size(), H5T_CSET_UTF8), space(H5Screate(H5S_SCALAR), H5Sclose);
  put_attribute(object, name, type, space, text.data());
}

void put_scale(hid_t dataset, const std::string& name) {
  const Hdf5Id space(H5Screate(H5S_SCALAR), H5Sclose);
  const std::string scale = "DIMENSION_SCALE";
  put_attribute(dataset, "CLASS", string_type(scale.size() + 1, H5T_CSET_ASCII), space, scale.c_str());
  put_attribute(dataset, "NAME", string_type(name.size() + 1, H5T_CSET_ASCII), space, name.c_str());
}

void put_words(hid_t dataset, const std::vector<std::string>& words) {
  if (words.empty()) return;
  std::vector<std::int32_t> values(words.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::int32_t>(i);
  put_numbers(dataset, "flag_values", values);
  put_text(dataset, "flag_meanings", fmt::format("{}", fmt::join(words, " ")));
}

void put_column(hid_t dataset, const RecordColumn& column) {
  put_text(dataset, "units", column.unit);
  put_text(dataset, "long_name", column.long_name);
  put_text(dataset, "source", column.source);
}

std::string bare_dimension(int number) {
  return fmt::format("This is a netCDF dimension but not a netCDF variable.{:>10}", number);
}

hobj_ref_t object_reference(hid_t group, const std::string& name) {
  hobj_ref_t result{};
  checked(H5Rcreate(&result, group, name.c_str(), H5R_OBJECT, -1));
  return result;
}

void put_along(hid_t dataset, hobj_ref_t self, const std::vector<DimensionScale*>& scales) {
  const Hdf5Id type(H5Tvlen_create(H5T_STD_REF_OBJ), H5Tclose);
  const hsize_t count = scales.size();
  const Hdf5Id space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  std::vector<hvl_t> list;
  for (std::size_t i = 0; i < scales.size(); ++i) {
    list.push_back({1, &scales[i]->self});
    scales[i]->users.push_back({self, static_cast<std::int32_t>(i)});
  }
  put_attribute(dataset, "DIMENSION_LIST", type, space, list.data());
}

void put_users(hid_t dataset, const DimensionScale& scale) {
  if (scale.users.empty()) return;
  const Hdf5Id type(H5Tcreate(H5T_COMPOUND, sizeof(DimensionScale::User)), H5Tclose);
  checked(H5Tinsert(type, "dataset", offsetof(DimensionScale::User, dataset), H5T_STD_REF_OBJ));
  checked(H5Tinsert(type, "dimension", offsetof(DimensionScale::User, dimension), H5T_NATIVE_INT32));
  const hsize_t count = scale.users.size();
  const Hdf5Id space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  put_attribute(dataset, "REFERENCE_LIST", type, space, scale.users.data());
}

}  // namespace freeplay
