// StudyPicture: the table of a study as a picture.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "study/open_study.h"

namespace freeplay {

/// An entry of `plots`.
struct PictureRequest {
  enum class Kind { line, heat, bifurcation, histogram, tornado };
  std::string name;
  Kind kind = Kind::line;
  std::string x, y, value, by;
  std::vector<double> percentiles{5.0, 50.0, 95.0, 99.0};
};

/// Of the section `plots`.
std::vector<PictureRequest> picture_requests(const StudyPlan& plan);

/// SVG of the table in `folder`: same table, same bytes. A mark has the number of its point, of several the first, in
/// `data-point`; at most 4000 a series, the extremes among them. Throws Error{input}.
std::string study_picture(const OpenStudy& study, const std::filesystem::path& folder, const PictureRequest& request);

}  // namespace freeplay
