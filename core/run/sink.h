// Sink: where rows and events of a run go.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "model/channel.h"

namespace freeplay {

/// A contact that ended, or what one has taken that is still on; NaN: not known.
struct ContactRecord {
  double approach_speed;      ///< at which it began [m/s]
  double impulse;             ///< of the normal force [N s]
  double tangential_impulse;  ///< of the friction force [N s]
  double energy_lost;         ///< [J]
  double impact;              ///< 1, or 0 for a lasting contact
  double begin;               ///< [s]
};

/// One event of a joint. Fields that were not given are NaN.
struct EventRecord {
  double time = 0.0;
  int joint = 0;
  int event = 0;                           ///< index into the joint's events
  std::span<const double> fields;          ///< as the event declares them; valid during the call only
  const ContactRecord* contact = nullptr;  ///< that the event ended; valid during the call only
};

/// Receives a run as it grows. Rows hold every channel in the order of Channels::all(); a sink picks what it writes.
/// Writing failures are thrown as Error{file} from any function but row() and event(), which keep the first failure
/// and report it by ok().
class Sink {
 public:
  virtual ~Sink() = default;
  virtual void row(std::span<const double> values) = 0;
  /// A row inside a contact, between those of the output grid.
  virtual void row_in_contact(std::span<const double> values) { row(values); }
  virtual void event(const EventRecord& record) = 0;
  /// A contact that is on at the end of the run: `event` is the one that would end it, and has not happened.
  virtual void open_contact(const EventRecord&) {}
  virtual bool ok() const = 0;
};

}  // namespace freeplay
