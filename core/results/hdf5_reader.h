// OpenHdf5: an HDF5 file that is read in this process.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "results/reader.h"

namespace freeplay {

inline constexpr const char* what_to_do_with_a_damaged_file = "take a whole copy of it, or run the model again";

class OpenHdf5 : public ResultReader {
 public:
  virtual std::unique_ptr<RowSource> open_events() = 0;
  void events(const Take& take) override {
    const std::unique_ptr<RowSource> source = open_events();
    for (auto block = source->next(); !block.empty(); block = source->next()) take(block);
  }

 protected:
  explicit OpenHdf5(std::string file) : ResultReader(std::move(file)) {}
};

/// A damaged file may crash the library, and with it the program: open_hdf5() keeps that away. Throws as
/// ResultReader::open() does.
std::unique_ptr<OpenHdf5> open_hdf5_here(const std::filesystem::path& path);

}  // namespace freeplay
