// Animation: shapes of a model's bodies, its joints, and where they are in some of the rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/json_text.h"
#include "model/model.h"
#include "results/reader.h"

namespace freeplay {

class Animation {
 public:
  /// Of a result with so many rows and these columns. At most 600 frames, fewer but not below 100 to keep poses and
  /// forces within `numbers`; bodies that find no room then stand still, joints have no forces.
  Animation(const Model& model, const std::vector<RecordColumn>& columns, std::size_t rows, std::size_t numbers);

  /// False where no body's pose is in the result.
  bool any() const { return !bodies_.empty(); }
  /// Indices of the columns that row() reads, each once.
  const std::vector<std::size_t>& columns() const { return columns_; }
  /// The next row: its time, and a number for each of columns().
  void row(double time, std::span<const double> numbers);
  /// Bodies that stand still or are not there.
  const std::vector<std::string>& left_out() const { return left_out_; }
  /// Characters of base64 to come, at most.
  std::size_t size() const;
  /// `{frames, rows, times, space, bodies, joints, marks}`; the pose of a body is the place of its centre of mass and
  /// the attitude of its frame, its points are counted from there.
  Json json() const;

 private:
  struct Moving {
    std::vector<std::size_t> places;  // in columns()
    bool still = false;
    std::vector<double> numbers{};
  };
  struct DrawnBody {
    int body;
    Moving pose;
  };
  struct DrawnJoint {
    int joint;
    Moving force;
  };

  void add_bodies(const std::vector<RecordColumn>& columns);
  void add_joints(const std::vector<RecordColumn>& columns);
  void plan(std::size_t rows, std::size_t numbers);
  std::vector<std::size_t> place(const std::vector<RecordColumn>& columns, const std::string& prefix,
                                 std::span<const char* const> names);
  bool drawn(BodyId body) const;
  std::string name_of(BodyId body) const;
  Json point(BodyId body, const Vector3& position) const;
  Json points_of(int body) const;
  Json body_json(const DrawnBody& drawn) const;
  Json joint_json(const DrawnJoint& drawn) const;
  Json marks() const;

  const Model& model_;
  bool planar_;
  std::vector<DrawnBody> bodies_;
  std::vector<DrawnJoint> joints_;
  std::vector<std::size_t> columns_;
  std::vector<std::string> left_out_;
  std::size_t rows_, frames_ = 0, row_ = 0;
  std::vector<std::int32_t> frame_rows_;
  std::vector<double> times_;
};

}  // namespace freeplay
