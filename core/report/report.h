// Report: results of one or more runs as one HTML file.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "load/options.h"
#include "results/reader.h"

namespace freeplay {

struct ReportRequest {
  std::vector<std::string> results;   ///< directories, or files of rows
  std::string out;                    ///< empty: report.html in the first result
  std::vector<std::string> pictures;  ///< SVG files
  std::vector<std::string> channels;  ///< patterns; empty: all for which there is room
  RowWindow window;
  std::string title;                   ///< empty: names of the runs
  bool force = false;                  ///< replace a file that is no page
  std::vector<std::string> arguments;  ///< what is needed to make the page again, without paths
  std::string build;                   ///< how the program was built
  LoadOptions load;
};

struct ReportMade {
  std::string file;
  std::size_t bytes = 0;
  std::vector<std::string> runs, left_out;
};

/// Same results and request, same bytes. Throws Error{usage} for a request that cannot be met, Error{file}.
ReportMade write_report(const ReportRequest& request);

}  // namespace freeplay
