// KeptPart: what stays of a result whose run goes on, or that is sealed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "base/sha256.h"
#include "model/model.h"
#include "results/hdf5_writer.h"
#include "results/record.h"
#include "results/row_hash.h"

namespace freeplay {

/// How many rows and events stay, and their fingerprints: those of RowHash and of the text of events.csv.
struct KeptPart {
  std::int64_t rows = 0, events = 0;
  std::string row_digits{}, event_digits{};
};

/// Writers that hold what was kept.
struct KeptFiles {
  std::unique_ptr<RowHash> row_hash;
  Sha256 event_text;
  std::unique_ptr<Hdf5Writer> hdf5;               ///< under a temporary name; null without
  std::uintmax_t row_bytes = 0, event_bytes = 0;  ///< of the text files
  HeldRows text_rows;                             ///< of results.csv
};

/// Reads the kept part of the files in `directory` and copies that of results.h5 into a new file. Changes none of those
/// that are there. Throws Error{file} "bad-checkpoint" where one holds less, other columns, or other numbers.
[[gnu::cold]] KeptFiles read_kept(const std::filesystem::path& directory, const KeptPart& part, ResultFormat format,
                                  const RecordLayout& layout, const Hdf5Writer::Options& options);

/// Which file of a killed run holds what it did not write, as far as the fingerprints of `part` show, and rows and
/// events that two files have. Empty where none does.
std::string foreign_part(const std::filesystem::path& directory, const KeptPart& part);

/// Cuts the text files to what was kept and puts the new results.h5 in its place. Throws Error{file} "cannot-write".
void cut_back(const std::filesystem::path& directory, const KeptFiles& kept, ResultFormat format);

/// Whole lines at the beginning of a text file and their bytes, at most `most` of them.
struct WholeLines {
  std::int64_t lines = 0;
  std::uintmax_t bytes = 0;
  bool more = false;  ///< anything that comes after them
};
WholeLines whole_lines(const std::filesystem::path& file, std::int64_t most, Sha256* hash = nullptr);

/// Cuts a file. Throws Error{file} "cannot-write".
void cut_file(const std::filesystem::path& file, std::uintmax_t bytes);

}  // namespace freeplay
