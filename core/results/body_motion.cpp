#include "results/body_motion.h"

#include <limits>

#include <fmt/format.h>

#include "base/error.h"

namespace freeplay {
namespace {

/// Row-major, of a unit quaternion w x y z.
void rotation_of(const double* q, double* out) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  const double r[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                       2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                       2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
  std::copy_n(r, 9, out);
}

}  // namespace

BodyMotion::BodyMotion(ResultReader& reader, const System& system) : reader_(reader), system_(system), columns_{0} {
  const bool planar = system.model().space == Space::planar;
  const std::vector<const char*> names =
      planar ? std::vector{"x", "y", "angle"} : std::vector{"x", "y", "z", "qw", "qx", "qy", "qz"};
  for (const Body& body : system.model().bodies) {
    for (const char* name : names) {
      const std::string channel = fmt::format("body.{}.{}", body.name, name);
      columns_.push_back(reader.find(channel));
      if (columns_.back() < reader.layout().columns.size()) continue;
      throw Error(Error::Category::usage, "unknown-channel",
                  fmt::format("'{}' has no channel '{}'", reader.file(), channel), {},
                  "a picture needs the poses of all bodies: run with 'body.*' among the channels");
    }
  }
}

// In the plane the columns are the coordinates; in space the centre of mass and the body's frame.
void BodyMotion::rows(double until, std::size_t also, const Take& take) {
  const Model& model = system_.model();
  const bool planar = model.space == Space::planar;
  const std::size_t width = planar ? 3 : 7, bodies = model.bodies.size();
  std::vector<std::size_t> columns = columns_;
  columns.push_back(also);
  std::vector<double> q(static_cast<std::size_t>(system_.layout().nq()));
  bool over = false;
  const RowWindow window{.until = until};
  reader_.rows(columns, window, [&](std::span<const double> block) {
    for (; !block.empty() && !over; block = block.subspan(columns.size())) {
      const double* pose = &block[1];
      for (std::size_t b = 0; b < bodies; ++b, pose += width) {
        if (planar) {
          std::copy_n(pose, 3, &q[3 * b]);
          continue;
        }
        Pose frame{};
        rotation_of(pose + 3, frame.rotation);
        for (std::size_t i = 0; i < 3; ++i) {
          const double* row = &frame.rotation[3 * i];
          const Vector3& com = model.bodies[b].com;
          frame.position[i] = pose[i] - row[0] * com[0] - row[1] * com[1] - row[2] * com[2];
        }
        system_.coordinates().set_frame_pose(static_cast<BodyId>(b), frame, q);
      }
      over = !take(block[0], q, block[columns.size() - 1]);
    }
  });
}

}  // namespace freeplay
