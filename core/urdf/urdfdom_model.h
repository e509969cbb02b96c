// UrdfdomModel: a robot as urdfdom reads it, the library that most programs share.
#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <string>

#include <urdf_model/model.h>

#include "urdf/element.h"

namespace freeplay::urdf {

/// Links and joints of the document as urdfdom understands them: masses, inertias, places, axes, limits, dynamics and
/// mimics. It is given what it takes: blanks as it wants them, a joint by itself that gives a link a second parent.
///
/// Not taken from it: turns, which it keeps as normalized quaternions and so loses the last digits of a plain one; the
/// axis of an `axis` element without numbers, which it reads as 0 0 0; the order of the file, since it sorts by name;
/// and what it does not know at all (loops, places for messages).
class UrdfdomModel {
 public:
  /// Hands the links, joints and materials of the robot over.
  explicit UrdfdomModel(const XmlElement& root);

  /// A link or joint of the robot. One with mistakes of its own, or of a robot that is refused, is handed over by
  /// itself, as it stands in the document by then: with guesses where numbers were none. So mistakes of one element do
  /// not hide those of another. What is refused even so has no inertial, or the type UNKNOWN, and so has, in a robot
  /// that is refused, what comes after the first 20 000.
  ::urdf::LinkConstSharedPtr link(const XmlElement& element, bool has_mistakes);
  ::urdf::JointConstSharedPtr joint(const XmlElement& element, bool has_mistakes);

  /// Reports as `bad-urdf` what urdfdom refuses, at the element that it refuses when it stands alone. For a robot in
  /// which nothing else is wrong.
  void report_refusal(Messages& messages) const;

 private:
  bool may_ask_again();

  const XmlElement& root_;
  std::shared_ptr<::urdf::ModelInterface> whole_;  ///< null where urdfdom refuses it
  std::set<const XmlElement*> second_parents_;     ///< joints that are not in `whole_`
  std::string refusal_;
  std::size_t asked_again_ = 0;
};

}  // namespace freeplay::urdf
