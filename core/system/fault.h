// Fault: the element that could not be evaluated, and why.
#pragma once

#include <string_view>

#include "freeplay/joint.h"
#include "system/motion.h"

namespace freeplay {

struct Fault {
  enum class Kind { none, plugin, motion } kind = Kind::none;
  int joint = -1;      ///< index into Model::joints
  MotionFault motion;  ///< kind motion
  Message message{};   ///< kind plugin

  /// A joint failed because an expression of the model file, which it evaluates, has no value.
  bool of_expression() const {
    const std::string_view id = message.id;
    return kind == Kind::plugin && (id == "bad-expression" || id == "bad-number");
  }

  /// The joint gave the reason itself, in `message`. False, for the caller to return.
  [[gnu::cold, gnu::noinline]] bool blame(int failed) {
    kind = Kind::plugin;
    joint = failed;
    return false;
  }
  /// The joint's answer is wrong. A point that is not finite itself is the fault of the iteration alone.
  [[gnu::cold, gnu::noinline]] bool refuse(int failed, const char* why) {
    message.id[0] = '\0';
    abi::copy_text(message.text, sizeof message.text, why);
    return blame(failed);
  }
};

/// Reason of a joint that wrote past the end of an array (system/guard_marks.h).
inline constexpr const char* wrote_beside = "it wrote beside the numbers that it was given to fill";

}  // namespace freeplay
