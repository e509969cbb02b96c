// PlayNoise: how far the figures of a joint's play mean anything.
#pragma once

#include "results/summary.h"

namespace freeplay {

/// By how much PlayFigures may differ in another run; of their units.
struct PlayNoise {
  double flight, impact, lasting, impacts, sliding, work;
};

/// Of a joint with such figures, from FigureNoise: times of flight and of contact vary by as much, those of impacts by
/// a little more than their number; a way of sliding as the time of contact, and its work as the loads besides.
PlayNoise play_noise(const RunRecord& record, int joint);

}  // namespace freeplay
