#include "assembly/weak_springs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

#include "assembly/element_number.h"
#include "assembly/element_rates.h"
#include "assembly/row_space.h"
#include "base/index.h"
#include "model/force_element.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double most_given = 50.0;       // of a spring, by its own length, or in radians: usual ones give by a tenth
constexpr double held_by_springs = 1e-3;  // part of the weight that may be left

struct Spring {
  const JointElement* element = nullptr;
  double stiffness = 0.0, preload = 0.0;
  double own = 1.0;  ///< length [m], or one radian
};

bool has_formula(const ParameterBlock& block) {
  return std::ranges::any_of(block.values, [](const auto& entry) {
    return entry.second.formula || entry.second.by_motion || entry.second.law != nullptr;
  });
}

/// Nothing where the element may hold otherwise than by one stiffness.
std::optional<Spring> spring_of(const JointElement& element) {
  if (!element.parameters || has_formula(*element.parameters)) return std::nullopt;
  Spring spring{.element = &element,
                .stiffness = element_number(element, "stiffness"),
                .preload = element_number(element, "preload")};
  if (!(spring.stiffness > 0.0) || std::isnan(spring.preload)) return std::nullopt;
  if (element.ideal_layout().coordinate == Coordinate::angle) return spring;
  spring.own = element_number(element, "free_length");
  return spring.own > 0.0 ? std::optional(spring) : std::nullopt;
}

bool only_damps(const JointElement& element) {
  return element.parameters && !has_formula(*element.parameters) && element_number(element, "stiffness") == 0.0 &&
         !(std::abs(element_number(element, "preload")) > 0.0);
}

VectorXd weight_of(const System& system) {
  VectorXd weight = VectorXd::Zero(system.layout().nv());
  const int width = system.layout().body_velocities(), ways = system.model().space == Space::planar ? 2 : 3;
  for (int b = 0; b < static_cast<int>(system.model().bodies.size()); ++b) {
    const Body& body = system.model().bodies[at(b)];
    for (int i = 0; i < ways; ++i) weight[width * b + i] = body.mass * body.gravity[at(i)];
  }
  return weight;
}

}  // namespace

void doubt_weak_springs(const System& closed, const Evaluation& shut,
                        const std::function<void(const char*, const std::string&, const JointElement&)>& doubt) {
  const Model& model = closed.model();
  const auto pushes = [](const Driver& driver) { return !prescribes(driver.kind); };
  if (!model.forces.empty() || std::ranges::any_of(model.drivers, pushes)) return;
  const VectorXd weight = weight_of(closed);
  const ElementRates rates(closed, shut);
  std::vector<Spring> springs;
  MatrixXd along(0, closed.layout().nv());
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointElement& element = model.joints[at(j)];
    if (!is_force_element(element) || only_damps(element)) continue;
    const std::optional<Spring> spring = spring_of(element);
    const std::optional<MatrixXd> rate = spring ? rates.of(j) : std::nullopt;
    if (!rate) return;
    springs.push_back(*spring);
    along = stacked(along, *rate);
  }
  if (springs.empty() || weight.norm() == 0.0) return;
  const MatrixXd free = null_space(constraint_matrix(closed.jacobian(), shut));
  if (free.cols() == 0) return;
  const MatrixXd arms = (along * free).transpose();
  const VectorXd load = -free.transpose() * weight;
  const auto count = static_cast<int>(springs.size());
  if (rank_of(arms) < count) return;
  const VectorXd forces = least_norm_solution(arms, load, rank_threshold);
  if (!((arms * forces - load).norm() <= held_by_springs * load.norm())) return;
  const auto given = [&](int i) {
    return std::max(std::abs(forces[i]) - std::abs(springs[at(i)].preload), 0.0) / springs[at(i)].stiffness;
  };
  int most = 0;
  for (int i = 1; i < count; ++i) {
    if (given(i) / springs[at(i)].own > given(most) / springs[at(most)].own) most = i;
  }
  const Spring& weakest = springs[at(most)];
  if (!(given(most) > most_given * weakest.own)) return;
  const bool turns = weakest.element->ideal_layout().coordinate == Coordinate::angle;
  doubt("doubtful-value",
        fmt::format(
            "'{}' is so weak that it would have to give by {:.3g} {} to bear the weight that rests on it{}: check "
            "its stiffness and its unit",
            weakest.element->name, given(most), turns ? "rad" : "m",
            turns ? "" : fmt::format(", {:.3g} times its own length", given(most) / weakest.own)),
        *weakest.element);
}

}  // namespace freeplay
