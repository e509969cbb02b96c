#include "stage/prescribed_bodies.h"

#include <algorithm>

#include "base/index.h"

namespace freeplay {

std::vector<PrescribedBody> prescribed_bodies(const ConstraintJacobian& jacobian, std::span<const char> dependent) {
  const std::size_t bodies = at(jacobian.layout().free_bodies());
  std::vector<std::vector<int>> rows_of(bodies), bodies_of(dependent.size());
  for (const JacobianBlock& block : jacobian.blocks()) {
    for (int r = block.row; r < block.row + block.rows; ++r) {
      std::vector<int>& touched = bodies_of[at(r)];
      if (dependent[at(r)] || std::ranges::count(touched, block.body) > 0) continue;
      touched.push_back(block.body);
      rows_of[at(block.body)].push_back(r);
    }
  }
  // What a body waits for: rows with another body that is not prescribed yet.
  std::vector<PrescribedBody> found;
  std::vector<char> known(bodies, 0);
  std::vector<int> open(dependent.size());
  for (std::size_t r = 0; r < open.size(); ++r) open[r] = static_cast<int>(bodies_of[r].size());
  std::vector<int> look(bodies);
  for (std::size_t b = 0; b < bodies; ++b) look[b] = static_cast<int>(b);
  for (std::size_t next = 0; next < look.size(); ++next) {
    const int body = look[next];
    if (known[at(body)]) continue;
    std::vector<int> own;
    std::ranges::copy_if(rows_of[at(body)], std::back_inserter(own), [&](int r) { return open[at(r)] == 1; });
    if (own.size() != at(jacobian.layout().body_velocities())) continue;
    known[at(body)] = 1;
    std::ranges::copy(own, found.emplace_back(PrescribedBody{body, {}}).rows.begin());
    for (const int r : rows_of[at(body)]) {
      if (--open[at(r)] != 1) continue;
      for (const int other : bodies_of[at(r)]) {
        if (!known[at(other)]) look.push_back(other);
      }
    }
  }
  return found;
}

}  // namespace freeplay
