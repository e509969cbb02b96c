// ChannelFigure: channels of results as a figure.
#pragma once

#include <string>
#include <vector>

#include "plot/figure.h"
#include "results/reader.h"

namespace freeplay::plot {

/// What is drawn of the channels.
enum class View {
  time,       ///< over time
  over,       ///< over another channel
  orbit,      ///< each of two or three over those before it, with equal scales
  spectrum,   ///< amplitudes over frequency
  histogram,  ///< part of the time over value
  polar       ///< tables by bearing sector of a joint, around it
};

struct FigureRequest {
  View view = View::time;
  std::vector<std::string> channels;  ///< patterns; of polar: words of tables
  std::string over;                   ///< the other channel
  std::string joint;                  ///< of polar, and of the orbit of a journal
  std::vector<double> clearances;     ///< of an orbit by result: radius of its circle [m]; 0: none
  RowWindow window;
  double across = 800.0, down = 180.0;  ///< room of the lines of a panel [px]
};

/// A result in a figure.
struct Source {
  std::string name;
  ResultReader* reader;
};

/// Reads each result twice; memory does not grow with the rows, except for a spectrum. Throws Error{usage}
/// "unknown-channel", "unknown-name", "bad-value" and Error{numerical} "too-few-rows"; "no-rows" where the window holds
/// none.
Figure channel_figure(const std::vector<Source>& sources, const FigureRequest& request);

}  // namespace freeplay::plot
