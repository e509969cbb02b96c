#include "system/force_map.h"

#include "base/index.h"
#include "system/spatial_kinematics.h"

namespace freeplay::force_map {

void to_bodies(const planar::Arm* const (&arms)[2], const double* wrench, const double* derivatives, std::size_t width,
               double* by_q, double* by_v) {
  const planar::Arm ends[2] = {*arms[0], *arms[1]};
  for (std::size_t i = 0; i < 2; ++i) {    // wrench on body i
    for (std::size_t k = 0; k < 2; ++k) {  // moved by body k
      double q[3][3], v[3][3];             // rows Fx Fy Mz at the marker, columns x y theta of body k
      const planar::Arm& arm = ends[k];
      for (std::size_t r = 0; r < 3; ++r) {
        const double* row = derivatives + (6 * i + at(planar::components[r])) * width;
        const double* pose = row + 6 * k;
        const double* twist = row + 12 + 6 * k;
        q[r][0] = pose[0];
        q[r][1] = pose[1];
        q[r][2] = pose[5] - arm.y * pose[0] + arm.x * pose[1] - (arm.x * twist[0] + arm.y * twist[1]) * arm.w;
        v[r][0] = twist[0];
        v[r][1] = twist[1];
        v[r][2] = twist[5] - arm.y * twist[0] + arm.x * twist[1];
      }
      for (std::size_t c = 0; c < 3; ++c) {
        q[2][c] += ends[i].x * q[1][c] - ends[i].y * q[0][c];
        v[2][c] += ends[i].x * v[1][c] - ends[i].y * v[0][c];
      }
      if (i == k) q[2][2] -= ends[i].x * wrench[6 * i] + ends[i].y * wrench[6 * i + 1];
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
          by_q[(3 * i + r) * 6 + 3 * k + c] = q[r][c];
          by_v[(3 * i + r) * 6 + 3 * k + c] = v[r][c];
        }
      }
    }
  }
}

void to_bodies(const spatial::Arm* const (&arms)[2], const double* wrench, const double* derivatives, std::size_t width,
               double* by_q, double* by_v) {
  for (std::size_t i = 0; i < 2; ++i) {    // wrench on body i
    for (std::size_t k = 0; k < 2; ++k) {  // moved by body k
      for (int c = 0; c < 6; ++c) {
        double pose[6], twist[6], speed[6];
        spatial::by_increment(c, *arms[k], pose, twist);
        spatial::by_velocity(c, *arms[k], speed);
        double wrench_q[6], wrench_v[6];
        for (std::size_t r = 0; r < 6; ++r) {
          const double* row = derivatives + (6 * i + r) * width + 6 * k;
          wrench_q[r] = wrench_v[r] = 0.0;
          for (std::size_t n = 0; n < 6; ++n) {
            wrench_q[r] += row[n] * pose[n] + row[12 + n] * twist[n];
            wrench_v[r] += row[12 + n] * speed[n];
          }
        }
        double force_q[6] = {}, force_v[6] = {};
        spatial::add_wrench(wrench_q, *arms[i], force_q);
        spatial::add_wrench(wrench_v, *arms[i], force_v);
        if (i == k) spatial::add_wrench_derivative(c, wrench + 6 * i, *arms[i], force_q);
        for (std::size_t r = 0; r < 6; ++r) {
          by_q[(6 * i + r) * 12 + 6 * k + at(c)] = force_q[r];
          by_v[(6 * i + r) * 12 + 6 * k + at(c)] = force_v[r];
        }
      }
    }
  }
}

// Rows and columns of internal variables have no arm.
void to_internal(const planar::Arm* const (&arms)[2], const double* derivatives, std::size_t width, std::size_t nz,
                 const InternalDerivatives& out) {
  const auto row = [&](std::size_t r) { return derivatives + r * width; };
  for (std::size_t z = 0; z < nz; ++z) {
    for (std::size_t i = 0; i < 2; ++i) {
      const planar::Arm& arm = *arms[i];
      double wrench[3];
      for (std::size_t r = 0; r < 3; ++r) wrench[r] = row(6 * i + at(planar::components[r]))[24 + z];
      wrench[2] += arm.x * wrench[1] - arm.y * wrench[0];
      for (std::size_t r = 0; r < 3; ++r) out.force_z[(3 * i + r) * nz + z] = wrench[r];

      const double* pose = row(12 + z) + 6 * i;
      const double* twist = row(12 + z) + 12 + 6 * i;
      double* by_q = &out.rate_q[6 * z + 3 * i];
      double* by_v = &out.rate_v[6 * z + 3 * i];
      planar::body_row(twist, arm, by_v);
      planar::body_row(pose, arm, by_q);
      by_q[2] -= (arm.x * twist[0] + arm.y * twist[1]) * arm.w;
    }
    for (std::size_t k = 0; k < nz; ++k) out.rate_z[z * nz + k] = row(12 + z)[24 + k];
  }
}

void to_internal(const spatial::Arm* const (&arms)[2], const double* derivatives, std::size_t width, std::size_t nz,
                 const InternalDerivatives& out) {
  const auto row = [&](std::size_t r) { return derivatives + r * width; };
  for (std::size_t z = 0; z < nz; ++z) {
    for (std::size_t i = 0; i < 2; ++i) {
      double wrench[6], force[6] = {};
      for (std::size_t r = 0; r < 6; ++r) wrench[r] = row(6 * i + r)[24 + z];
      spatial::add_wrench(wrench, *arms[i], force);
      for (std::size_t r = 0; r < 6; ++r) out.force_z[(6 * i + r) * nz + z] = force[r];
      const double* rate = row(12 + z) + 6 * i;
      for (int c = 0; c < 6; ++c) {
        double pose[6], twist[6], speed[6], by_q = 0.0, by_v = 0.0;
        spatial::by_increment(c, *arms[i], pose, twist);
        spatial::by_velocity(c, *arms[i], speed);
        for (std::size_t n = 0; n < 6; ++n) {
          by_q += rate[n] * pose[n] + rate[12 + n] * twist[n];
          by_v += rate[12 + n] * speed[n];
        }
        out.rate_q[12 * z + 6 * i + at(c)] = by_q;
        out.rate_v[12 * z + 6 * i + at(c)] = by_v;
      }
    }
    for (std::size_t k = 0; k < nz; ++k) out.rate_z[z * nz + k] = row(12 + z)[24 + k];
  }
}

}  // namespace freeplay::force_map
