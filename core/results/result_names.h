// ResultNames: what a result directory is made of.
#pragma once

#include <span>

namespace freeplay {

/// Names of the files and folders that results have, whatever their format.
std::span<const char* const> result_names();

}  // namespace freeplay
