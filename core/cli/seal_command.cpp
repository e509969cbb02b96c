#include "cli/seal_command.h"

#include <memory>

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "cli/terminal.h"
#include "results/seal.h"

namespace freeplay {
namespace {

int seal(const std::vector<std::string>& directories, const CommonOptions& common) {
  if (directories.empty()) throw Error(Error::Category::usage, "missing-argument", "seal needs a result directory");
  Json list = Json::array();
  for (const std::string& directory : directories) {
    const Sealed result = seal_result(directory);
    const Json time = result.rows > 0 ? Json(result.time) : Json(nullptr);
    list.push_back({{"directory", directory}, {"sealed", result.changed}, {"rows", result.rows}, {"time", time}});
    if (common.json || common.quiet) continue;
    const std::string done =
        result.rows > 0 ? fmt::format("{} rows to t = {:g} s", result.rows, result.time) : "0 rows";
    print(printable(directory) + (result.changed ? ": sealed, " + done : ": nothing to do") + "\n");
  }
  if (common.json) print_json(list);
  return 0;
}

}  // namespace

Command add_seal_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "seal", "Make the results of killed runs readable for every program");
  const auto directories = std::make_shared<std::vector<std::string>>();
  add_arguments(*app, "RESULT", *directories, "Result directories");
  add_common_options(*app, common);
  return {app, [directories, &common] { return seal(*directories, common); }};
}

}  // namespace freeplay
