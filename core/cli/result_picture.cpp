#include "cli/result_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "base/suggestion.h"
#include "cli/options.h"
#include "component/joint_roles.h"
#include "results/body_motion.h"
#include "results/figure_text.h"

namespace freeplay {
namespace {

constexpr std::size_t most_others = 200;
constexpr double same_instant = 1e-9;  // of the time

/// The element of a list that has a name, or the nearest word.
template <class List, class Name>
int index_of(const List& list, const Name& name_of, const std::string& name, const char* what) {
  std::vector<std::string> names;
  for (const auto& one : list) names.push_back(name_of(one));
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  const auto nearest = suggestion(name, names);
  throw Error(Error::Category::usage, "unknown-name", fmt::format("the model has no {} '{}'", what, name), {},
              nearest ? fmt::format("did you mean '{}'?", *nearest) : "");
}

/// When another instant is drawn: after each so much time, or turn of the first driven joint that turns.
class Stroboscope {
 public:
  Stroboscope(const std::string& text, const ResultReader& reader, const Model& model) {
    if (text.empty()) return;
    try {
      step_ = positive_quantity("--every", text, dimension::time);
      return;
    } catch (const Error&) {
      // then it is an angle, or neither
    }
    try {
      step_ = positive_quantity("--every", text, dimension::angle);
    } catch (const Error&) {
      bad_value("--every", text, "a time (\"1 ms\") or an angle (\"30 deg\") is needed");
    }
    for (const Driver& driver : model.drivers) {
      if (driver.joint < 0) continue;
      column_ = reader.find(fmt::format("joint.{}.angle", model.joints[static_cast<std::size_t>(driver.joint)].name));
      if (column_ < reader.layout().columns.size()) return;
    }
    bad_value("--every", text, "the result has no angle of a driven joint", "give a time, as \"1 ms\"");
  }

  /// Where its angle stands; that of time where it counts time.
  std::size_t column() const { return column_; }
  bool flashes(double value) {
    if (step_ == 0.0 || !std::isfinite(value)) return false;
    if (!last_) last_ = value - step_;
    if (std::abs(value - *last_) < step_ * (1.0 - 1e-6)) return false;
    *last_ += std::copysign(step_ * std::floor(std::abs(value - *last_) / step_ + 1e-6), value - *last_);
    return true;
  }

 private:
  double step_ = 0.0;  // 0: never
  std::size_t column_ = 0;
  std::optional<double> last_;
};

MagnifiedJoint magnified(const std::string& text, const Model& model) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos || sign == 0) bad_value("--magnify", text, "JOINT=FACTOR is needed");
  const std::string name = text.substr(0, sign);
  const int joint = index_of(
      model.joints, [](const JointElement& one) { return one.name; }, name, "joint");
  const JointElement& element = model.joints[static_cast<std::size_t>(joint)];
  if (model.space == Space::spatial) bad_value("--magnify", text, "joints of planar models can be magnified");
  if (!(element.layout.clearance > 0.0)) {
    bad_value("--magnify", text, fmt::format("joint '{}' has no clearance", name));
  }
  return {joint, positive_quantity("--magnify", text.substr(sign + 1), dimension::none), {}};
}

class PictureReading {
 public:
  PictureReading(const std::string& result, const System& system, const ResultPictureOptions& options)
      : system_(system),
        options_(options),
        reader_(ResultReader::open(result)),
        motion_(*reader_, system),
        strobe_(options.every, *reader_, system.model()) {
    const Model& model = system.model();
    for (const std::string& name : options.traces) {
      const auto name_of = [](const Marker& frame) { return frame.name; };
      frames_.push_back(index_of(model.frames, name_of, name, "frame"));
      out_.picture.traces.push_back({name, {}});
    }
    for (const std::string& text : options.magnify) out_.picture.magnified.push_back(magnified(text, model));
  }

  ResultPicture read() {
    const double at = options_.at.empty() ? std::numeric_limits<double>::infinity()
                                          : signed_quantity("--at", options_.at, dimension::time);
    double time = std::nan(""), beyond = time;
    motion_.rows(at + same_instant * std::abs(at), strobe_.column(),
                 [&](double t, std::span<const double> q, double also) {
                   beyond = t;
                   if (!std::ranges::all_of(q, [](double x) { return std::isfinite(x); })) return true;
                   add(q, also);
                   time = t;
                   return true;
                 });
    if (std::isnan(beyond)) bad_value("--at", options_.at, "the result has no row so early");
    if (std::isnan(time)) {
      throw Error(Error::Category::usage, "no-rows",
                  fmt::format("'{}' has no row in which all poses are finite numbers", reader_->file()));
    }
    if (std::isfinite(at)) require_row_after(at, time, beyond);
    out_.picture.q = out_.q;
    out_.picture.at_start = false;
    out_.picture.caption = "t = " + figure_text(time, "s", 0.0, {.digits = 9, .prefixed = true});
    return std::move(out_);
  }

 private:
  /// An instant after the last row is not one of the result.
  void require_row_after(double at, double time, double& last) {
    const std::vector<std::size_t> only_time{0};
    reader_->rows(only_time, {}, [&](std::span<const double> times) { last = times.back(); });
    if (time < last || at <= last * (1.0 + same_instant)) return;
    bad_value("--at", options_.at, fmt::format("the last row is at {:.9g} s", last));
  }

  void add(std::span<const double> q, double also) {
    const Model& model = system_.model();
    if (strobe_.flashes(also)) {
      if (out_.picture.others.size() == most_others) {
        bad_value("--every", options_.every, fmt::format("more than {} instants cover each other", most_others),
                  "take a larger step, or an earlier --at");
      }
      out_.picture.others.emplace_back(q.begin(), q.end());
    }
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      out_.picture.traces[i].points.push_back(
          world_position(system_, model.frames[static_cast<std::size_t>(frames_[i])], q));
    }
    for (MagnifiedJoint& one : out_.picture.magnified) {
      const JointElement& joint = model.joints[static_cast<std::size_t>(one.joint)];
      const Marker& first = model.markers[static_cast<std::size_t>(joint.marker_a)];
      const auto bearing = world_position(system_, first, q);
      const auto journal = world_position(system_, model.markers[static_cast<std::size_t>(joint.marker_b)], q);
      const double x = journal[0] - bearing[0], y = journal[1] - bearing[1];
      // Walls lie level in the picture, however their body turns.
      const bool turned = plays_between_walls(joint.layout);
      const double own = first.body == ground ? 0.0 : q[3 * static_cast<std::size_t>(first.body) + 2];
      const double angle = turned ? first.angle + own : 0.0, c = std::cos(angle), s = std::sin(angle);
      one.orbit.push_back({c * x + s * y, c * y - s * x});
    }
    out_.q.assign(q.begin(), q.end());
  }

  const System& system_;
  const ResultPictureOptions& options_;
  std::unique_ptr<ResultReader> reader_;
  BodyMotion motion_;
  Stroboscope strobe_;
  std::vector<int> frames_;
  ResultPicture out_;
};

}  // namespace

ResultPicture result_picture(const std::string& result, const System& system, const ResultPictureOptions& options) {
  return PictureReading(result, system, options).read();
}

}  // namespace freeplay
