#include "analysis/pose_form.h"

#include "model/path_pose.h"

namespace freeplay {
namespace {

constexpr const char* planar_changes[] = {"dx", "dy", "dangle"};
constexpr const char* planar_forces[] = {"fx", "fy"};
constexpr int planar_twist[] = {0, 1, 5};
constexpr const char* spatial_changes[] = {"dx", "dy", "dz", "drx", "dry", "drz"};
constexpr const char* spatial_forces[] = {"fx", "fy", "fz", "tx", "ty", "tz"};
constexpr int spatial_twist[] = {0, 1, 2, 3, 4, 5};

}  // namespace

Components PoseForm::all() const {
  Components out{};
  for (std::size_t i = 0; i < size(); ++i) out[i] = true;
  return out;
}

bool turns_whole(const PoseForm& form, const Components& given) {
  std::size_t turns = 0;
  for (std::size_t i = form.lengths; i < form.size(); ++i) turns += given[i] ? 1 : 0;
  return turns == 0 || turns == form.size() - form.lengths;
}

std::string enumeration(std::span<const char* const> words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    out += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + std::string(words[i]);
  }
  return out;
}

const PoseForm& pose_form(Space space) {
  static const PoseForm planar{path_words(Space::planar), planar_changes, planar_twist, planar_forces, 2};
  static const PoseForm spatial{path_words(Space::spatial), spatial_changes, spatial_twist, spatial_forces, 3};
  return space == Space::spatial ? spatial : planar;
}

}  // namespace freeplay
