#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "base/error.h"
#include "base/suggestion.h"
#include "cli/output_file.h"
#include "cli/study_views.h"
#include "cli/terminal.h"
#include "results/made_text.h"
#include "study/picture.h"

namespace freeplay {
namespace {

PictureRequest asked(const StudyOptions& options) {
  using Kind = PictureRequest::Kind;
  const std::vector<std::string> kinds = {"line", "heat", "bifurcation", "histogram", "tornado"};
  require_word("--kind", options.kind, kinds);
  PictureRequest request;
  request.name = options.kind;
  request.kind = static_cast<Kind>(std::ranges::find(kinds, options.kind) - kinds.begin());
  request.x = options.x;
  request.y = options.y;
  request.value = options.value;
  request.by = options.by;
  return request;
}

/// Those that are named; all without names.
std::vector<PictureRequest> chosen(std::vector<PictureRequest> all, const std::vector<std::string>& names) {
  if (names.empty()) return all;
  std::vector<PictureRequest> requests;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(all, name, &PictureRequest::name);
    if (found != all.end()) {
      requests.push_back(*found);
      continue;
    }
    std::vector<std::string> known;
    for (const PictureRequest& request : all) known.push_back(request.name);
    const auto nearest = suggestion(name, known);
    throw Error(Error::Category::usage, "unknown-name", fmt::format("the study has no plot '{}'", name), {},
                nearest ? fmt::format("did you mean '{}'?", *nearest) : "");
  }
  return requests;
}

}  // namespace

int study_plot(const StudyOptions& options, const CommonOptions& common) {
  if (options.studies.empty()) throw Error(Error::Category::usage, "missing-argument", "study plot needs a DIR");
  const StudyInFolder opened = open_kept(options.studies.front(), StudyUse::look, common);
  if (!opened.study) return opened.exit_code;
  const std::vector<std::string> names(options.studies.begin() + 1, options.studies.end());
  const std::vector<PictureRequest> requests = options.kind.empty()
                                                   ? chosen(picture_requests(opened.study->plan()), names)
                                                   : std::vector<PictureRequest>{asked(options)};
  if (requests.empty()) {
    throw Error(Error::Category::input, "missing-key", "the study has no `plots`", {},
                "--kind line --x AXIS --y REDUCER draws one");
  }
  if (!options.out.empty() && requests.size() > 1) {
    throw Error(Error::Category::usage, "bad-value", "--out is for one picture", {}, "name a plot");
  }
  require_no_other_file(options.out, own_picture, options.force);
  Json files = Json::array();
  for (const PictureRequest& request : requests) {
    const std::filesystem::path file = !options.out.empty() ? std::filesystem::path(options.out)
                                                            : opened.folder.path() / "plots" / (request.name + ".svg");
    // Its rows have their record beside them.
    write_output(file.string(),
                 picture_with_record(study_picture(*opened.study, opened.folder.path(), request), nullptr));
    files.push_back(file.string());
    if (!common.json && !common.quiet) print(file.string() + "\n");
  }
  if (common.json) print_json({{"files", files}});
  return 0;
}

}  // namespace freeplay
