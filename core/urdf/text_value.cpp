#include "urdf/text_value.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include "urdf/blanks.h"

namespace freeplay::urdf {
namespace {

void doubt_turns(const XmlElement& xml, const std::vector<double>& numbers, Messages& messages) {
  constexpr double pi = std::numbers::pi;
  for (const double angle : {numbers[3], numbers[4], numbers[5]}) {
    if (std::abs(angle) <= 2.0 * pi + 1e-3 || std::abs(std::remainder(angle, pi / 2.0)) < 1e-3) continue;
    messages.warning(whole_text_spot(xml), "doubtful-angle",
                     fmt::format("a pose turns by {:.6g} rad, {:.3g} turns: robot files are in radians, not in degrees",
                                 angle, std::abs(angle) / (2.0 * pi)),
                     "degrees=\"true\" at the pose changes the unit");
    return;
  }
}

bool in_degrees(const XmlElement& xml, Messages& messages) {
  const char* flag = xml.Attribute("degrees");
  const std::string_view word = flag == nullptr ? "false" : flag;
  if (word == "true" || word == "1") return true;
  if (word == "false" || word == "0") return false;
  messages.error(spot_of(xml, "degrees"), "bad-urdf",
                 fmt::format("'degrees' of a pose must be true or false, not '{}'", word));
  return false;
}

Eigen::Matrix3d read_quaternion(const XmlElement& xml, const std::vector<double>& numbers, Messages& messages) {
  const auto turn = turn_of_quaternion(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (turn) return *turn;
  messages.error(whole_text_spot(xml), "bad-urdf", "the quaternion of the pose is zero: it gives no direction");
  return Eigen::Matrix3d::Identity();
}

}  // namespace

std::string trimmed_text(const XmlElement& xml) {
  const std::string text = text_of(xml);
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

Spot whole_text_spot(const XmlElement& xml) {
  const std::string text = trimmed_text(xml);
  if (text.empty()) return name_spot(xml);
  Spot spot = text_spot(xml);
  spot.length = static_cast<int>(text.size());
  return spot;
}

std::vector<double> text_numbers(const XmlElement& xml, std::size_t count, Messages& messages) {
  std::vector<double> numbers;
  const std::string text = text_of(xml);
  for (std::size_t begin = text.find_first_not_of(blanks); begin != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, begin), text.size());
    std::string why, hint;
    const auto number = read_number(std::string_view(text).substr(begin, end - begin), why, hint);
    if (!number) {
      messages.error(whole_text_spot(xml), "bad-urdf", fmt::format("'{}': {}", xml.Name(), why), {}, hint);
      return {};
    }
    numbers.push_back(*number);
    begin = text.find_first_not_of(blanks, end);
  }
  if (numbers.size() == count) return numbers;
  messages.error(
      whole_text_spot(xml), "bad-urdf",
      fmt::format("'{}' must be {} number{}, not {}", xml.Name(), count, count == 1 ? "" : "s", numbers.size()));
  return {};
}

Eigen::Isometry3d text_pose(const XmlElement& xml, Messages& messages) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const char* format = xml.Attribute("rotation_format");
  const std::string_view written = format == nullptr ? "" : format;
  const bool quaternion = written == "quat_xyzw";
  if (!quaternion && !written.empty() && written != "euler_rpy") {
    messages.error(spot_of(xml, "rotation_format"), "bad-urdf", fmt::format("unknown rotation_format '{}'", written),
                   {}, "euler_rpy or quat_xyzw");
    return pose;
  }
  if (trimmed_text(xml).empty()) return pose;
  const std::vector<double> numbers = text_numbers(xml, quaternion ? 7 : 6, messages);
  if (numbers.empty()) return pose;
  pose.translation() << numbers[0], numbers[1], numbers[2];
  const bool degrees = in_degrees(xml, messages);
  if (quaternion) {
    pose.linear() = read_quaternion(xml, numbers, messages);
  } else if (numbers[3] != 0.0 || numbers[4] != 0.0 || numbers[5] != 0.0) {
    const double unit = degrees ? std::numbers::pi / 180.0 : 1.0;
    if (!degrees) doubt_turns(xml, numbers, messages);
    pose.linear() = rotation(unit * Eigen::Vector3d(numbers[3], numbers[4], numbers[5]));
  }
  return pose;
}

}  // namespace freeplay::urdf
