// SdfFrames: the named frames of an SDFormat file, each in its scope, and where they stand.
//
// World, models, links, joints and plain frames are frames. A pose is relative to a frame of its own scope, or of a
// model in it by `model::frame`; names never lead out of a scope.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "urdf/element.h"

namespace freeplay::sdf {

using urdf::Element;
using urdf::Messages;
using urdf::Spot;

struct Frame {
  enum class Kind { world, model, link, joint, plain };
  /// Another frame by the name that the file gives it.
  struct Name {
    std::string text;
    Spot spot;
  };

  Kind kind = Kind::plain;
  int scope = -1;  ///< frame of the model or world in which it is declared
  std::string name;
  Spot spot;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< as written
  Name relative_to;                                        ///< empty: what its kind says
  Name attached_to;  ///< of a joint the child, of a model the canonical link; empty: what its kind says
  Name placement;    ///< of a model: the frame in it that `pose` places; empty: its own
  bool is_static = false;
};

class Frames {
 public:
  static constexpr int world = 0, none = -1;

  explicit Frames(Messages& messages) : messages_(messages) { frames_.emplace_back().kind = Frame::Kind::world; }

  /// With `strict`, all frames of a scope have names of their own; else those of a kind. Another one is reported.
  int add(Frame frame, bool strict);
  const Frame& operator[](int frame) const { return frames_[static_cast<std::size_t>(frame)]; }
  int size() const { return static_cast<int>(frames_.size()); }

  /// Finds what each frame is relative and attached to, and where it stands. Reports unknown names and cycles.
  void resolve();

  /// In the world, at coordinates zero.
  Eigen::Isometry3d pose(int frame) const;
  /// The frame of the link that carries a frame, or `world`.
  int carrier(int frame) const;
  /// A frame by a name that stands in a scope: `none` after a message.
  int find(int scope, const Frame::Name& name) const;
  /// The same without a message.
  int look_up(int scope, const std::string& name) const;
  /// The name from the world down, joined by '-'; without `top`, a model that needs none.
  std::string path(int frame, int top) const;

 private:
  int base_of(int frame) const;
  int support_of(int frame);
  Eigen::Isometry3d pose_in(int frame, int scope) const;
  void add_path(int frame, int scope, std::vector<int>& path) const;
  std::vector<int> needs(int frame) const;
  void place(int frame);
  void place_all(int first);
  void find_carriers();

  Messages& messages_;
  std::vector<Frame> frames_;
  std::map<std::pair<int, std::string>, int> names_;  ///< by scope
  std::vector<int> bases_, placements_;               ///< of each frame: what its pose is relative to, what it places
  std::vector<int> carriers_;
  std::map<int, int> first_links_, first_models_;  ///< of models
  std::vector<Eigen::Isometry3d> local_;           ///< of each frame in its scope
  std::vector<int> marks_;
};

}  // namespace freeplay::sdf
