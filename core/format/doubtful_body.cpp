#include "format/doubtful_body.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "format/doubtful_number.h"
#include "model/rotation.h"

namespace freeplay {
namespace {

constexpr int most_lookups = 1000;  // of entries: the text is searched for each

double distance(const Vector3& a, const Vector3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The frames of a body, its origin among them only where something stands on it.
struct FrameOutline {
  std::vector<Vector3> places{};
  std::vector<double> from_com{};  // as places
  Vector3 low{}, high{};           // of the box around them
  double reach = 0.0;              // largest distance from the centre of mass [m]
  std::string farthest{};          // BODY/FRAME
  Vector3 farthest_place{};

  double extent() const { return distance(low, high); }
  double outside(const Vector3& point) const {
    Vector3 gap{};
    for (std::size_t i = 0; i < 3; ++i) gap[i] = std::max({low[i] - point[i], point[i] - high[i], 0.0});
    return std::hypot(gap[0], gap[1], gap[2]);
  }
  /// From the centre of mass outwards, the longest way from one place to the next.
  double longest_gap() const {
    std::vector<double> away = from_com;
    std::ranges::sort(away);
    double gap = away.empty() ? 0.0 : away.front();
    for (std::size_t i = 1; i < away.size(); ++i) gap = std::max(gap, away[i] - away[i - 1]);
    return gap;
  }
  void add(const std::string& name, const Vector3& place, double away) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = places.empty() ? place[i] : std::min(low[i], place[i]);
      high[i] = places.empty() ? place[i] : std::max(high[i], place[i]);
    }
    places.push_back(place);
    from_com.push_back(away);
    if (away < reach || (away == reach && !farthest.empty() && farthest < name)) return;
    reach = away;
    farthest = name;
    farthest_place = place;
  }
};

/// By body, ground last.
std::vector<FrameOutline> outlines(const Draft& draft, bool all_origins) {
  const std::vector<Body>& bodies = draft.model.bodies;
  std::vector<FrameOutline> out(bodies.size() + 1);
  for (const auto& [name, frame] : draft.frames) {
    if (name.ends_with("/com") && !draft.markers.contains(name)) continue;
    if (name.ends_with("/origin") && !draft.markers.contains(name) && (frame.body == ground || !all_origins)) continue;
    if (frame.body == ground) {
      out.back().add(name, frame.position, distance(frame.position, {}));
    } else {
      const auto i = static_cast<std::size_t>(frame.body);
      out[i].add(name, frame.position, distance(frame.position, bodies[i].com));
    }
  }
  out.back().reach = out.back().places.size() > 1 ? 0.5 * out.back().extent() : 0.0;
  return out;
}

/// Largest principal moment [kg m^2].
double largest_moment(const Body& body, bool in_space) {
  return in_space ? principal_moments(body.inertia)[2] : body.inertia[8];
}

double gyration_of(const Body& body, bool in_space) { return std::sqrt(largest_moment(body, in_space) / body.mass); }

/// Whether the reach of a body says how long it is: not of a rotor whose centre of mass is a little off its only frame
/// and which is as heavy as a disc of its radius of gyration.
bool is_length(const FrameOutline& outline, double gyration, double mass) {
  const double disc = 2.0 * std::numbers::pi * gyration * gyration;
  return outline.reach > 1e-12 &&
         (outline.places.size() > 1 || outline.reach > body_limit::arm * gyration || mass <= body_limit::sheet * disc);
}

/// Of bodies, then ground's.
std::vector<double> sorted_reaches(const std::vector<FrameOutline>& outlines, const Draft& draft) {
  const bool in_space = draft.model.space == Space::spatial;
  std::vector<double> reaches;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const bool moves = i < draft.model.bodies.size();  // the last is ground's
    const double gyration = moves ? gyration_of(draft.model.bodies[i], in_space) : 0.0;
    if (is_length(outlines[i], gyration, moves ? draft.model.bodies[i].mass : 0.0))
      reaches.push_back(outlines[i].reach);
  }
  std::ranges::sort(reaches);
  return reaches;
}

/// Does a place, which is `at`, say a unit of length beside the largest of its numbers? That of an angle, or of
/// another direction, says nothing of it.
bool place_says_unit(const CheckedValue& place, const Vector3& at) {
  const auto by_size = [&](std::size_t a, std::size_t b) { return std::abs(at[a]) < std::abs(at[b]); };
  const std::size_t largest = std::max({std::size_t{0}, std::size_t{1}, std::size_t{2}}, by_size);
  const auto vector_says = [&](const CheckedValue& vector) {
    return says_unit(vector.node().is_list() && vector.node().items.size() > largest ? vector.item(largest) : vector);
  };
  if (!place.node().is_map()) return vector_says(place);
  return std::ranges::any_of(place.node().entries, [&](const Node::Entry& entry) {
    const CheckedValue part(place.reading(), *entry.value, entry.key, place.path());
    if (entry.key->text == "position") return vector_says(part);
    return entry.key->text == "polar" && !entry.value->items.empty() && says_unit(part.item(0));
  });
}

class BodyDoubts {
 public:
  explicit BodyDoubts(const Draft& draft)
      : draft_(draft),
        in_space_(draft.model.space == Space::spatial),
        outlines_(outlines(draft, false)),
        reaches_(sorted_reaches(outlines_, draft)) {
    std::vector<double> densities;
    for (std::size_t i = 0; i < draft.model.bodies.size(); ++i) {
      const Body& body = draft.model.bodies[i];
      gyration_.push_back(gyration_of(body, in_space_));
      density_.push_back(density(body.mass, gyration_[i], outlines_[i].reach));
      if (density_[i] > 0.0) densities.push_back(density_[i]);
    }
    std::ranges::sort(densities);
    if (!densities.empty()) usual_density_ = densities[(densities.size() - 1) / 2];
  }

  void run() const {
    for (std::size_t i = 0; i < draft_.model.bodies.size(); ++i) judge(i);
    if (is_far(outlines_.back())) judge_length(outlines_.back(), std::nullopt);
  }

 private:
  /// Of a body as large as its radius of gyration allows: a disc has the largest area, 2 pi k^2. 0 when unknown.
  static double density(double mass, double gyration, double reach) {
    const double depth = std::max(2.0 * reach, 4.0 * gyration);
    return gyration > 0.0 ? mass / (2.0 * std::numbers::pi * gyration * gyration * depth) : 0.0;
  }

  double scale() const { return reaches_.empty() ? 0.0 : reaches_[(reaches_.size() - 1) / 2]; }

  /// Middle one of the others, for one that is among the longest.
  double scale_of_others() const { return reaches_.size() < 2 ? 0.0 : reaches_[(reaches_.size() - 2) / 2]; }

  /// Frames in a row that goes far, as those of a chain of many links on the ground, are no mistake.
  bool is_far(const FrameOutline& outline) const {
    const double far = bare_limit::length * scale_of_others();
    return far > 0.0 && outline.reach > far && outline.longest_gap() > far;
  }

  void judge(std::size_t i) const {
    if (lookups_ > most_lookups) return;
    if (judge_large_inertia(i) || judge_far_frame(i) || judge_large_mass(i)) return;
    if (judge_small_inertia(i) || judge_small_mass(i) || judge_com(i)) return;
    if (in_space_) judge_axis(i);
  }

  /// Does it come from a robot file, which knows no units?
  bool is_foreign(std::size_t i) const {
    const auto entry = entry_of(draft_, "bodies", body(i).name);
    return entry && entry->key_node()->foreign;
  }

  const Body& body(std::size_t i) const { return draft_.model.bodies[i]; }

  std::optional<CheckedValue> key_of(std::size_t i, const char* key) const {
    ++lookups_;
    const auto entry = entry_of(draft_, "bodies", body(i).name);
    if (!entry || !entry->node().is_map()) return std::nullopt;
    MapReader map(*entry, "body");
    return map.find(key);
  }

  void warn(std::size_t i, const char* key, const char* id, const std::string& text) const {
    if (const auto value = key_of(i, key)) {
      // Instances of a template share the text: the first of them is enough.
      if (doubted_.insert(&value->node()).second) value->warn(id, text);
    } else if (const auto entry = entry_of(draft_, "bodies", body(i).name)) {
      entry->warn_at_key(id, text);
    }
  }

  std::string moment_words(std::size_t i) const {
    return fmt::format(
        "the inertia of '{}' is {:.4g} kg*m^2 for a mass of {:.4g} kg: its radius of gyration would be "
        "{:.4g} m",
        body(i).name, largest_moment(body(i), in_space_), body(i).mass, gyration_[i]);
  }

  bool judge_large_inertia(std::size_t i) const {
    const double own_reach = is_length(outlines_[i], gyration_[i], body(i).mass) ? outlines_[i].reach : 0.0;
    const double around = std::max(own_reach, scale());
    if (!(around > 0.0)) return judge_lone_inertia(i);
    if (gyration_[i] <= body_limit::gyration * around) return judge_airy_body(i);
    const double disc = 2.0 * std::numbers::pi * gyration_[i] * gyration_[i];
    if (body(i).mass > body_limit::sheet * disc && gyration_[i] <= body_limit::any_gyration * around)
      return judge_airy_body(i);
    const bool own = own_reach >= around;
    // A mass that would go with this inertia and these lengths may be the one that is meant.
    const double fitting = largest_moment(body(i), in_space_) / (0.25 * around * around);
    const bool by_mass = fitting < body_limit::bare_density * around * around * around;
    warn(i, "inertia", "doubtful-inertia",
         fmt::format("{}, but {} {:.4g} m: check {}{}", moment_words(i),
                     own ? "its frames reach" : "the lengths of the mechanism are about", around,
                     by_mass ? "mass and inertia" : "the number",
                     is_foreign(i) ? ""
                     : by_mass     ? ", and their units"
                                   : " and write its unit, as in 'kg*mm^2'"));
    return true;
  }

  /// Lighter than the air that it would displace, though none of its frames is so far out.
  bool judge_airy_body(std::size_t i) const {
    const double k = gyration_[i];
    if (k <= body_limit::large || body(i).mass >= body_limit::airy * k * k * k) return false;
    if (outlines_[i].reach >= body_limit::past_reach * k || distance(body(i).com, {}) >= body_limit::past_reach * k)
      return false;
    warn(i, "inertia", "doubtful-inertia",
         fmt::format("{}, farther out than any of its frames, and a ball of that size would be as light as air: check "
                     "mass and inertia{}",
                     moment_words(i), is_foreign(i) ? "" : " and write their units, as in 'kg*mm^2'"));
    return true;
  }

  /// Of rotors in a model without lengths: thinner than any foil.
  bool judge_lone_inertia(std::size_t i) const {
    const double disc = 2.0 * std::numbers::pi * gyration_[i] * gyration_[i];
    if (gyration_[i] <= body_limit::lone_gyration || body(i).mass >= body_limit::foil * disc) return false;
    warn(i, "inertia", "doubtful-inertia",
         fmt::format("{}, and a disc of it would have {:.2g} kg/m^2: check mass and inertia{}", moment_words(i),
                     body(i).mass / disc, is_foreign(i) ? "" : " and write their units, as in 'kg*mm^2'"));
    return true;
  }

  /// A length without a unit that is far beyond those around it.
  bool judge_far_frame(std::size_t i) const { return is_far(outlines_[i]) && judge_length(outlines_[i], i); }

  bool judge_length(const FrameOutline& outline, std::optional<std::size_t> i) const {
    const auto frame = draft_.frames.find(outline.farthest);
    if (frame == draft_.frames.end()) return false;
    // The frame's own text, or the centre of mass where that is the far one.
    std::optional<CheckedValue> value;
    if (frame->second.value != nullptr) {
      value.emplace(*frame->second.reading, *frame->second.value, frame->second.key, outline.farthest);
    }
    const double own = distance(outline.farthest_place, {});
    if (i && (!value || distance(body(*i).com, {}) > own)) value = key_of(*i, "com");
    if (!value) return false;
    const bool of_com = i && value->key() == "com";
    if (place_says_unit(*value, of_com ? body(*i).com : outline.farthest_place)) return false;
    const bool foreign = i && (of_com || frame->second.key == nullptr ? is_foreign(*i) : frame->second.key->foreign);
    const double number = of_com ? distance(body(*i).com, {}) : own;
    if (!doubted_.insert(&value->node()).second) return true;
    value->warn("doubtful-length",
                fmt::format("'{}' is {:.4g} m from the origin of its body, but the lengths around it are about {:.4g} "
                            "m: {}",
                            of_com ? body(*i).name + "/com" : outline.farthest, number, scale_of_others(),
                            foreign ? "robot files are in metres"
                                    : fmt::format("write the unit after the numbers, as in '{:.4g} mm'", number)));
    return true;
  }

  bool judge_small_inertia(std::size_t i) const {
    const FrameOutline& outline = outlines_[i];
    if (!(gyration_[i] > 0.0)) return false;
    const bool between =
        outline.places.size() > 1 && outline.outside(body(i).com) == 0.0 && outline.extent() > outline.reach;
    const double slender = outline.reach / gyration_[i];
    if (slender <= (between ? body_limit::slender_between : body_limit::slender)) return false;
    warn(i, "inertia", "doubtful-inertia",
         fmt::format("{}, but its frame '{}' is {:.4g} m away: check the number and the lengths of the body",
                     moment_words(i), outline.farthest, outline.reach));
    return true;
  }

  bool judge_large_mass(std::size_t i) const {
    const double dense = density_[i];
    if (dense > body_limit::density || (dense > body_limit::bare_density && stands_out(i))) {
      warn(i, "mass", "doubtful-mass",
           fmt::format("the mass of '{}' is {:.4g} kg at a radius of gyration of {:.4g} m: its density would be {:.2g} "
                       "kg/m^3, that of osmium is 22590: check mass and inertia{}",
                       body(i).name, body(i).mass, gyration_[i], dense,
                       is_foreign(i) ? "" : fmt::format(" and write their units, as in '{:.4g} g'", body(i).mass)));
      return true;
    }
    return false;
  }

  bool judge_small_mass(std::size_t i) const {
    const double reach = outlines_[i].reach, box = 8.0 * reach * reach * reach;
    if (reach < body_limit::thin_reach || body(i).mass < body_limit::thin_mass) return false;
    const bool thread = body(i).mass < body_limit::thread * 2.0 * reach;
    if (!thread && (body(i).mass > body_limit::thinnest * box || says_length_unit(i))) return false;
    warn(i, "mass", "doubtful-mass",
         fmt::format("the mass of '{}' is {:.4g} kg, but its frames reach {:.4g} m: it would be as thin as a {}; check "
                     "its mass and its lengths, and write their units",
                     body(i).name, body(i).mass, reach, thread ? "spider's thread" : "rope"));
    return true;
  }

  /// Is the farthest frame, or the centre of mass, written with a unit?
  bool says_length_unit(std::size_t i) const {
    const auto frame = draft_.frames.find(outlines_[i].farthest);
    if (frame != draft_.frames.end() && frame->second.value != nullptr &&
        place_says_unit(CheckedValue(*frame->second.reading, *frame->second.value, frame->second.key, frame->first),
                        outlines_[i].farthest_place)) {
      return true;
    }
    const auto com = key_of(i, "com");
    return com && place_says_unit(*com, body(i).com);
  }

  /// Is it dense against the other bodies, and written without a unit?
  bool stands_out(std::size_t i) const {
    if (density_[i] <= body_limit::bare_density_ratio * usual_density_) return false;
    const auto value = key_of(i, "mass");
    return value && !names_a_unit(*value);
  }

  /// Of a rotor on one pin, which may be a little unbalanced, or a link with all of its joints far away.
  bool judge_lone_com(std::size_t i) const {
    if (outlines_[i].places.empty()) return false;
    const double outside = outlines_[i].outside(body(i).com);
    if (!(scale() > 0.0) || !(outside > body_limit::lone_com * scale())) return false;
    const double gyrations =
        outlines_[i].places.size() > 1 ? body_limit::linked_com_gyration : body_limit::lone_com_gyration;
    if (outside <= gyrations * gyration_[i]) return false;
    const auto value = key_of(i, "com");
    if (!value || is_foreign(i) || place_says_unit(*value, body(i).com)) return false;
    warn(i, "com", "doubtful-length",
         fmt::format(
             "the centre of mass of '{}' is {:.4g} m away from its joints where the lengths of the mechanism are "
             "about {:.3g} m: write the unit after the number, as in 'mm'",
             body(i).name, outside, scale()));
    return true;
  }

  bool judge_com(std::size_t i) const {
    const FrameOutline& outline = outlines_[i];
    if (judge_lone_com(i)) return true;
    const double extent = outline.extent(), outside = outline.outside(body(i).com), k = gyration_[i];
    if (outline.places.size() < 2 || !(extent > 1e-12) || !(k > 0.0)) return false;
    if (outside <= body_limit::com_outside * extent || outside <= body_limit::com_outside_gyration * k) return false;
    if (k < body_limit::least_of_box * extent || k > body_limit::most_of_box * extent) return false;
    if (outside > body_limit::lump * k && outside <= body_limit::far * extent) return false;
    const auto value = key_of(i, "com");
    if (!value || is_foreign(i)) return false;  // robots have motors beside their joints
    if (!doubted_.insert(&value->node()).second) return true;
    value->warn("doubtful-com",
                fmt::format("the centre of mass of '{}' is {:.4g} m away from its frames, which extend over {:.4g} m, "
                            "at a radius of gyration of {:.4g} m: check 'com' and the frames",
                            body(i).name, outside, extent, k));
    return true;
  }

  // A rod has its least moment about the line of its joints.
  void judge_axis(std::size_t i) const {
    const FrameOutline& outline = outlines_[i];
    const double extent = outline.extent();
    if (outline.places.size() < 2 || !(extent > 1e-12)) return;
    Vector3 along{};
    for (std::size_t c = 0; c < 3; ++c) along[c] = outline.farthest_place[c] - body(i).com[c];
    if (!(outline.reach > 1e-12)) return;
    for (double& component : along) component /= outline.reach;
    for (const Vector3& place : outline.places) {
      Vector3 d{};
      for (std::size_t c = 0; c < 3; ++c) d[c] = place[c] - body(i).com[c];
      const double across = std::sqrt(std::max(dot(d, d) - dot(d, along) * dot(d, along), 0.0));
      if (across > 0.05 * extent) return;
    }
    const auto apply = [&](const Vector3& u, const Vector3& v) {
      double sum = 0.0;
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) sum += u[r] * body(i).inertia[3 * r + c] * v[c];
      }
      return sum;
    };
    const std::size_t least = std::abs(along[0]) < std::abs(along[1])
                                  ? (std::abs(along[0]) < std::abs(along[2]) ? 0 : 2)
                                  : (std::abs(along[1]) < std::abs(along[2]) ? 1 : 2);
    Vector3 u{};
    u[least] = 1.0;
    const double part = dot(u, along);
    for (std::size_t c = 0; c < 3; ++c) u[c] -= part * along[c];
    const double length = std::sqrt(dot(u, u));
    for (double& component : u) component /= length;
    const Vector3 v{along[1] * u[2] - along[2] * u[1], along[2] * u[0] - along[0] * u[2],
                    along[0] * u[1] - along[1] * u[0]};
    const double a = apply(u, u), b = apply(v, v), c = apply(u, v), about = apply(along, along);
    const double across = 0.5 * (a + b) - std::hypot(0.5 * (a - b), c);
    if (about <= body_limit::axis_ratio * across || about / body(i).mass < 0.01 * extent * extent) return;
    warn(i, "inertia", "doubtful-inertia",
         fmt::format("the frames of '{}' lie on a line, but its moment of inertia about that line ({:.4g} kg*m^2) is "
                     "far above that across it ({:.4g}): check the order of 'inertia', which is Ixx, Iyy, Izz",
                     body(i).name, about, std::max(across, 0.0)));
  }

  const Draft& draft_;
  bool in_space_;
  std::vector<FrameOutline> outlines_;
  std::vector<double> reaches_;
  std::vector<double> gyration_, density_;  // by body
  double usual_density_ = 0.0;
  mutable std::set<const Node*> doubted_;
  mutable int lookups_ = 0;
};

}  // namespace

double length_scale(const Draft& draft) {
  const std::vector<FrameOutline> all = outlines(draft, true);
  const std::vector<double> reaches = sorted_reaches(all, draft);
  if (!reaches.empty()) return reaches[(reaches.size() - 1) / 2];
  // Where rotors alone turn in bearings on ground, the only frame has its origin as neighbour.
  return all.back().places.size() == 1 ? 0.5 * distance(all.back().places.front(), {}) : 0.0;
}

void doubt_bodies(const Draft& draft) { BodyDoubts(draft).run(); }

std::optional<CheckedValue> entry_of(const Draft& draft, const std::string& section, const std::string& name) {
  for (const Part& part : draft.parts) {
    if (!name.starts_with(part.prefix)) continue;
    const auto entries = part.section(section);
    if (!entries || !entries->node().is_map()) continue;
    const std::string own = name.substr(part.prefix.size());
    for (const Node::Entry& entry : entries->node().entries) {
      if (entry.key->text != own) continue;
      return CheckedValue(entries->reading(), *entry.value, entry.key, entries->path() + "." + own);
    }
  }
  return std::nullopt;
}

}  // namespace freeplay
