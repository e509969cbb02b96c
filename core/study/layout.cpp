#include "study/layout.h"

#include <algorithm>

#include <fmt/format.h>

namespace freeplay {
namespace {

using Direction = StudyWarmStart::Direction;

constexpr std::uint64_t beyond = std::uint64_t{1} << 62;

std::uint64_t product(std::uint64_t a, std::uint64_t b) {
  __extension__ using Product = unsigned __int128;
  const Product exact = Product{a} * b;
  return exact > beyond ? beyond : static_cast<std::uint64_t>(exact);
}

}  // namespace

StudyLayout::StudyLayout(const StudySection& section, const std::vector<PlannedAxis>& axes, std::size_t models,
                         bool many)
    : section_(section),
      axes_(axes),
      star_(section.combine == StudySection::Combine::star),
      samples_(section.sample ? section.sample->points : 1),
      by_sample_(section.stop.has_value()) {
  if (section.warm_start && section.warm_start->direction == Direction::both) directions_ = 2;
  count(models, many);
}

// Those that go side by side stand in the place of the first. Axes with several fits go beside their choice.
std::vector<std::vector<std::size_t>> StudyLayout::groups() const {
  std::vector<std::vector<std::size_t>> groups;
  std::vector<std::optional<std::size_t>> of_list(section_.side_by_side.size());
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const auto source = static_cast<std::size_t>(&axes_[i].source() - section_.axes.data());
    const auto list = std::ranges::find_if(section_.side_by_side, [&](const std::vector<std::size_t>& one) {
      return std::ranges::find(one, source) != one.end();
    });
    if (list == section_.side_by_side.end()) {
      const bool chosen = axes_[i].source().fits.size() > 1 && !axes_[i].chooses_fit();
      if (chosen) groups.back().push_back(i);
      if (!chosen) groups.push_back({i});
      continue;
    }
    std::optional<std::size_t>& group = of_list[static_cast<std::size_t>(list - section_.side_by_side.begin())];
    if (!group) {
      group = groups.size();
      groups.emplace_back();
    }
    groups[*group].push_back(i);
  }
  return groups;
}

bool StudyLayout::check_lengths(const std::vector<std::vector<std::size_t>>& groups) const {
  bool good = true;
  for (const std::vector<std::size_t>& group : groups) {
    const PlannedAxis& first = axes_[group.front()];
    for (const std::size_t other : group) {
      if (axes_[other].size() == first.size()) continue;
      axes_[other].source().entry.fail_at_key(
          "wrong-length",
          fmt::format("'{}' has {} value{}, '{}' beside it {}", axes_[other].name(), axes_[other].size(),
                      axes_[other].size() == 1 ? "" : "s", first.name(), first.size()));
      good = false;
    }
  }
  return good;
}

void StudyLayout::count(std::size_t models, bool many) {
  const std::vector<std::vector<std::size_t>> groups = this->groups();
  if (!star_ && !check_lengths(groups)) return;
  for (std::size_t i = 0; i < groups.size() && section_.warm_start; ++i) {
    const StudyAxis* along = &section_.axes[section_.warm_start->axis];
    const bool here = std::ranges::any_of(groups[i], [&](std::size_t axis) { return &axes_[axis].source() == along; });
    if (here && !chain_digit_) chain_digit_ = i;
  }
  for (std::size_t model = 0; model < models; ++model) {
    Part part;
    for (const std::vector<std::size_t>& group : groups) {
      Digit digit;
      for (const std::size_t axis : group) {
        if (axes_[axis].present[model]) digit.axes.push_back(axis);
      }
      if (!digit.axes.empty()) digit.size = axes_[digit.axes.front()].size();
      part.combinations =
          star_ ? part.combinations + (digit.axes.empty() ? 0 : digit.size) : product(part.combinations, digit.size);
      part.digits.push_back(std::move(digit));
    }
    part.first_point = points_;
    part.first_base = bases_;
    points_ = std::min(points_ + product(product(part.combinations, directions_), samples_), beyond);
    parts_.push_back(std::move(part));
    if (too_many(many)) return;
    Part& made = parts_.back();
    made.bases = made.combinations;
    if (chain_digit_) {
      for (std::size_t i = *chain_digit_ + 1; i < made.digits.size(); ++i) made.stride *= made.digits[i].size;
      made.bases = made.combinations / made.digits[*chain_digit_].size * pieces(made);
    }
    bases_ += made.bases;
  }
}

std::string StudyLayout::product_text() const {
  std::string text;
  const auto add = [&](std::uint64_t factor, const std::string& what) {
    if (factor > 1) text += fmt::format("{}{} ({})", text.empty() ? "" : star_ ? " + " : " x ", factor, what);
  };
  for (const Digit& digit : parts_.back().digits) {
    std::string names;
    for (const std::size_t axis : digit.axes) names += (names.empty() ? "" : ", ") + axes_[axis].name();
    add(digit.size, names);
  }
  if (samples_ > 1) add(samples_, "samples");
  if (directions_ > 1) add(directions_, "directions");
  return text;
}

bool StudyLayout::too_many(bool many) const {
  const std::uint64_t limit = many ? most_points : many_points;
  if (points_ <= limit) return false;
  const std::string total = points_ == beyond ? "more than 10^18" : fmt::format("{}", points_);
  section_.section.fail_at_key(
      "too-large",
      fmt::format("{} points: {}; at most {} are computed", total, product_text(), many ? "10^12" : "10^8"), {},
      many ? "" : "--yes allows up to 10^12");
  return true;
}

// --- points --------------------------------------------------------------------------------------------------------

const StudyLayout::Part& StudyLayout::part_of_point(std::uint64_t point) const {
  return *std::prev(std::ranges::upper_bound(parts_, point, {}, &Part::first_point));
}

PlacedPoint StudyLayout::at(std::uint64_t point) const {
  const Part& part = part_of_point(point);
  PlacedPoint placed;
  placed.model = static_cast<std::size_t>(&part - parts_.data());
  placed.places.resize(axes_.size());
  std::uint64_t rest = point - part.first_point;
  placed.sample = rest % samples_;
  rest /= samples_;
  placed.down =
      section_.warm_start && (section_.warm_start->direction == Direction::down || rest / part.combinations > 0);
  rest %= part.combinations;
  if (star_) {
    for (const Digit& digit : part.digits) {
      if (rest == 0 || digit.axes.empty()) continue;
      if (rest <= digit.size) {
        for (const std::size_t axis : digit.axes) placed.places[axis] = rest - 1;
        rest = 0;
        continue;
      }
      rest -= digit.size;
    }
    return placed;
  }
  for (auto digit = part.digits.rbegin(); digit != part.digits.rend(); ++digit) {
    for (const std::size_t axis : digit->axes) placed.places[axis] = rest % digit->size;
    rest /= digit->size;
  }
  return placed;
}

std::uint64_t StudyLayout::point_of(const Part& part, std::uint64_t direction, std::uint64_t combination,
                                    std::uint64_t sample) const {
  return part.first_point + (direction * part.combinations + combination) * samples_ + sample;
}

// --- units ---------------------------------------------------------------------------------------------------------

std::uint64_t StudyLayout::pieces(const Part& part) const {
  return std::min(section_.warm_start->pieces, part.digits[*chain_digit_].size);
}

StudyLayout::Span StudyLayout::span(const Part& part, std::uint64_t piece) const {
  const std::uint64_t size = part.digits[*chain_digit_].size, count = pieces(part);
  const auto cut = [&](std::uint64_t i) { return size / count * i + size % count * i / count; };
  return {cut(piece), cut(piece + 1)};
}

StudyLayout::Base StudyLayout::base_of(std::uint64_t unit) const {
  const std::uint64_t base = by_sample_ ? unit % bases_ : unit / samples_;
  Base found;
  found.sample = by_sample_ ? unit / bases_ : unit % samples_;
  found.part = &*std::prev(std::ranges::upper_bound(parts_, base, {}, &Part::first_base));
  found.other = base - found.part->first_base;
  if (chain_digit_) {
    found.piece = found.other % pieces(*found.part);
    found.other /= pieces(*found.part);
  }
  return found;
}

std::uint64_t StudyLayout::unit_of(std::uint64_t base, std::uint64_t sample) const {
  return by_sample_ ? sample * bases_ + base : base * samples_ + sample;
}

std::uint64_t StudyLayout::unit_size(std::uint64_t unit) const {
  if (!chain_digit_) return 1;
  const Base base = base_of(unit);
  const Span here = span(*base.part, base.piece);
  return (here.end - here.begin) * directions_;
}

std::uint64_t StudyLayout::unit_point(std::uint64_t unit, std::uint64_t place) const {
  const Base base = base_of(unit);
  const Part& part = *base.part;
  if (!chain_digit_) return point_of(part, 0, base.other, base.sample);
  const Span here = span(part, base.piece);
  const std::uint64_t length = here.end - here.begin, direction = place / length, step = place % length;
  const bool down = direction > 0 || section_.warm_start->direction == Direction::down;
  const std::uint64_t value = down ? here.end - 1 - step : here.begin + step;
  const std::uint64_t size = part.digits[*chain_digit_].size;
  const std::uint64_t combination = (base.other / part.stride * size + value) * part.stride + base.other % part.stride;
  return point_of(part, direction, combination, base.sample);
}

UnitPlace StudyLayout::place_of(std::uint64_t point) const {
  const Part& part = part_of_point(point);
  const std::uint64_t sample = (point - part.first_point) % samples_, rest = (point - part.first_point) / samples_;
  const std::uint64_t combination = rest % part.combinations, direction = rest / part.combinations;
  if (!chain_digit_) return {unit_of(part.first_base + combination, sample), 0};
  const std::uint64_t size = part.digits[*chain_digit_].size, value = combination / part.stride % size;
  const std::uint64_t other = combination / (part.stride * size) * part.stride + combination % part.stride;
  std::uint64_t piece = value * pieces(part) / size;
  while (span(part, piece).begin > value) --piece;
  while (span(part, piece).end <= value) ++piece;
  const Span here = span(part, piece);
  const bool down = direction > 0 || section_.warm_start->direction == Direction::down;
  const std::uint64_t step = down ? here.end - 1 - value : value - here.begin;
  return {unit_of(part.first_base + other * pieces(part) + piece, sample), direction * (here.end - here.begin) + step};
}

}  // namespace freeplay
