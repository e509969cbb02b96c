// type_name: a component's name as part of the name of a test.
#pragma once

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "freeplay/plugin.h"

namespace freeplay::test {

inline std::string type_name(const testing::TestParamInfo<const Component*>& info) {
  std::string name = info.param->description.name;
  std::ranges::replace(name, '-', '_');
  return name;
}

}  // namespace freeplay::test
