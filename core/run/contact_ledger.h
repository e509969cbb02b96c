// ContactLedger: impulses and energy loss of every contact of a joint with play, from its begin to its end.
#pragma once

#include <span>
#include <vector>

#include "model/channel.h"
#include "run/area.h"
#include "run/sink.h"
#include "run/step_events.h"
#include "system/joints.h"

namespace freeplay {

/// The energy that a joint loses in a step, by the account of the run, is divided among its contacts in that step in
/// proportion to what each dissipates: their losses add up to the account's. Impulses are the areas under the forces at
/// accepted states.
class ContactLedger {
 public:
  [[gnu::cold]] ContactLedger(const Joints& joints, const Channels& channels);

  bool active() const { return !joints_.empty(); }
  /// An accepted state, at the end of a step or at the start of the run, with its row, with what joints lost since the
  /// start [J] and with the events of the step. `point` and `e` are of that state. False, with `fault`, when a joint
  /// fails.
  bool take_step(std::span<const double> row, std::span<const double> joint_loss, const StepEvents& events,
                 const Point& point, const Evaluation& e, Fault& fault);
  /// The contact that an event of the last step ended, by its place among them; null for other events.
  const ContactRecord* ended(std::size_t happening) const;

  /// A contact that is on, and the event that would end it, or -1.
  struct Open {
    int joint, event;
    ContactRecord record;
  };
  /// Those at the last state, by joint in declaration order. Each call makes the list again: for the end of a run.
  std::vector<Open> open() const;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.time_, self.started_, self.joints_);
  }

 private:
  struct Forces {
    double normal = 0.0, tangential = 0.0, dissipated = 0.0;  // [N, N, W]
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.normal, self.tangential, self.dissipated);
    }
  };
  struct Contact {
    bool on = false;
    double begin = 0.0, approach_speed = 0.0, lost = 0.0;
    Area normal, tangential;
    Forces at_start, at_end;  // of the step
    std::size_t stretch = 0;  // its open one
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.on, self.begin, self.approach_speed, self.lost, self.normal, self.tangential, self.at_end);
    }
  };
  /// A part of the step in which a contact is on.
  struct Stretch {
    std::size_t contact;
    double from, to, lost_before;
    int ended;  // index of what it ended, or -1
  };
  struct EventKind {
    EventRole role;
    std::size_t contact;
    int speed, duration, depth, impact;  // indices of fields, or -1
  };
  struct OfJoint {
    int joint, normal, friction;  // the columns are those of a single contact, or -1
    std::vector<Contact> contacts;
    std::vector<EventKind> kinds;
    double lost = 0.0;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.contacts, self.lost);
    }
  };
  struct Ended {
    std::size_t happening;
    ContactRecord record;
  };

  bool go_on(OfJoint& joint, std::span<const double> row, double lost, double t) const;
  bool look(OfJoint& joint, std::span<const double> row, const Point& point, const Evaluation& e, Fault& fault);
  void open(OfJoint& joint, std::size_t contact, double t);
  void close(OfJoint& joint, std::size_t contact, double t);
  void pass(OfJoint& joint, const StepEvents& events, std::size_t happening);
  void share(OfJoint& joint, double lost, double end);

  const Joints& all_;
  const Channels& channels_;
  double time_ = 0.0;
  bool started_ = false;
  std::vector<OfJoint> joints_;
  std::vector<double> numbers_;     // of the contacts of one joint
  std::vector<Stretch> stretches_;  // of one joint
  std::vector<Ended> ended_;
};

}  // namespace freeplay
