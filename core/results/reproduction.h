// Reproduction: whether a thing that was made again is the same, and where not.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "results/made_file.h"

namespace freeplay {

/// One part of a thing, compared with the same part of the one made again.
struct ReproductionCheck {
  std::string what;              ///< "rows"
  std::string size;              ///< "6001 x 199"
  std::string first_difference;  ///< "row 17, t = 0.0016 s, NAME: ... recorded, ... now"; empty: same
  bool bytes = true;             ///< compared byte by byte; else value by value

  bool same() const { return first_difference.empty(); }
};

/// Compares a thing with the one that was made again at `again`: rows and numbers of events bit by bit, summaries but
/// for what names files and times of the machine, texts byte by byte. What a run that had not ended left is compared as
/// far as it goes. `results`: the directories that a picture of several was made from again, which it may name. Throws
/// Error{file} "unreadable-result".
std::vector<ReproductionCheck> compare_again(const MadeFile& made, const std::filesystem::path& again,
                                             const std::vector<std::string>& results);

}  // namespace freeplay
