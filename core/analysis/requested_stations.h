// RequestedStations: the stations that a request names, checked against what the mechanism can do.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/mobility.h"
#include "analysis/request.h"
#include "analysis/station.h"

namespace freeplay {

/// The tick for a part of the work: what is counted, up to how many.
using TickOf = std::function<Tick(const char* what, std::size_t total)>;

/// Finds them on construction. Throws Error{usage} for what a request asks and the mechanism does not have,
/// Error{input} where the model gives no poses or leaves freedoms to no input, Error{numerical} "ik-unreachable".
class RequestedStations {
 public:
  RequestedStations(IdealMechanism& mechanism, const AnalysisRequest& request, const TickOf& tick_of);

  const std::vector<Station>& all() const { return stations_; }
  /// By station: the number of its branch; empty where no branches were asked for.
  const std::vector<int>& branches() const { return branch_of_; }
  /// Components of a pose that are given.
  const Components& given() const { return given_; }
  /// Of each component where the stations stand on a grid; else null.
  const std::array<GridValues, most_components>* grid() const { return on_grid_ ? &axes_ : nullptr; }
  const std::optional<GeneralMobility>& mobility() const { return mobility_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  const Model& model() const { return mechanism_.model(); }
  const PoseForm& form() const { return mechanism_.form(); }
  const AnalysisSection& section() const { return model().analysis; }

  void find_freedoms();
  void check_inputs();
  void check_outputs();
  void warn_idle_elbow();
  void find();
  void at_poses();
  void at_inputs();
  void on_path(const GridValues& times);
  void on_axes();
  Components default_components();
  void leave_out_ends();
  void check_reach();
  void find_branches();

  IdealMechanism& mechanism_;
  const AnalysisRequest& request_;
  const TickOf& tick_of_;
  std::optional<GeneralMobility> mobility_;
  int freedoms_ = 3;  // of the platform
  Components given_{true, true, true};
  std::vector<JointWay> ways_;  ///< that postures keep to
  std::vector<Station> stations_;
  std::vector<int> branch_of_;
  std::array<GridValues, most_components> axes_;
  bool on_grid_ = false;
  std::vector<std::string> warnings_;
};

}  // namespace freeplay
