// MadeFile: a thing that this program made, with the record that says how.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json_text.h"

namespace freeplay {

enum class MadeKind { result, hdf5, mat, csv, json, picture, page };

struct MadeFile {
  MadeKind kind;
  std::filesystem::path path;  ///< file, or directory of a result
  Json record;                 ///< with texts of model and inputs
  bool ended = true;           ///< false: its run was killed or interrupted
  std::string data{};          ///< of a table, picture or page as text: what may be compared
};

/// Finds out by its content what `path` is. A file of a result directory stands for the directory, but for results.h5,
/// which can do alone. Throws Error{file} "unreadable-result", "no-provenance".
MadeFile read_made_file(const std::filesystem::path& path);

/// The text of a table, picture or page without the record that stands in it. Throws Error{file} "unreadable-result".
std::string data_of(MadeKind kind, const std::filesystem::path& path);

/// Records of the runs that a thing was made from, each with `arguments` of the run: those in the field `runs` of its
/// record, those of the runs of a page, or the record itself.
std::vector<Json> runs_of(const MadeFile& made);

/// What of a thing is not what its record was made of.
struct RecordFault {
  std::string what;       ///< a sentence
  bool of_model = false;  ///< its model or an input: nothing can be made again from that
};
std::vector<RecordFault> record_faults(const MadeFile& made);

}  // namespace freeplay
