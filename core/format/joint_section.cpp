#include "format/joint_section.h"

#include <cmath>

#include <fmt/format.h>

#include "base/name_pattern.h"
#include "component/declared.h"
#include "format/doubtful_number.h"
#include "format/doubtful_play.h"
#include "format/gear.h"
#include "format/joint_chain.h"
#include "format/motion_names.h"
#include "format/parameter_check.h"
#include "format/parameter_tree.h"
#include "format/rotation_keys.h"
#include "model/rotation.h"

namespace freeplay {
namespace {

bool same_text(const char* a, const char* b) { return a != nullptr && b != nullptr && std::string_view(a) == b; }

/// Reads one entry of `joints`, or one of `forces` that is a joint.
class JointEntry {
 public:
  JointEntry(Draft& draft, const Part& part, const CheckedValue& entry, std::size_t index)
      : draft_(draft), part_(part), entry_(entry), map_(entry, Uses::presets), index_(index) {}

  void read() {
    if (!map_.good()) return;
    const auto type = map_.require("type");
    if (!element().is_force && type && type->node().is_scalar() && type->node().text == gear_word) {
      make_gear(element());
      draft_.joint_usable[index_] = true;
      return;
    }
    if (element().is_force && type && type->node().is_scalar() && type->node().text == gear_word) {
      return refuse_as_force(*type);
    }
    const Component* named = type ? find_type(draft_.registry, ComponentKind::joint, *type, other_words()) : nullptr;
    // The other keys are judged by the type that was meant.
    known_ = named != nullptr;
    if (!known_ && type) named = meant_type(draft_.registry, ComponentKind::joint, *type, other_words());
    read_ends(named);
    // Without a type it is unknown which keys are allowed.
    if (named == nullptr || !serves_space(*named, *type)) return;
    if (same_text(named->description.ideal, gear_word)) return refuse_as_type(*named, *type);
    choose_twins(*named);
    read_turn(named->description.axis);
    create();
    map_.finish();
    if (known_ && element().is_force) require_force(*type);
  }

 private:
  JointElement& element() { return draft_.model.joints[index_]; }

  /// Words that are not in the registry and that this section knows.
  std::vector<std::string> other_words() const {
    if (draft_.model.joints[index_].is_force) return {"force", "torque", "gravity"};
    return {gear_word};
  }

  void require_force(const CheckedValue& type) {
    if (component_ == ideal_ && (!draft_.joint_usable[index_] || element().layout.constraint_rows == 0)) return;
    refuse_as_force(type);
  }

  static void refuse_as_force(const CheckedValue& type) {
    type.fail("unknown-type", "the type '" + type.node().text + "' is a joint, not a force", {},
              "write it under 'joints'");
  }

  static void refuse_as_type(const Component& named, const CheckedValue& type) {
    type.fail("unknown-type", std::string("'") + named.description.name + "' is what a gear with play is", {},
              std::string("write 'type: gear' with a block '") + named.description.block + "'");
  }

  bool serves_space(const Component& named, const CheckedValue& type) {
    const Space space = draft_.model.space;
    if (serves(named.description.space, space)) return true;
    std::vector<std::string> others;
    for (const RegisteredComponent& other : draft_.registry.components()) {
      if (other.component->kind != ComponentKind::joint || !serves(other.component->description.space, space)) continue;
      others.emplace_back(other.component->description.name);
    }
    const std::string word = space == Space::planar ? "planar" : "spatial";
    type.fail("type-space",
              std::string("the type '") + named.description.name + "' does not work in " + word + " models", {},
              "types that do: " + either(others));
    return false;
  }

  // In space the joint's axis is an axis of its frames: both markers are turned until it is the given one, by the same
  // turn, so that the coordinate keeps its zero.
  void read_turn(MarkerAxis axis) {
    if (draft_.model.space == Space::planar) return map_.refuse("axis", "only in spatial models");
    if (axis == MarkerAxis::none) return map_.refuse("axis", "this type has none");
    const auto value = map_.find("axis");
    const std::optional<Vector3> direction = value ? read_axis(*value) : std::nullopt;
    element().axis = direction;
    if (!direction || element().marker_a == element().marker_b) return;
    const Vector3 own = axis == MarkerAxis::x ? Vector3{1.0, 0.0, 0.0} : Vector3{0.0, 0.0, 1.0};
    if (*direction == own) return;
    const Rotation turn = least_rotation(own, *direction);
    element().marker_a = draft_.turned_marker(element().marker_a, turn);
    element().marker_b = draft_.turned_marker(element().marker_b, turn);
  }

  /// A type with the block of its twin is that twin; a type with play names its ideal twin itself.
  void choose_twins(const Component& named) {
    component_ = &named;
    ideal_ = &named;
    for (const RegisteredComponent& other : draft_.registry.components()) {
      const Description& twin = other.component->description;
      if (other.component->kind != ComponentKind::joint || !same_text(twin.ideal, named.description.name)) continue;
      if (twin.block == nullptr) continue;
      const std::optional<CheckedValue> block = map_.find(twin.block);
      if (!block) continue;
      if (serves(twin.space, draft_.model.space)) {
        component_ = other.component;
      } else {
        refuse_block(named, *block);
      }
    }
    const char* ideal = component_->description.ideal;
    if (ideal == nullptr) return;
    ideal_ = draft_.registry.find(ComponentKind::joint, ideal);
    if (ideal_ == nullptr) {
      throw Error(Error::Category::plugin, "plugin-failed",
                  std::string("the ideal type '") + ideal + "' of '" + component_->description.name + "' is missing",
                  entry_.key_location());
    }
  }

  void refuse_block(const Component& named, const CheckedValue& block) const {
    const bool planar = draft_.model.space == Space::planar;
    block.fail_at_key("type-space", fmt::format("'{}' of the type '{}' works in {} models only", block.key(),
                                                named.description.name, planar ? "spatial" : "planar"));
  }

  // --- ends ------------------------------------------------------------------------------------------------------

  void read_ends(const Component* named) {
    const char* first = named == nullptr ? nullptr : named->description.first_end;
    const char* second = named == nullptr ? nullptr : named->description.second_end;
    const auto between = map_.find("between");
    const bool by_ends = first != nullptr && second != nullptr && (map_.has(first) || map_.has(second));
    if (between) {
      if (by_ends) {
        map_.find(first);
        map_.find(second);
        if (!map_.conflict("between", first)) map_.conflict("between", second);
      }
      if (const auto ends = between->list(2)) join((*ends)[0], (*ends)[1], *between);
      return;
    }
    if (!by_ends) {
      if (named != nullptr) map_.report_missing("between");
      return;
    }
    const auto a = map_.require(first), b = map_.require(second);
    if (a && b) join(*a, *b, *b);
  }

  void join(const CheckedValue& first, const CheckedValue& second, const CheckedValue& place) {
    const std::optional<int> a = draft_.marker(first, part_), b = draft_.marker(second, part_);
    if (!a || !b) return;
    const auto body_of = [&](int marker) { return draft_.model.markers[static_cast<std::size_t>(marker)].body; };
    if (body_of(*a) == body_of(*b)) {
      place.fail("same-body", "both frames of '" + entry_.path() + "' are on '" + body_word(first) + "'");
    }
    element().marker_a = *a;
    element().marker_b = *b;
  }

  /// The body as the file names it, so that the instances of a template share a message.
  static std::string body_word(const CheckedValue& reference) {
    return reference.node().text.substr(0, reference.node().text.find('/'));
  }

  // --- components ------------------------------------------------------------------------------------------------

  void create() {
    IdealTwin ideal{.component = ideal_, .joint = {}, .layout = {}};
    std::vector<MotionChannel> channels;
    const MotionNames names(draft_, part_, channels);
    MotionParameters motion(names);
    const CheckedParameters ideal_parameters =
        check_parameters(*ideal_, map_, draft_, element().is_force ? &motion : nullptr);
    if (ideal_parameters.block) motion.give(*ideal_parameters.block, channels, element());
    const bool twins = ideal_ != component_;
    const bool usable = make_joint(draft_, ideal_parameters, entry_, ideal.joint, ideal.layout);
    if (component_->description.chain != nullptr && !element().is_force) {
      element().component = ideal_;
      element().joint = ideal.joint;
      element().layout = ideal.layout;
      if (usable && known_) create_chain(*ideal_parameters.block);
      return;
    }
    JointRef joint = ideal.joint;
    JointLayout layout = ideal.layout;
    const CheckedParameters parameters = twins ? check_parameters(*component_, map_, draft_) : ideal_parameters;
    if (twins) make_joint(draft_, parameters, entry_, joint, layout);
    if (parameters.block) {
      doubt_parameters(*parameters.block, parameters.places, draft_.length_scale,
                       twins ? bare_limit::bearing : bare_limit::length);
    }
    if (parameters.block) element().parameters = std::make_shared<const ParameterBlock>(*parameters.block);
    const bool play = twins && !is_made_ideal(draft_, element().name);
    if (twins && !play) draft_.model.ideal.push_back(element().name);
    element().component = play ? component_ : ideal_;
    element().joint = play ? joint : ideal.joint;
    element().layout = play ? layout : ideal.layout;
    element().has_play = play;
    if (play) element().twin = std::make_shared<const IdealTwin>(ideal);
    if (twins) doubt_play(entry_, layout, draft_.length_scale);
    if (twins && parameters.block) doubt_play_inside(parameters, layout);
    if (parameters.block) doubt_contact_stiffness(entry_, *parameters.block, layout, draft_.length_scale);
    draft_.joint_usable[index_] = usable && known_;
  }

  void create_chain(const ParameterBlock& ideal) {
    const CheckedParameters parameters = check_parameters(*component_, map_, draft_);
    JointRef judge;
    JointLayout nothing;
    if (!make_joint(draft_, parameters, entry_, judge, nothing)) return;
    doubt_parameters(*parameters.block, parameters.places, draft_.length_scale, bare_limit::bearing);
    const auto coordinate = ideal.values.find(std::string_view(component_->description.chain->coordinate));
    const int which = coordinate == ideal.values.end() ? 0 : coordinate->second.word;
    if (!make_chain(draft_, *component_, parameters, which, entry_, index_)) return;
    doubt_play(entry_, element().layout, draft_.length_scale);
    doubt_play_inside(parameters, element().layout);
    doubt_contact_stiffness(entry_, *parameters.block, element().layout, draft_.length_scale);
  }

  Draft& draft_;
  const Part& part_;
  const CheckedValue& entry_;
  MapReader map_;
  std::size_t index_;
  bool known_ = false;  // else the type is the one that was probably meant
  const Component* component_ = nullptr;
  const Component* ideal_ = nullptr;
};

}  // namespace

bool serves(Space space, Space model_space) {
  return (static_cast<unsigned>(space) & static_cast<unsigned>(model_space)) != 0;
}

bool is_made_ideal(Draft& draft, const std::string& name) {
  bool made = false;
  for (std::size_t i = 0; i < draft.options.ideal.size(); ++i) {
    const std::string& pattern = draft.options.ideal[i];
    if (pattern != "all" && !matches(pattern, name)) continue;
    draft.ideal_matched[i] = true;
    made = true;
  }
  return made;
}

std::string coordinate_hint(const Component& type) {
  for (const Parameter& parameter : type.description.parameters) {
    if (parameter.kind != ParameterKind::choice || std::string_view(parameter.name) != "coordinate") continue;
    std::vector<std::string> keys = words_of(parameter);
    // The default leaves the type without one.
    if (std::isfinite(parameter.default_value)) keys.erase(keys.begin() + std::lround(parameter.default_value));
    for (std::string& word : keys) word = "'coordinate: " + word + "'";
    return "write " + either(keys) + " at the joint";
  }
  return {};
}

bool make_joint(Draft& draft, const CheckedParameters& parameters, const CheckedValue& entry, JointRef& joint,
                JointLayout& layout) {
  joint = JointRef();
  layout = JointLayout();
  layout.space = draft.model.space;
  if (!parameters.block) return false;
  CreationFault fault;
  joint = draft.model.instances.create_joint(*parameters.block, draft.model.space, fault);
  if (!joint) {
    report_fault(fault, parameters, entry);
    return false;
  }
  Message message;
  const std::string fault_text = joint.declare(layout, message) ? declaration_fault(layout) : message.text;
  if (fault_text.empty()) return true;
  throw Error(Error::Category::plugin, "plugin-failed",
              "in '" + entry.path() + "': " + draft.model.instances.words_of(*parameters.block->component) +
                  " failed: " + fault_text,
              entry.key_location());
}

void add_joints(Draft& draft, const Part& part) {
  const auto section = part.section("joints");
  if (!section) return;
  for (const CheckedValue& entry : entries_of(*section)) {
    Draft::check_name(entry);
    const std::string name = part.full(entry.key());
    if (!draft.joints.add(name)) continue;  // only after an instance name was refused
    JointElement& element = draft.model.joints.emplace_back();
    element.name = name;
    element.location = entry.key_location();
    draft.joint_usable.push_back(false);
    const int errors = draft.diagnostics.errors();
    JointEntry(draft, part, entry, draft.model.joints.size() - 1).read();
    const bool good = draft.joint_usable.back() && draft.diagnostics.errors() == errors;
    if (!good) draft.unsure_columns.push_back("joint." + name + ".");
  }
}

void add_force_joint(Draft& draft, const Part& part, const CheckedValue& entry) {
  const int index = static_cast<int>(draft.model.joints.size());
  JointElement& element = draft.model.joints.emplace_back();
  element.name = part.full(entry.key());
  element.location = entry.key_location();
  element.is_force = true;
  draft.joint_usable.push_back(false);
  draft.model.force_elements.push_back({-1, index});
  JointEntry(draft, part, entry, static_cast<std::size_t>(index)).read();
}

void require_ideal_matches(const Draft& draft) {
  for (std::size_t i = 0; i < draft.options.ideal.size(); ++i) {
    const std::string& pattern = draft.options.ideal[i];
    if (pattern == "all" || draft.ideal_matched[i]) continue;
    std::vector<std::string> with_play;
    for (const JointElement& joint : draft.model.joints) {
      if (joint.has_play) with_play.push_back(joint.name);
    }
    const std::string suggested = nearest(pattern, with_play);
    throw Error(Error::Category::usage, "usage", "--ideal " + pattern + ": no joint with clearance has such a name", {},
                suggested.empty() ? "" : "did you mean '" + suggested + "'?");
  }
}

}  // namespace freeplay
