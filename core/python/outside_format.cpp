// What the rooms take of the data of the formatting library: as in outside_data.cpp, it must be of the extension
// itself.
#include <fmt/format-inl.h>
