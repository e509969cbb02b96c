// MotionNames: the channels of the motion that formulas of a model may name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/expression.h"
#include "format/draft.h"

namespace freeplay {

/// body.NAME.QUANTITY, joint.NAME.QUANTITY and frame.BODY/FRAME.QUANTITY, as result columns are called; NAME as
/// anywhere in the part of the model that the formula stands in. Bodies, frames and joints must be known.
class MotionNames final : public ChannelNames {
 public:
  /// Channels are added to `channels`, each once.
  MotionNames(Draft& draft, const Part& part, std::vector<MotionChannel>& channels)
      : draft_(draft), part_(part), channels_(channels) {}

  std::optional<FormulaVariable> find(std::string_view name) const override;
  std::string word() const override { return "channel"; }
  std::string nearest(std::string_view name) const override;
  std::string known() const override {
    return "it may hold t, parameters and channels such as body.NAME.vx, joint.NAME.speed and frame.BODY/FRAME.x";
  }
  /// Accelerations and forces, which would make an algebraic loop, and other columns of results.
  std::optional<Refusal> refusal(std::string_view written) const override;

  const std::vector<std::pair<std::string, std::string>>& found() const override { return found_; }
  bool excused() const override { return excused_; }

 private:
  struct Name {
    std::string kind, element, quantity;
  };
  static std::optional<Name> split(std::string_view name);
  std::optional<MotionChannel> channel(const Name& name, std::string& full) const;
  std::optional<MotionChannel> of_marker(const std::string& marker, const std::string& quantity) const;
  std::optional<MotionChannel> of_joint(int joint, const std::string& quantity) const;
  std::optional<std::string> frame(const std::string& reference) const;
  bool is_acceleration(const Name& name) const;
  bool follows_from_forces(const Name& name) const;
  bool is_result(const Name& name) const;
  std::vector<std::string> quantities(const Name& name) const;
  std::vector<std::string> frames_in_order() const;
  std::string first_frame(const Name& name) const;

  Draft& draft_;
  const Part& part_;
  std::vector<MotionChannel>& channels_;
  mutable std::vector<std::pair<std::string, std::string>> found_;
  mutable bool excused_ = false;
};

}  // namespace freeplay
