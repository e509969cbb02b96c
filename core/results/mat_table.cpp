#include "results/mat_table.h"

#include <memory>
#include <string_view>

#include <matio.h>

#include "results/reader.h"

namespace freeplay {
namespace {

using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

std::size_t bytes_of(const matvar_t& variable) { return variable.data == nullptr ? 0 : variable.nbytes; }

std::string text_in(const matvar_t* variable) {
  if (variable == nullptr || variable->class_type != MAT_C_CHAR || variable->data_size != 1) return {};
  return {static_cast<const char*>(variable->data), bytes_of(*variable)};
}

std::vector<std::string> words_in(const matvar_t& variable) {
  std::vector<std::string> words;
  if (variable.class_type != MAT_C_CELL || variable.data == nullptr) return words;
  const auto* cells = static_cast<matvar_t* const*>(variable.data);
  for (std::size_t i = 0; i < variable.nbytes / sizeof(void*); ++i) words.push_back(text_in(cells[i]));
  return words;
}

std::vector<double> numbers_in(const matvar_t& variable) {
  if (variable.class_type != MAT_C_DOUBLE || variable.data_type != MAT_T_DOUBLE || variable.isComplex != 0) return {};
  const auto* first = static_cast<const double*>(variable.data);
  return {first, first + bytes_of(variable) / sizeof(double)};
}

}  // namespace

MatTable read_mat(const std::filesystem::path& path) {
  const std::unique_ptr<mat_t, decltype(&Mat_Close)> file(Mat_Open(path.c_str(), MAT_ACC_RDONLY), Mat_Close);
  if (file == nullptr) unreadable_result(path.string(), "it is no MAT-file that can be read");
  MatTable table;
  for (;;) {
    const Variable variable(Mat_VarReadNext(file.get()), Mat_VarFree);
    if (variable == nullptr || variable->name == nullptr) break;
    const std::string_view name = variable->name;
    if (name == "time") table.time = numbers_in(*variable);
    if (name == "data") table.data = numbers_in(*variable);
    if (name == "channels") table.channels = words_in(*variable);
    if (name == "units") table.units = words_in(*variable);
    if (name == "provenance") table.provenance = text_in(variable.get());
  }
  return table;
}

}  // namespace freeplay
