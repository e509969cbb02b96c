// InputText: reads a whole input file, if it is one that can be read safely.
#pragma once

#include <cstddef>
#include <string>

namespace freeplay {

inline constexpr std::size_t largest_input = 16u << 20;  ///< bytes

/// Fills `text` with the file and returns "", or says why not: "there is no such file". Directories, devices and pipes
/// are not opened: reading one could wait, or go on, for ever. Of a file that is too large one byte more than
/// largest_input is read.
std::string read_input(const std::string& file_name, std::string& text);

}  // namespace freeplay
