// StudySection: the section `study`, as it is written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "format/study_axis.h"

namespace freeplay {

/// More points are computed where they are asked for by an option.
inline constexpr std::uint64_t many_points = 100'000'000, most_points = 1'000'000'000'000;

struct StudySample {
  enum class Method { random, latin_hypercube, sobol };
  Method method = Method::random;
  std::uint64_t points = 1, seed = 0;
};

struct StudyWarmStart {
  enum class Direction { up, down, both };
  std::size_t axis = 0;  ///< of StudySection::axes
  Direction direction = Direction::up;
  std::uint64_t pieces = 1;
};

struct StudyStop {
  std::string reducer;
  std::optional<double> percentile{};  ///< else the mean
  double confidence = 0.95;
  std::optional<double> half_width{}, relative{};  ///< one of them
  std::optional<CheckedValue> width{};             ///< where the former stands: its unit is that of the reducer
  std::uint64_t min_points = 200, block = 100;
};

struct StudySection {
  enum class Combine { grid, zip, star };

  CheckedValue section;
  std::string name{};
  /// Files by name; the name is empty where it is that of the model.
  struct ModelFile {
    std::string name;
    CheckedValue path;
  };
  std::vector<ModelFile> models{};
  std::vector<TargetValue> set{};
  std::vector<StudyAxis> axes{};
  Combine combine = Combine::grid;
  std::vector<std::vector<std::size_t>> side_by_side{};  ///< numbers of axes, in the order in which they are written
  std::optional<StudySample> sample{};
  std::optional<StudyWarmStart> warm_start{};
  std::optional<StudyStop> stop{};
  const Node* analysis = nullptr;  ///< the map of `do`; null: points are runs
  const Node* reducers = nullptr;
  const Node* plots = nullptr;
};

/// Checks what can be said without the models; targets and reducers follow from them. `in_model`: the section stands
/// in one. Values are constants, so `section`'s scope has nothing. Reports to its diagnostics.
StudySection read_study(const CheckedValue& section, bool in_model, const TargetDimension& dimension_of = {});

}  // namespace freeplay
