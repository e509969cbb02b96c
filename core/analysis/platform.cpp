#include "analysis/platform.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "base/index.h"
#include "base/suggestion.h"

namespace freeplay {
namespace {

Location file_of(const Model& model) { return {model.file, 0, 0}; }

/// The only inverse-kinematics entry, or null.
const InverseKinematics* only_entry(const Model& model) {
  return model.kinematics.size() == 1 ? &model.kinematics.front() : nullptr;
}

std::vector<int> driven_by(const Model& model, const InverseKinematics& entry) {
  std::vector<int> joints;
  for (int d = entry.first_driver; d < entry.first_driver + entry.driver_count; ++d) {
    joints.push_back(model.drivers[at(d)].joint);
  }
  return joints;
}

void choose_inputs(const Model& model, Platform& platform) {
  Location place = file_of(model);
  if (model.analysis.joints_location) {
    platform.inputs = model.analysis.joints;
    place = *model.analysis.joints_location;
  } else if (const InverseKinematics* entry = only_entry(model)) {
    platform.inputs = driven_by(model, *entry);
  } else {
    for (const Driver& driver : model.drivers) {
      if (prescribes(driver.kind)) platform.inputs.push_back(driver.joint);
    }
  }
  if (platform.inputs.empty()) {
    throw Error(Error::Category::input, "missing-key", "no joints are driven: 'analysis' needs 'joints', the inputs",
                place);
  }
  for (std::size_t i = 0; i < platform.inputs.size(); ++i) {
    const int j = platform.inputs[i];
    const JointElement& joint = model.joints[at(j)];
    if (std::count(platform.inputs.begin(), platform.inputs.begin() + static_cast<std::ptrdiff_t>(i), j) > 0) {
      throw Error(Error::Category::input, "duplicate-name",
                  fmt::format("joint '{}' is named as an input twice", joint.name), place);
    }
    if (joint.has_play && joint.layout.coordinate == Coordinate::none) {
      throw Error(Error::Category::input, "driver-on-clearance",
                  fmt::format("joint '{}' has clearance, which leaves no coordinate to drive", joint.name), place,
                  "--ideal closes it");
    }
    if (joint.ideal_layout().coordinate == Coordinate::none || joint.gear >= 0) {
      throw Error(Error::Category::input, "wrong-type",
                  fmt::format("joint '{}' has no coordinate that could be driven", joint.name), place);
    }
    if (model.analysis.input_is_length && joint.ideal_layout().coordinate == Coordinate::angle) {
      throw Error(Error::Category::input, "dimension-mismatch",
                  fmt::format("'analysis.error.input' is a length, but the input '{}' turns", joint.name),
                  model.analysis.input_location);
    }
  }
}

void choose_elbow(const Model& model, const PlatformOverrides& overrides, Platform& platform) {
  const std::size_t count = platform.inputs.size();
  platform.elbow.assign(count, 1);
  if (!overrides.elbow.empty()) {
    if (overrides.elbow.size() != 1 && overrides.elbow.size() != count) {
      throw Error(Error::Category::usage, "bad-value",
                  fmt::format("--elbow has {} values, but {} joint{} driven", overrides.elbow.size(), count,
                              count == 1 ? " is" : "s are"));
    }
    platform.elbow_given = true;
    platform.elbow = overrides.elbow.size() == 1 ? std::vector<int>(count, overrides.elbow[0]) : overrides.elbow;
    return;
  }
  if (model.analysis.elbow_location) {
    const std::vector<int>& elbow = model.analysis.elbow;
    if (elbow.size() != 1 && elbow.size() != count) {
      throw Error(Error::Category::input, "wrong-length",
                  fmt::format("'analysis.elbow' has {} values, but {} joint{} driven", elbow.size(), count,
                              count == 1 ? " is" : "s are"),
                  *model.analysis.elbow_location);
    }
    platform.elbow_given = true;
    platform.elbow = elbow.size() == 1 ? std::vector<int>(count, elbow[0]) : elbow;
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (const Driver& driver : model.drivers) {
      if (driver.joint != platform.inputs[i] || driver.kinematics < 0) continue;
      platform.elbow[i] = driver.elbow;
      platform.elbow_given = platform.elbow_given || driver.elbow_given;
    }
  }
}

}  // namespace

Components Platform::path_components() const {
  Components given{};
  for (std::size_t i = 0; i < given.size(); ++i) given[i] = path.gives(i);
  return given;
}

Platform platform_of(const Model& model, const PlatformOverrides& overrides) {
  Platform platform;
  const InverseKinematics* entry = only_entry(model);
  if (overrides.marker) {
    platform.marker = *overrides.marker;
    platform.location = file_of(model);
  } else if (model.analysis.frame_location) {
    platform.marker = model.analysis.marker;
    platform.location = *model.analysis.frame_location;
  } else if (entry != nullptr) {
    platform.marker = entry->marker;
    platform.location = entry->frame_location;
  } else {
    throw Error(Error::Category::input, "missing-key",
                model.kinematics.empty()
                    ? "no platform is known: 'analysis' needs 'frame'"
                    : "several drivers have a frame of their own: 'analysis' needs 'frame', which of them is meant",
                file_of(model), "analysis: {frame: BODY/FRAME}, or --frame BODY/FRAME");
  }
  if (model.markers[at(platform.marker)].body == ground) {
    throw Error(
        Error::Category::input, "wrong-type",
        fmt::format("the frame '{}' is on ground; the platform must move", model.markers[at(platform.marker)].name),
        platform.location);
  }
  choose_inputs(model, platform);
  choose_elbow(model, overrides, platform);
  if (model.analysis.path_location) {
    platform.path = model.analysis.path;
  } else if (entry != nullptr && platform.marker == entry->marker) {
    platform.path = entry->path;
  }
  return platform;
}

int frame_marker(Model& model, const std::string& reference) {
  const std::string name = reference.find('/') == std::string::npos ? reference + "/origin" : reference;
  for (std::size_t m = 0; m < model.markers.size(); ++m) {
    if (model.markers[m].name == name) return static_cast<int>(m);
  }
  std::vector<std::string> names;
  for (const Marker& frame : model.frames) {
    if (frame.name == name) {
      model.markers.push_back(frame);
      return static_cast<int>(model.markers.size()) - 1;
    }
    const bool origin = frame.name.ends_with("/origin");
    names.push_back(origin ? frame.name.substr(0, frame.name.size() - 7) : frame.name);
  }
  const auto nearest = suggestion(reference, names);
  throw Error(Error::Category::usage, "unknown-name", fmt::format("there is no frame '{}'", reference), {},
              nearest ? fmt::format("did you mean '{}'?", *nearest) : "BODY or BODY/FRAME");
}

}  // namespace freeplay
