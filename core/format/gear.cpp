#include "format/gear.h"

#include "format/doubtful_number.h"
#include "format/doubtful_play.h"
#include "format/gear_teeth.h"
#include "format/joint_section.h"
#include "format/loose_gear.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

/// Stands in the list of joints, so that a gear has a name, a row and columns like every joint.
class CoordinateGear final : public Joint {
 public:
  void declare(JointLayout& layout) const override { layout.constraint_rows = 1; }
};

const CoordinateGear shared_gear;
const Component gear_component{ComponentKind::joint,
                               &abi::joint_table<CoordinateGear>,
                               nullptr,
                               {.name = gear_word,
                                .summary = "Gear: the coordinate of one joint is a multiple of that of another.",
                                .formula = "coordinate(second) = ratio coordinate(first) + offset."}};

/// Reads one entry.
class GearEntry {
 public:
  GearEntry(Draft& draft, const Part& part, const CheckedValue& entry, MapReader& map, int joint)
      : draft_(draft), part_(part), entry_(entry), map_(map), joint_(joint) {}

  void read() {
    map_.find("type");
    const auto of = map_.require("of"), ratio = map_.require("ratio"), offset = map_.find("offset"),
               teeth = map_.find("pressure_angle");
    Gear gear;
    gear.joint = joint_;
    const bool paired = of && read_pair(*of, gear);
    const Component* loose = loose_gear(draft_, map_);
    const CheckedParameters play = loose != nullptr ? read_play(*loose, gear, paired) : CheckedParameters{};
    map_.finish();
    const bool given = offset && !(offset->node().is_scalar() && offset->node().text == "auto");
    // Of what dimension they must be is known by the pair alone; they are read without it for their other mistakes.
    const auto read = [&](const CheckedValue& value, const Dimension& by) -> std::optional<double> {
      if (paired) return value.quantity(by);
      const std::optional<Quantity> any = value.any_quantity();
      return any ? std::optional(any->value) : std::nullopt;
    };
    const Dimension first = dimension_of(gear.first), second = dimension_of(gear.second);
    const auto number = ratio ? read(*ratio, second / first) : std::nullopt;
    if (number && *number == 0.0) ratio->fail("out-of-range", "'" + ratio->path() + "' must not be 0");
    if (given) gear.offset = read(*offset, second);
    if (!paired || !ratio) return;
    if (gear.offset) judge_offset(*offset, gear);
    gear.ratio = number.value_or(1.0);
    draft_.model.joints[static_cast<std::size_t>(joint_)].gear = static_cast<int>(draft_.model.gears.size());
    draft_.model.gears.push_back(gear);
    if (play.block) {
      loosen(draft_, gear, play, entry_);
      const JointLayout& layout = draft_.model.joints[static_cast<std::size_t>(joint_)].layout;
      doubt_contact_stiffness(entry_, *play.block, layout, draft_.length_scale);
      doubt_play_inside(play, layout);
    }
    if (teeth && loose == nullptr && number && gear.ratio != 0.0) give_teeth(draft_, *teeth, gear);
  }

 private:
  /// Only between turns the ratio is a plain number, as the teeth need it.
  CheckedParameters read_play(const Component& loose, const Gear& gear, bool paired) {
    const bool turn = paired && dimension_of(gear.first) == dimension_of(gear.second);
    if (turn) return check_parameters(loose, map_, draft_);
    const auto block = map_.find(loose.description.block);
    if (paired && block) {
      block->fail_at_key("wrong-type", "teeth with play join two wheels that turn, no slide", {},
                         "leave '" + block->key() + "' out, or couple two joints that turn");
    }
    return {};
  }

  const JointElement& element(int joint) const { return draft_.model.joints[static_cast<std::size_t>(joint)]; }
  Dimension dimension_of(int joint) const {
    return element(joint).ideal_layout().coordinate == Coordinate::angle ? dimension::angle : dimension::length;
  }

  void judge_offset(const CheckedValue& written, const Gear& gear) const {
    if (element(gear.second).ideal_layout().coordinate == Coordinate::angle) {
      doubt_angle(written, *gear.offset);
    } else {
      doubt_start_length(written, *gear.offset, draft_.length_scale);
    }
  }

  bool read_pair(const CheckedValue& of, Gear& gear) const {
    const auto items = of.list(2);
    if (!items) return false;
    const auto first = coordinate_of((*items)[0]), second = coordinate_of((*items)[1]);
    if (!first || !second) return false;
    if (*first == *second) {
      (*items)[1].fail("duplicate-name",
                       "a gear couples two different joints, not '" + element(*first).name + "' twice");
      return false;
    }
    gear.first = *first;
    gear.second = *second;
    return true;
  }

  std::optional<int> coordinate_of(const CheckedValue& value) const {
    const std::optional<int> joint = draft_.joint(value, part_);
    if (!joint || !draft_.joint_usable[static_cast<std::size_t>(*joint)]) return std::nullopt;
    if (element(*joint).ideal_layout().coordinate != Coordinate::none) return joint;
    value.fail("wrong-type", "joint '" + element(*joint).name + "' has no coordinate that a gear could couple", {},
               coordinate_hint(*element(*joint).ideal_component()));
    return std::nullopt;
  }

  Draft& draft_;
  const Part& part_;
  const CheckedValue& entry_;
  MapReader& map_;
  int joint_;
};

}  // namespace

void make_gear(JointElement& element) {
  element.component = &gear_component;
  element.joint = JointRef(abi::joint_table<CoordinateGear>, &shared_gear);
  shared_gear.declare(element.layout);
}

void add_gears(Draft& draft, const Part& part) {
  const auto section = part.section("joints");
  if (!section || !section->node().is_map()) return;
  for (const CheckedValue& entry : entries_of(*section)) {
    const std::optional<int> joint = draft.joints.find(part.full(entry.key()));
    if (!joint || draft.model.joints[static_cast<std::size_t>(*joint)].component != &gear_component) continue;
    MapReader map(entry, "gear");
    GearEntry(draft, part, entry, map, *joint).read();
  }
}

}  // namespace freeplay
