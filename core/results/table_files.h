// TableFiles: a table of a result as text, JSON, HDF5 or MAT.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "base/json_text.h"
#include "results/table_view.h"

namespace freeplay {

using TakeText = std::function<void(std::string_view)>;

/// As results.csv and events.csv are.
void give_csv(TableView& table, const TakeText& take);

/// `{"table", "columns", "units", "rows", "summary", "provenance"}`, a row a line.
void give_json(TableView& table, const std::string& name, const Json& summary, const Json& provenance,
               const TakeText& take);

/// Compressed, for every reader of HDF5 1.8 and netCDF-4: rows of the table, all events. Throws Error{file}.
void write_hdf5(TableView& table, ResultReader& reader, const Json& provenance, const std::filesystem::path& path);

/// MAT-file of level 5. Throws Error{usage} "too-large" beyond 2 GiB, Error{file}.
void write_mat(TableView& table, const Json& provenance, const std::filesystem::path& path);

}  // namespace freeplay
