// Draft: a model while it is being built, with the names that are known so far.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "component/registry.h"
#include "format/build_options.h"
#include "format/csv_text.h"
#include "format/map_reader.h"
#include "format/name_table.h"
#include "format/part.h"

namespace freeplay {

inline constexpr long largest_model = 200'000;  ///< bodies, joints, drivers and forces together

struct Draft {
  Draft(const Registry& known_types, const BuildOptions& build_options, Diagnostics& messages)
      : registry(known_types), options(build_options), diagnostics(messages) {
    frames["ground/origin"] = {};
  }

  const Registry& registry;
  const BuildOptions& options;
  Diagnostics& diagnostics;
  Model model;

  const Reading* top = nullptr;               ///< what the top level is read in
  std::deque<Part> parts;                     ///< the top level first
  std::vector<std::string> broken_instances;  ///< names that begin so may have been meant to exist
  /// Names of result columns that begin so cannot be judged: the entry that has them is in error.
  std::vector<std::string> unsure_columns;

  NameTable bodies, joints, drivers, forces;
  std::map<std::string, std::string> divided;  ///< joints with play that are two joints: what to write for it
  std::vector<bool> joint_usable;              ///< false: its own mistakes were reported, its coordinate is unknown
  std::vector<bool> ideal_matched;             ///< by index of options.ideal

  std::map<std::string, std::unique_ptr<const CsvText>> tables;  ///< files with tables, by path
  /// What drivers have made of them, by all that it depends on; the instances of a template share theirs.
  std::map<std::string, std::shared_ptr<const TimeTable>> time_tables;
  std::size_t table_bytes = 0, table_points = 0;
  std::unordered_map<BodyId, std::string> own_gravity;  ///< bodies that a force gives theirs, and its name
  /// Inverse-kinematics entries that say `elbow`, and where.
  std::vector<std::pair<int, CheckedValue>> elbows;

  mutable std::size_t compared = 0;  ///< characters of names with patterns, about

  std::unordered_map<int, std::string> prescribed;  ///< joints whose coordinate a driver prescribes, and its name

  struct Frame {
    BodyId body = ground;
    Vector3 position{};
    double angle = 0.0;
    Rotation rotation = no_rotation;
    // Where it is declared; null for `origin` and `com`.
    const Node* key = nullptr;
    const Node* value = nullptr;
    const Reading* reading = nullptr;
  };
  /// A parameter or a part of a path that depends on time, for doubt_rests().
  struct Timed {
    CheckedValue written;
    std::vector<Expression> parts;  ///< that depend on time alone
    bool is_load, whole;            ///< whether it makes forces, and the part is all of it
  };
  std::vector<Timed> timed;
  double length_scale = 0.0;                      ///< freeplay::length_scale(), from when all frames are known on [m]
  std::unordered_map<std::string, Frame> frames;  ///< by BODY/FRAME
  std::unordered_map<std::string, int> markers;   ///< index into model.markers by BODY/FRAME

  // Names, in the order in which section 8 of the format looks them up. All report `unknown-name` at `value`.
  std::optional<BodyId> body(const CheckedValue& value, const Part& part) const;
  std::optional<int> joint(const CheckedValue& value, const Part& part) const;
  /// Names or patterns of joints, expanded in order; nothing when one was in error.
  std::optional<std::vector<int>> joint_list(const CheckedValue& value, const Part& part) const;
  /// The marker of a frame reference, created when it is new.
  std::optional<int> marker(const CheckedValue& value, const Part& part);

  /// The same for names that are at hand; nothing is reported.
  std::optional<BodyId> find_body(const std::string& name, const Part& part) const;
  std::optional<int> find_joint(const std::string& name, const Part& part) const;
  /// Reports a joint that there is not, at `value` or at its key.
  void unknown_joint(const CheckedValue& value, const std::string& name, const Part& part, bool at_key = false) const;

  /// BODY/FRAME of the only frame that is called so, of whatever body; null where there is none or more than one. All
  /// frames are known.
  const std::string* lone_frame(const std::string& name) const;

  const std::string& body_name(BodyId id) const;
  int marker(const std::string& full_name);
  /// A marker that stands where another does, its axes turned by `turn` in that one's axes. Always a new one.
  int turned_marker(int marker, const Rotation& turn);
  /// May the name belong to an instance that was in error, so that it need not be reported?
  bool excused(const std::string& name) const;

  /// Reports `bad-name`, and `reserved-name` for a word of `reserved`, at the key of a declaration.
  static void check_name(const CheckedValue& entry, const std::vector<std::string>& reserved = {});

 private:
  mutable std::unordered_map<std::string, std::string> lone_frames_;  ///< by name; empty text: several
  void unknown(const CheckedValue& value, const char* kind, const std::string& name, const NameTable& table,
               const Part& part, bool at_key = false) const;
  std::optional<std::string> frame_name(const CheckedValue& value, const std::string& reference,
                                        const Part& part) const;
};

inline Marker marker_of(const Draft::Frame& frame, const std::string& name) {
  return {frame.body, name, frame.position, frame.angle, frame.rotation};
}

/// Numbers of the names in `table` that match the pattern at `value`, looked up among the part's own first. Throws
/// Error{input} `too-large` there when all patterns of the file together have been compared with too many names.
std::vector<int> matching(const Draft& draft, const NameTable& table, const CheckedValue& value,
                          const std::string& pattern, const Part& part);

}  // namespace freeplay
