// AnalysisMap: the table of an analysis on a grid of x and y, drawn as a map.
#pragma once

#include <string>

#include "analysis/analyse.h"

namespace freeplay {

/// Condition numbers, or the position errors of an analysis of errors [um]. Throws Error{usage} "bad-value" where the
/// table has no such column or stands on no such grid.
std::string analysis_map_svg(const IdealMechanism& mechanism, const AnalysisRequest& request,
                             const RequestedStations& stations, const AnalysisTable& table, bool coloured,
                             const TickOf& tick_of);

}  // namespace freeplay
