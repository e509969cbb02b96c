// AnalysisRows: the rows that each kind of analysis has for its stations.
#pragma once

#include <string>
#include <vector>

#include "analysis/request.h"
#include "analysis/station.h"
#include "analysis/table.h"

namespace freeplay {

/// `branch_of`: by station, the number of its branch; empty: there is no such column.
/// Warnings that the rows give rise to are appended to `warnings`.
AnalysisTable ik_rows(const IdealMechanism& mechanism, const std::vector<Station>& stations,
                      const std::vector<int>& branch_of, const Tick& tick);
AnalysisTable workspace_rows(IdealMechanism& mechanism, const std::vector<Station>& stations, const Components& given,
                             int threads, const Tick& tick);
AnalysisTable singularity_rows(const IdealMechanism& mechanism, const std::vector<Station>& stations,
                               const Components& given, int threads, const Tick& tick);
AnalysisTable error_rows(const IdealMechanism& mechanism, const std::vector<Station>& stations,
                         const ErrorColumns& columns, int threads, std::vector<std::string>& warnings,
                         const Tick& tick);
/// det A at every station, NaN where it is out of reach: it changes sign across a direct singularity. Empty unless A
/// is square.
std::vector<double> determinants(const IdealMechanism& mechanism, const std::vector<Station>& stations,
                                 const Components& given, int threads, const Tick& tick);
/// Throws Error{numerical} "singular" where the inputs cannot hold the load, Error{usage} for a preload that the
/// mechanism cannot have.
AnalysisTable inverse_dynamics_rows(const IdealMechanism& mechanism, const std::vector<Station>& stations,
                                    double preload, const Tick& tick);

/// "t = 0.1 s" or "x = 0.05, y = 0".
std::string station_words(const PoseForm& form, const Station& station);

/// "joint.B1"; of several plays of a joint in space "joint.B1.upper", say.
std::string play_name(const IdealMechanism& mechanism, const Play& play);

}  // namespace freeplay
