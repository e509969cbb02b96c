#include "format/joint_chain.h"

#include <fmt/format.h>

#include "base/index.h"
#include "format/joint_section.h"
#include "model/rotation.h"

namespace freeplay {
namespace {

class Chain {
 public:
  Chain(Draft& draft, const Component& type, const CheckedParameters& parameters, const CheckedValue& entry)
      : draft_(draft), chain_(*type.description.chain), type_(type), parameters_(parameters), entry_(entry) {}

  bool make(std::size_t index, int coordinate) {
    const JointElement whole = draft_.model.joints[index];
    const std::string body = whole.name + "." + chain_.body, first = whole.name + "." + chain_.first.name,
                      second = whole.name + "." + chain_.second.name;
    const int made = static_cast<int>(index);
    if (!draft_.bodies.add(body)) return taken("body", body);
    add_body(body);
    const int middle = draft_.marker(body + "/origin");
    if (!draft_.joints.rename(made, first)) return taken("joint", first);
    if (!draft_.joints.add(second)) return taken("joint", second);
    draft_.model.joints.emplace_back();
    draft_.joint_usable.push_back(false);
    bool good = true;
    for (const bool is_first : {true, false}) {
      JointElement part = whole;
      part.name = is_first ? first : second;
      (is_first ? part.marker_b : part.marker_a) = middle;
      const std::size_t at = is_first ? index : draft_.model.joints.size() - 1;
      good = good && fill(is_first ? chain_.first : chain_.second, whole.name, part);
      draft_.joint_usable[at] = good;
      draft_.model.joints[at] = part;
    }
    if (coordinate > 0) draft_.joints.also(whole.name, coordinate == 1 ? made : made + 1);
    const std::string hint = coordinate_hint(*whole.ideal_component());
    draft_.divided[whole.name] = "name '" + first + "' or '" + second + "'" + (hint.empty() ? hint : ", or " + hint);
    return good;
  }

 private:
  bool taken(const char* kind, const std::string& name) const {
    entry_.fail_at_key(
        "duplicate-name",
        fmt::format("there is a {} '{}' already, as '{}' with play has one of that name", kind, name, entry_.key()));
    return false;
  }

  const ParameterValue& value(const char* name) const {
    const auto found = parameters_.block->values.find(std::string_view(name));
    if (found != parameters_.block->values.end()) return found->second;
    fail_type(fmt::format("it has no parameter '{}' of its chain", name));
  }
  [[noreturn]] void fail_type(const std::string& why) const {
    throw Error(Error::Category::plugin, "plugin-failed",
                fmt::format("the type '{}' cannot be used: {}", type_.description.name, why), entry_.key_location());
  }

  void add_body(const std::string& name) {
    Body& body = draft_.model.bodies.emplace_back();
    body.name = name;
    body.location = entry_.key_location();
    body.gravity = draft_.model.gravity;
    body.mass = value(chain_.mass).number;
    const auto& moments = value(chain_.inertia).vector;
    body.inertia = {moments[0], 0.0, 0.0, 0.0, moments[1], 0.0, 0.0, 0.0, moments[2]};
    const int id = static_cast<int>(draft_.model.bodies.size()) - 1;
    draft_.frames[name + "/origin"] = draft_.frames[name + "/com"] = {id, {}, 0.0};
  }

  /// The whole block, of which the part's type takes what it knows.
  ParameterBlock block_of(const Component& type) const {
    ParameterBlock block{&type, {}};
    for (const Parameter& one : type.description.parameters) {
      const auto found = parameters_.block->values.find(std::string_view(one.name));
      if (found == parameters_.block->values.end())
        fail_type(fmt::format("a part needs '{}', which it lacks", one.name));
      block.values.emplace(found->first, found->second);
    }
    return block;
  }

  bool fill(const JointPart& part, const std::string& whole, JointElement& element) {
    const Component* loose = draft_.registry.find(ComponentKind::joint, part.type);
    const char* word = loose == nullptr ? nullptr : loose->description.ideal;
    const Component* ideal = word == nullptr ? nullptr : draft_.registry.find(ComponentKind::joint, word);
    if (ideal == nullptr) fail_type(fmt::format("its part '{}' needs a type '{}' with play", part.name, part.type));
    turn(part, loose->description.axis, element);
    const CheckedParameters own{block_of(*loose), parameters_.places, parameters_.fields};
    const CheckedParameters closed{block_of(*ideal), parameters_.places, parameters_.fields};
    IdealTwin twin{.component = ideal, .joint = {}, .layout = {}};
    if (!make_joint(draft_, closed, entry_, twin.joint, twin.layout)) return false;
    JointRef joint;
    JointLayout layout;
    if (!make_joint(draft_, own, entry_, joint, layout)) return false;
    element.parameters = std::make_shared<const ParameterBlock>(*own.block);
    // Both, as each may be meant by a pattern of its own.
    const bool by_whole = is_made_ideal(draft_, whole), by_part = is_made_ideal(draft_, element.name);
    element.has_play = !by_whole && !by_part;
    element.component = element.has_play ? loose : ideal;
    element.joint = element.has_play ? joint : twin.joint;
    element.layout = element.has_play ? layout : twin.layout;
    if (element.has_play) {
      element.twin = std::make_shared<const IdealTwin>(twin);
    } else {
      draft_.model.ideal.push_back(element.name);
    }
    return true;
  }

  void turn(const JointPart& part, MarkerAxis axis, JointElement& element) {
    const Vector3 own = axis == MarkerAxis::x ? Vector3{1.0, 0.0, 0.0} : Vector3{0.0, 0.0, 1.0},
                  wanted{part.axis[0], part.axis[1], part.axis[2]};
    element.axis = wanted;
    if (wanted == own) return;
    const Rotation rotation = least_rotation(own, wanted);
    element.marker_a = draft_.turned_marker(element.marker_a, rotation);
    element.marker_b = draft_.turned_marker(element.marker_b, rotation);
  }

  Draft& draft_;
  const JointChain& chain_;
  const Component& type_;
  const CheckedParameters& parameters_;
  const CheckedValue& entry_;
};

}  // namespace

bool make_chain(Draft& draft, const Component& type, const CheckedParameters& parameters, int coordinate,
                const CheckedValue& entry, std::size_t index) {
  return Chain(draft, type, parameters, entry).make(index, coordinate);
}

}  // namespace freeplay
