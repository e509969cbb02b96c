// StudyPoint: one run of a study.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace freeplay {

/// As `--set target=text`: a quantity with its unit, a word, or a list or map in the flow style of YAML.
struct StudySetting {
  std::string target, text;
};

struct StudyPoint {
  std::uint64_t index = 0;
  std::string hash;                    ///< 24 hexadecimal digits
  std::size_t model = 0;               ///< number of its model
  std::vector<StudySetting> settings;  ///< `set`, then axes, in order
  std::vector<std::string> cells;      ///< of the axis columns, as the table shows them; "" where there is none
  std::uint64_t sample = 0;
  std::string direction;  ///< in chains
};

}  // namespace freeplay
