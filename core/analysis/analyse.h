// analyse(): one analysis of a mechanism, from a request to a table.
#pragma once

#include "analysis/requested_stations.h"
#include "analysis/table.h"

namespace freeplay {

struct AnalysisResult {
  AnalysisTable table;
  std::vector<std::string> warnings;
};

/// The table of a request at its stations. Throws as the rows of each kind do (analysis/rows.h).
AnalysisResult analyse(IdealMechanism& mechanism, const AnalysisRequest& request, const RequestedStations& stations,
                       const TickOf& tick_of);

}  // namespace freeplay
