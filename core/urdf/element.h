// UrdfElement: the one way in which elements of a URDF file are read; it knows which attributes and children were asked
// for, and what is left over is reported.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "urdf/robot.h"
#include "urdf/xml_document.h"

namespace freeplay::urdf {

/// Whether the tag has this name.
inline bool is(const XmlElement& element, std::string_view name) { return element.Name() == name; }
Spot spot_of(const XmlElement& element, const XmlAttribute& attribute);
/// Of the attribute of that name, or of the element's name where there is none.
Spot spot_of(const XmlElement& element, const char* attribute);
/// Of the first of the element's own characters that is no blank.
Spot text_spot(const XmlElement& element);
/// Of the name of an element, and of its '<'.
Spot name_spot(const XmlElement& element);
Spot begin_spot(const XmlElement& element);

/// Where messages about one file go.
class Messages {
 public:
  /// `format` stands in the ids in place of `urdf`.
  Messages(std::string file, Diagnostics& diagnostics, std::string format = "urdf")
      : file_(std::move(file)), diagnostics_(diagnostics), format_(std::move(format)) {}

  void error(const Spot& spot, const char* id, std::string message, std::string suggestion = {}, std::string hint = {});
  void warning(const Spot& spot, const char* id, std::string message, std::string hint = {});
  bool failed() const { return errors_ > 0; }
  int errors() const { return errors_; }

  /// The word that was probably meant, or ""; of a hostile file only the first hundred are looked for.
  std::string suggest(const std::string& word, const std::vector<std::string>& words);

  /// Counts something that is read and not used, such as "visual"; all of it becomes one warning.
  void ignore(const std::string& what, const std::string& name = {});
  void report_ignored(const Spot& spot);

 private:
  std::string id_of(std::string id) const;

  std::string file_;
  Diagnostics& diagnostics_;
  std::string format_;
  int errors_ = 0;
  int suggested_ = 0;
  std::vector<std::pair<std::string, std::vector<std::string>>> ignored_;  ///< kinds and the names of each
  std::unordered_map<std::string, std::size_t> ignored_index_;
};

/// The one of `words` of which an element's name is a slip of the pen, or "": other case, one letter too many or too
/// few or two that changed places; in words of six letters or more two such slips, replaced letters among them. Other
/// programs have elements of their own, so nothing that is merely near will do.
std::string misspelt(const std::string& word, const std::vector<std::string>& words);

/// A finite decimal number, whatever the locale. On failure says why: "'0,5' is not a number".
std::optional<double> read_number(std::string_view text, std::string& why, std::string& hint);

/// A limit in rad that is as large as the usual ones in degrees and written like them: a multiple of 5 from 10 on. More
/// than three turns in radians are no such number where they are a multiple of ten degrees, nor is what means no limit.
bool looks_like_degrees(double limit);

class Element {
 public:
  /// With `exact`, an attribute that was not read is an error; without, one that looks like a misspelt one is.
  /// `owner` names it in messages: "link 'arm'".
  Element(XmlElement& xml, std::string owner, Messages& messages, bool exact);

  XmlElement& xml() const { return xml_; }
  const std::string& owner() const { return owner_; }
  Spot name_spot() const { return urdf::name_spot(xml_); }
  Spot begin_spot() const { return urdf::begin_spot(xml_); }

  /// Text of an attribute.
  const XmlAttribute* find(const std::string& name);
  /// Reports its absence at the element's name.
  const XmlAttribute* require(const std::string& name);
  /// A number; `standard` when it is not there or, after a message, when it is none.
  double number(const std::string& name, double standard);
  std::optional<double> required_number(const std::string& name, const char* guess = "0");
  std::optional<Eigen::Vector3d> vector(const std::string& name, const char* guess = "0 0 0");
  /// `count` numbers; empty when they are not there or, after a message, when they are not that.
  std::vector<double> numbers(const std::string& name, std::size_t count, const char* guess = "");
  /// From `least` to `most` of them, likewise.
  std::vector<double> numbers(const std::string& name, std::size_t least, std::size_t most, const char* guess);

  /// Warns `doubtful-angle` of one beyond a turn that is no multiple of pi.
  void doubt_turns(const Eigen::Vector3d& rpy);

  /// The child of that name. A second one is reported, and so is an absent one at the '<' of this element.
  XmlElement* child(const std::string& name);
  XmlElement* required_child(const std::string& name);
  /// Children of which there may be any number, and which are read elsewhere.
  void know(const std::string& name) { repeated_.push_back(name); }
  /// Children that are known and not used: counted.
  void pass_over(const std::string& name);

  /// Reports unknown attributes, children and text. Unknown children of an `exact` element are errors, too. Then writes
  /// guesses in place of numbers that are missing or none, so that urdfdom takes the rest.
  void finish(bool text_allowed = false);

 private:
  void finish_attributes();
  void finish_children();
  std::optional<double> parse(const XmlAttribute& attribute);
  std::vector<double> parse_all(const XmlAttribute& attribute, const std::vector<std::string_view>& words);

  XmlElement& xml_;
  std::string owner_;
  Messages& messages_;
  bool exact_;
  std::vector<std::string> attributes_, children_, repeated_, passed_;
  std::vector<std::pair<std::string, std::string>> guesses_;  ///< attributes and their values
};

/// The `origin` child of an element as a frame; identity when there is none.
Eigen::Isometry3d read_origin(Element& element, Messages& messages, Spot* spot = nullptr);
/// xyz and rpy of an element itself.
Eigen::Isometry3d read_pose(Element& element);
/// R = Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Matrix3d rotation(const Eigen::Vector3d& rpy);

}  // namespace freeplay::urdf
