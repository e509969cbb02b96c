#include "assembly/play_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "assembly/play_gap.h"
#include "base/index.h"
#include "component/joint_roles.h"
#include "component/parameter_block.h"
#include "linear/stacked_rows.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_corrections = 30, most_shortenings = 6;
constexpr double same_offset = 1e-13;      // of the model's size and of a radian
constexpr double inside = 0.99;            // of the farthest place, after offsets were shortened
constexpr double rounding = 1.0 + 1e-9;    // of a distance
constexpr double without_clearance = 1.0;  // weight of rows of a joint that states none

bool gives(const JointElement& joint, std::string_view last_word) {
  if (!joint.parameters) return false;
  return std::ranges::any_of(joint.parameters->values,
                             [&](const auto& entry) { return entry.second.given && entry.first.ends_with(last_word); });
}

// Gauss and Newton on all ranks, each in what those before leave free.
bool converge(ClosedMechanism& mechanism, const std::vector<PlayRank>& ranks, const VectorXd& weights) {
  const System& system = mechanism.system;
  for (int step = 0; step < most_corrections; ++step) {
    const ClosedMechanism::Rows rows = mechanism.position_rows();
    std::array<std::vector<Eigen::Index>, 3> chosen;
    VectorXd weight = VectorXd::Ones(rows.residual.size());
    double open = 0.0;
    for (std::size_t i = 0; i < rows.row.size(); ++i) {
      const PlayRank rank = rows.row[i] < 0 ? PlayRank::constraint : ranks[at(rows.row[i])];
      const auto index = static_cast<Eigen::Index>(i);
      chosen[static_cast<std::size_t>(rank)].push_back(index);
      if (rank == PlayRank::constraint) open = std::max(open, std::abs(rows.residual[index]));
      if (rank != PlayRank::constraint) weight[index] = weights[rows.row[i]];
    }
    const MatrixXd all = weight.asDiagonal() * MatrixXd(rows.matrix);
    const VectorXd wanted = -weight.cwiseProduct(rows.residual);
    StackedRows stack(all.cols());
    for (const auto& rank : chosen) stack.add(all(rank, Eigen::all), wanted(rank));
    VectorXd change = stack.solution();
    if (!change.allFinite()) return false;
    double largest = 0.0;
    for (int i = 0; i < static_cast<int>(change.size()); ++i) {
      largest = std::max(largest, std::abs(change[i]) / (system.coordinates().is_turn(i) ? 1.0 : system.size()));
    }
    if (largest <= same_offset || step + 1 == most_corrections)
      return open <= mechanism.model().settings.assembly_tolerance;
    const std::vector<double> before(mechanism.state.q().begin(), mechanism.state.q().end());
    system.coordinates().retract(before, {change.data(), at(static_cast<int>(change.size()))}, mechanism.state.q());
  }
  return false;
}

double length(const double* v) { return std::hypot(v[0], v[1], v[2]); }

// By how much offsets must be shortened for every journal to stay in its play, or as near to it as it was wanted.
double share_inside(ClosedMechanism& mechanism, const std::vector<InitialOffset>& offsets) {
  const Model& model = mechanism.model();
  double share = 1.0;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointElement& joint = model.joints[j];
    if (!joint.has_play || joint.gear >= 0 || plays_between_walls(joint.layout)) continue;
    const MarkerKinematics &a = mechanism.e.markers[at(joint.marker_a)], &b = mechanism.e.markers[at(joint.marker_b)];
    const double farthest = std::max(joint.layout.clearance, length(offsets[j].position));
    if (const double away = play_gap(joint, model.space, a, b).norm(); away > rounding * farthest)
      share = std::min(share, farthest / away);
  }
  return share;
}

}  // namespace

bool gives_eccentricity(const JointElement& joint) { return gives(joint, "initial.eccentricity"); }
bool gives_velocity(const JointElement& joint) { return gives(joint, "initial.velocity"); }
bool gives_tilt(const JointElement& joint) { return gives(joint, "initial.tilt"); }

bool starts_by_its_load(const JointElement& joint) {
  if (!joint.parameters) return false;
  return std::ranges::any_of(joint.parameters->values, [](const auto& entry) {
    return entry.second.given && entry.second.word > 0 && entry.first.ends_with(".initial");
  });
}

bool could_start_by_its_load(const JointElement& joint) {
  const auto is_start = [](const auto& entry) { return entry.first.ends_with(".initial"); };
  return joint.parameters && std::ranges::any_of(joint.parameters->values, is_start) && !starts_by_its_load(joint);
}

void require_borne_loads(const Model& model, const std::vector<InitialOffset>& offsets) {
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointElement& joint = model.joints[j];
    const double away = length(offsets[j].position), play = joint.layout.clearance;
    if (!joint.has_play || !(play > 0.0) || !starts_by_its_load(joint) || !(away > 2.0 * play)) continue;
    throw Error(
        Error::Category::input, "assembly-failed",
        fmt::format("joint '{}' has no start: its load presses it {:.3g} m deep, where the clearance is {:.3g} m, "
                    "and the mechanism cannot be put together",
                    joint.name, away - play, play),
        joint.location, "check the modulus or the stiffness of its contact and the load, with their units");
  }
}

std::vector<PlayRank> play_ranks(ClosedMechanism& mechanism,
                                 const std::function<bool(const JointElement&)>& gives_start) {
  const System& closed = mechanism.system;
  const Model& model = mechanism.model();
  std::vector<PlayRank> ranks(at(closed.layout().nc()), PlayRank::constraint);
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    if (!model.joints[at(j)].has_play) continue;
    const Slice slice = closed.layout().rows(j);
    std::fill_n(ranks.begin() + slice.offset, slice.size, PlayRank::implied);
  }
  if (std::ranges::none_of(model.joints, [&](const JointElement& one) { return one.has_play && gives_start(one); })) {
    return ranks;
  }
  // A block gives where a journal is and how fast it moves: those are rows on shifts. The others are of its tilt.
  const ClosedMechanism::Rows rows = mechanism.position_rows();
  std::vector<char> shifts(ranks.size(), 0);
  for (Eigen::Index outer = 0; outer < rows.matrix.outerSize(); ++outer) {
    for (SparseMatrix::InnerIterator entry(rows.matrix, outer); entry; ++entry) {
      const int row = rows.row[static_cast<std::size_t>(entry.row())];
      if (row >= 0 && !closed.coordinates().is_turn(static_cast<int>(entry.col())) && entry.value() != 0.0)
        shifts[at(row)] = 1;
    }
  }
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointElement& joint = model.joints[at(j)];
    if (!joint.has_play || !gives_start(joint)) continue;
    const Slice slice = closed.layout().rows(j);
    for (int r = slice.offset; r < slice.offset + slice.size; ++r) {
      if (shifts[at(r)] || gives_tilt(joint)) ranks[at(r)] = PlayRank::given;
    }
  }
  return ranks;
}

bool yield_in_play(ClosedMechanism& mechanism, std::vector<InitialOffset> offsets, const std::vector<PlayRank>& ranks) {
  const System& system = mechanism.system;
  if (system.layout().nv() > most_dense_columns) return false;
  const Model& model = mechanism.model();
  VectorXd weights = VectorXd::Ones(system.layout().nc());
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const double clearance = model.joints[at(j)].layout.clearance;
    const Slice slice = system.layout().rows(j);
    weights.segment(slice.offset, slice.size).setConstant(clearance > 0.0 ? 1.0 / clearance : without_clearance);
  }
  const std::vector<double> centred(mechanism.state.q().begin(), mechanism.state.q().end());
  for (int attempt = 0; attempt < most_shortenings; ++attempt) {
    for (std::size_t j = 0; j < offsets.size(); ++j) {
      if (model.joints[j].has_play) mechanism.system.set_offset(static_cast<int>(j), offsets[j]);
    }
    std::ranges::copy(centred, mechanism.state.q().begin());
    if (!converge(mechanism, ranks, weights)) break;
    const double share = share_inside(mechanism, offsets);
    if (share >= 1.0) return true;
    for (InitialOffset& offset : offsets) {
      for (double& e : offset.position) e *= inside * share;
      offset.turn *= inside * share;
      for (double& angle : offset.tilt) angle *= inside * share;
    }
  }
  std::ranges::copy(centred, mechanism.state.q().begin());
  return false;
}

}  // namespace freeplay
