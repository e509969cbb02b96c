#include "urdf/element.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/suggestion.h"
#include "base/text.h"
#include "urdf/blanks.h"

namespace freeplay::urdf {
namespace {

bool holds(const std::vector<std::string>& words, const std::string& word) {
  return std::ranges::find(words, word) != words.end();
}

std::string lower(std::string word) {
  for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return word;
}

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t begin = text.find_first_not_of(blanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(blanks, end);
  }
  return words;
}

/// Letters added, lost or replaced, or neighbours that changed places; anything above `limit` where it is larger.
std::size_t slips(std::string_view a, std::string_view b, std::size_t limit) {
  constexpr std::size_t longest = 32;
  const std::size_t more = std::max(a.size(), b.size()) - std::min(a.size(), b.size());
  if (more > limit || a.size() >= longest || b.size() >= longest) return limit + 1;
  std::array<std::array<std::size_t, longest>, longest> cost{};
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        cost[i][j] = i + j;
        continue;
      }
      const bool same = a[i - 1] == b[j - 1];
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, cost[i - 1][j - 1] + (same ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  }
  return cost[a.size()][b.size()];
}

bool differs_by_a_replaced_letter(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) different += a[i] == b[i] ? 0 : 1;
  return different == 1;
}

}  // namespace

std::string misspelt(const std::string& word, const std::vector<std::string>& words) {
  constexpr std::size_t short_word = 6;
  for (const std::string& candidate : words) {
    const bool is_short = candidate.size() < short_word;
    // 'line' and 'point' are one letter from 'link' and 'joint', and words of their own.
    if (is_short && differs_by_a_replaced_letter(word, candidate) && lower(word) != candidate) continue;
    const std::size_t limit = is_short ? 1 : 2;
    if (lower(word) == candidate || slips(word, candidate, limit) <= limit) return candidate;
  }
  return {};
}

Spot spot_of(const XmlElement& element, const XmlAttribute& attribute) {
  const TextPlace* place = place_of(element, attribute);
  return place == nullptr ? name_spot(element) : Spot{place->line, place->column, character_count(attribute.Name())};
}

Spot spot_of(const XmlElement& element, const char* attribute) {
  const XmlAttribute* found = element.FindAttribute(attribute);
  return found == nullptr ? name_spot(element) : spot_of(element, *found);
}

Spot text_spot(const XmlElement& element) {
  const TextPlace place = places_of(element).text;
  return {place.line, place.column, 1};
}

Spot name_spot(const XmlElement& element) {
  const TextPlace place = places_of(element).name;
  return {place.line, place.column, character_count(element.Name())};
}

Spot begin_spot(const XmlElement& element) {
  const TextPlace place = places_of(element).begin;
  return {place.line, place.column, character_count(element.Name()) + 1};
}

std::string Messages::id_of(std::string id) const {
  constexpr std::string_view own = "urdf";
  const std::size_t at = id.find(own);
  return at == std::string::npos ? id : id.replace(at, own.size(), format_);
}

void Messages::error(const Spot& spot, const char* id, std::string message, std::string suggestion, std::string hint) {
  ++errors_;
  diagnostics_.error({file_, spot.line, spot.column}, spot.length, id_of(id), std::move(message), std::move(suggestion),
                     std::move(hint));
}

void Messages::warning(const Spot& spot, const char* id, std::string message, std::string hint) {
  diagnostics_.warning({file_, spot.line, spot.column}, spot.length, id_of(id), std::move(message), {},
                       std::move(hint));
}

void Messages::ignore(const std::string& what, const std::string& name) {
  const auto [entry, fresh] = ignored_index_.emplace(what, ignored_.size());
  if (fresh) ignored_.push_back({what, {}});
  ignored_[entry->second].second.push_back(name);
}

std::string Messages::suggest(const std::string& word, const std::vector<std::string>& words) {
  constexpr std::size_t too_many = 5000;
  if (words.size() > too_many || ++suggested_ > 100) return {};
  return suggestion(word, words).value_or("");
}

void Messages::report_ignored(const Spot& spot) {
  if (ignored_.empty()) return;
  constexpr std::size_t most = 8, most_kinds = 40;
  std::string list;
  for (std::size_t kind = 0; kind < std::min(ignored_.size(), most_kinds); ++kind) {
    const auto& [what, names] = ignored_[kind];
    list += fmt::format("{}{}", list.empty() ? "" : ", ", what);
    if (names.front().empty()) {
      if (names.size() > 1) list += fmt::format(" ({})", names.size());
      continue;
    }
    for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
      list += (i == 0 ? " " : ", ") + ("'" + names[i] + "'");
    if (names.size() > most) list += fmt::format(" and {} more", names.size() - most);
  }
  if (ignored_.size() > most_kinds) list += fmt::format(" and {} more", ignored_.size() - most_kinds);
  warning(spot, "urdf-ignored", "not used: " + list);
}

std::optional<double> read_number(std::string_view text, std::string& why, std::string& hint) {
  const std::string shown = printable(text);
  why = fmt::format("'{}' is not a number", shown);
  hint.clear();
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0.0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = !digits.empty() && stop == digits.data() + digits.size() && !digits.starts_with('+');
  if (whole && error == std::errc::result_out_of_range) {
    why = fmt::format("'{}' is outside of the range of a double", shown);
    return std::nullopt;
  }
  if (whole && error == std::errc() && std::isfinite(value)) return value;
  if (whole && error == std::errc()) why = fmt::format("'{}' is not a finite number", shown);
  if (text.find(',') != std::string_view::npos) hint = "the decimal sign is a point; numbers are separated by blanks";
  if (text.find("${") != std::string_view::npos) hint = "this is a xacro file; expand it first";
  return std::nullopt;
}

Element::Element(XmlElement& xml, std::string owner, Messages& messages, bool exact)
    : xml_(xml), owner_(std::move(owner)), messages_(messages), exact_(exact) {}

const XmlAttribute* Element::find(const std::string& name) {
  if (!holds(attributes_, name)) attributes_.push_back(name);
  return xml_.FindAttribute(name.c_str());
}

const XmlAttribute* Element::require(const std::string& name) {
  const XmlAttribute* attribute = find(name);
  if (attribute == nullptr) {
    messages_.error(name_spot(), "bad-urdf", fmt::format("the attribute '{}' of {} is missing", name, owner_));
  }
  return attribute;
}

std::optional<double> Element::parse(const XmlAttribute& attribute) {
  const std::vector<std::string_view> words = split(attribute.Value());
  std::string why = fmt::format("'{}' is not a number", printable(attribute.Value())), hint;
  const auto value = words.size() == 1 ? read_number(words[0], why, hint) : std::nullopt;
  if (!value) {
    messages_.error(spot_of(xml_, attribute), "bad-urdf", fmt::format("'{}' of {}: {}", attribute.Name(), owner_, why),
                    {}, hint);
  }
  return value;
}

double Element::number(const std::string& name, double standard) {
  const XmlAttribute* attribute = find(name);
  if (attribute == nullptr) return standard;
  const auto value = parse(*attribute);
  if (!value) guesses_.emplace_back(name, fmt::format("{}", standard));
  return value.value_or(standard);
}

std::optional<double> Element::required_number(const std::string& name, const char* guess) {
  const XmlAttribute* attribute = require(name);
  const auto value = attribute == nullptr ? std::nullopt : parse(*attribute);
  if (!value) guesses_.emplace_back(name, guess);
  return value;
}

std::optional<Eigen::Vector3d> Element::vector(const std::string& name, const char* guess) {
  const std::vector<double> read = numbers(name, 3, guess);
  return read.empty() ? std::nullopt : std::optional(Eigen::Vector3d(read[0], read[1], read[2]));
}

std::vector<double> Element::numbers(const std::string& name, std::size_t count, const char* guess) {
  return numbers(name, count, count, guess);
}

std::vector<double> Element::numbers(const std::string& name, std::size_t least, std::size_t most, const char* guess) {
  constexpr const char* few[] = {"no", "one", "two", "three", "four", "five", "six", "seven"};
  const XmlAttribute* attribute = find(name);
  if (attribute == nullptr) return {};
  const std::string_view value = attribute->Value();
  const std::vector<std::string_view> words = split(value);
  std::vector<double> read;
  if (words.size() < least || words.size() > most) {
    const bool comma = value.find(',') != std::string_view::npos;
    const std::string wanted = least == most ? few[most] : fmt::format("{} to {}", few[least], few[most]);
    messages_.error(spot_of(xml_, *attribute), "bad-urdf",
                    fmt::format("'{}' of {} must be {} numbers, not {}", name, owner_, wanted, words.size()), {},
                    comma ? "numbers are separated by blanks, not by commas" : "");
  } else {
    read = parse_all(*attribute, words);
  }
  if (read.empty()) guesses_.emplace_back(name, guess);
  return read;
}

/// Empty after a message.
std::vector<double> Element::parse_all(const XmlAttribute& attribute, const std::vector<std::string_view>& words) {
  std::vector<double> read;
  for (const std::string_view word : words) {
    std::string why, hint;
    const auto number = read_number(word, why, hint);
    if (!number) {
      messages_.error(spot_of(xml_, attribute), "bad-urdf",
                      fmt::format("'{}' of {}: {}", attribute.Name(), owner_, why), {}, hint);
      return {};
    }
    read.push_back(*number);
  }
  return read;
}

XmlElement* Element::child(const std::string& name) {
  if (!holds(children_, name)) children_.push_back(name);
  XmlElement* first = nullptr;
  for (XmlElement& child : XmlChildren(xml_)) {
    if (child.Name() != name) continue;
    if (first != nullptr) {
      messages_.error(urdf::name_spot(child), "bad-urdf",
                      fmt::format("the element '{}' is given twice in {}; first on line {}", name, owner_,
                                  places_of(*first).begin.line));
      break;
    }
    first = &child;
  }
  return first;
}

XmlElement* Element::required_child(const std::string& name) {
  XmlElement* found = child(name);
  if (found == nullptr) {
    messages_.error(begin_spot(), "bad-urdf", fmt::format("the element '{}' of {} is missing", name, owner_));
  }
  return found;
}

void Element::pass_over(const std::string& name) { passed_.push_back(name); }

void Element::finish(bool text_allowed) {
  finish_attributes();
  finish_children();
  if (!text_allowed && !text_of(xml_).empty()) {
    messages_.error(text_spot(xml_), "bad-urdf", fmt::format("unexpected text in {}", owner_));
  }
  for (const auto& [name, value] : guesses_) xml_.SetAttribute(name.c_str(), value.c_str());
}

void Element::finish_attributes() {
  std::vector<std::string> unwritten;
  for (const std::string& name : attributes_) {
    if (xml_.FindAttribute(name.c_str()) == nullptr) unwritten.push_back(name);
  }
  for (const XmlAttribute* attribute = xml_.FirstAttribute(); attribute != nullptr; attribute = attribute->Next()) {
    const std::string name = attribute->Name();
    if (holds(attributes_, name) || name.starts_with("xmlns")) continue;
    const std::string meant = messages_.suggest(name, unwritten);
    if (!exact_ && meant.empty()) {
      messages_.ignore(fmt::format("attribute '{}' of '{}'", name, xml_.Name()));
      continue;
    }
    messages_.error(spot_of(xml_, *attribute), "bad-urdf", fmt::format("unknown attribute '{}' of {}", name, owner_),
                    meant);
  }
}

void Element::finish_children() {
  std::vector<std::string> unwritten = repeated_;
  for (const std::string& name : children_) {
    if (xml_.FirstChildElement(name.c_str()) == nullptr) unwritten.push_back(name);
  }
  for (const XmlElement& child : XmlChildren(xml_)) {
    const std::string name = child.Name();
    if (holds(children_, name) || holds(repeated_, name)) continue;
    if (holds(passed_, name)) {
      messages_.ignore(name);
      continue;
    }
    if (name.starts_with("xacro:")) {
      messages_.error(urdf::name_spot(child), "bad-urdf", fmt::format("'{}' is not expanded", name), {},
                      "this is a xacro file; expand it first");
      continue;
    }
    const std::string meant = exact_ ? messages_.suggest(name, unwritten) : misspelt(name, unwritten);
    if (!exact_ && meant.empty()) {
      messages_.ignore(fmt::format("element '{}'", name));
      continue;
    }
    messages_.error(urdf::name_spot(child), "bad-urdf", fmt::format("unknown element '{}' in {}", name, owner_), meant);
  }
}

Eigen::Matrix3d rotation(const Eigen::Vector3d& rpy) {
  // Written out: a detour over quaternions would cost the last digits of a plain turn.
  const double cr = std::cos(rpy[0]), sr = std::sin(rpy[0]), cp = std::cos(rpy[1]), sp = std::sin(rpy[1]),
               cy = std::cos(rpy[2]), sy = std::sin(rpy[2]);
  Eigen::Matrix3d r;
  r << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,   //
      -sp, cp * sr, cp * cr;
  return r;
}

bool looks_like_degrees(double limit) {
  constexpr double turn = 2.0 * std::numbers::pi, no_limit = 1000.0;
  const double size = std::abs(limit);
  if (size < 10.0 || size >= no_limit) return false;
  if (std::remainder(size, 5.0) == 0.0) return true;
  return size > 3.0 * turn && std::abs(std::remainder(size, turn / 36.0)) > 5e-3;
}

void Element::doubt_turns(const Eigen::Vector3d& rpy) {
  constexpr double pi = std::numbers::pi;
  for (const double angle : rpy) {
    if (std::abs(angle) <= 2.0 * pi + 1e-3 || std::abs(std::remainder(angle, pi / 2.0)) < 1e-3) continue;
    messages_.warning(name_spot(), "doubtful-angle",
                      fmt::format("'rpy' of {} is {:.6g} rad, {:.3g} turns: robot files are in radians, not in degrees",
                                  owner_, angle, std::abs(angle) / (2.0 * pi)));
    return;
  }
}

Eigen::Isometry3d read_pose(Element& element) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = element.vector("xyz").value_or(Eigen::Vector3d::Zero());
  const auto rpy = element.vector("rpy");
  if (rpy && !rpy->isZero(0.0)) pose.linear() = rotation(*rpy);
  if (rpy) element.doubt_turns(*rpy);
  return pose;
}

Eigen::Isometry3d read_origin(Element& element, Messages& messages, Spot* spot) {
  XmlElement* xml = element.child("origin");
  if (xml == nullptr) return Eigen::Isometry3d::Identity();
  Element origin(*xml, "the origin of " + element.owner(), messages, true);
  const Eigen::Isometry3d pose = read_pose(origin);
  origin.finish();
  if (spot != nullptr) *spot = origin.name_spot();
  return pose;
}

}  // namespace freeplay::urdf
