// EventStorm: events of a joint that follow each other without end, as where an event function has the wrong direction.
#pragma once

#include <cstddef>
#include <vector>

namespace freeplay {

/// What authors of joints read where their events cannot be located or do not end.
inline constexpr const char* event_rule =
    "where an event is handled its function must leave zero in the declared direction (rising or falling), or become "
    "NaN "
    "until it can happen again [event-storm]";

/// Counts the events of each joint. A joint is in a storm when more than 1000 events lie within an instant, a few
/// thousand roundings of the time; more than 20 000 within one step size, in runs that end their steps at events; or
/// when a hundred steps in a row hold as many as a step may. Impacts last, and flights between them do, so that no
/// contact comes near that, be its bounces ever shorter.
class EventStorm {
 public:
  struct Limits {
    double instant;    ///< [s]
    double step_size;  ///< 0 where steps are not shortened for events [s]
    int most_in_step;  ///< events of one joint that one step passes on
  };
  EventStorm(std::size_t joints, const Limits& limits) : limits_(limits), counts_(joints) {}

  struct Finding {
    long events = 0;      ///< so many, or 0: no storm
    double within = 0.0;  ///< [s]
  };
  /// An event of a joint in the step of this number; times do not fall.
  Finding note(int joint, double time, long step);

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.counts_);
  }

 private:
  struct Window {
    double from = 0.0;
    long events = 0;
    /// The number of events since `from`, which moves on when it lies more than `length` back.
    long count(double time, double length);
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.from, self.events);
    }
  };
  struct Count {
    Window instant, step_size;
    long step = -1, in_step = 0, full_steps = 0;
    double full_from = 0.0;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.instant, self.step_size, self.step, self.in_step, self.full_steps, self.full_from);
    }
  };
  Limits limits_;
  std::vector<Count> counts_;
};

}  // namespace freeplay
