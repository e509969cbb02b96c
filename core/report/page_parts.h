// PageParts: the sources of a page, which the program carries with it.
#pragma once

#include <string_view>

namespace freeplay {

/// The definition is generated from page_parts.cpp.in: files of core/report/page and dygraphs.
struct PageParts {
  std::string_view html, style, script;
  std::string_view plot_style, plot_script, plots_version;  ///< of dygraphs
};
PageParts page_parts();

}  // namespace freeplay
