#include "cli/run_glance.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "cli/loading.h"
#include "cli/terminal.h"
#include "plot/sparkline.h"
#include "report/report.h"
#include "results/reader.h"

namespace freeplay {

std::string glance(const std::filesystem::path& result, bool has_report) {
  if (!stdout_is_terminal()) return "";
  try {
    const std::string lines = plot::sparklines(*ResultReader::open(result), stdout_takes_unicode());
    if (has_report) return lines;
    return lines +
           fmt::format("  freeplay report {} makes a page of it: motion, orbits, plots\n", printable(result.string()));
  } catch (const Error&) {
    return "";  // the files were reported, and a picture is no reason to fail
  }
}

void write_report_of(const std::filesystem::path& result, const CommonOptions& common) {
  ReportRequest request;
  request.results = {result.string()};
  request.build = FREEPLAY_BUILD;
  request.load = loading(common);
  const ReportMade made = write_report(request);
  if (common.json || common.quiet) return;
  print(fmt::format("  report in {} ({} bytes)\n", printable(made.file), made.bytes));
}

}  // namespace freeplay
