// PolarFigure: tables by bearing sector of a joint with play, around its bearing.
#pragma once

#include "plot/channel_figure.h"

namespace freeplay::plot {

/// Of FigureRequest::joint; `channels` are words of the tables (contact_time, impulse, sliding, work, pv_mean, pv_max).
/// An angle of 0 is to the right, as the x axis of the bearing. Throws Error{usage} "unknown-name" with a suggestion
/// and Error{file} "unreadable-result" where a result has no tables.
Figure polar_figure(const std::vector<Source>& sources, const FigureRequest& request);

}  // namespace freeplay::plot
