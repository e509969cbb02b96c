#include "format/doubtful_threshold.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "format/doubtful_body.h"
#include "format/doubtful_number.h"
#include "model/whole_mass.h"

namespace freeplay {
namespace {

constexpr std::size_t most_entries = 2000;  // that are looked at

/// Functions that compare what stands between their commas.
constexpr std::string_view comparing[] = {"smooth", "min", "max"};
/// Functions whose factor is how far they go.
constexpr std::string_view swinging[] = {"sin", "cos", "smooth", "trapezoid", "s_curve"};

std::string_view stripped(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" -+");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

/// Inside of the brackets of `text` if it is nothing but these and a function with one argument before them.
std::string_view without_brackets(std::string_view text) {
  if (text.starts_with("abs(") && text.ends_with(')')) return stripped(text.substr(4, text.size() - 5));
  return text.starts_with('(') && text.ends_with(')') ? stripped(text.substr(1, text.size() - 2)) : text;
}

/// One number without a unit; NaN for all else.
double bare_number(std::string_view text) {
  const std::string_view digits = stripped(text);
  double number = NAN;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const bool whole = error == std::errc() && end == digits.data() + digits.size();
  return whole && std::isfinite(number) ? number : NAN;
}

enum class Kind { other, angle, place };
Kind kind_of(std::string_view text) {
  const std::string_view name = without_brackets(stripped(text));
  if (name.empty() || name.find_first_of(" ()*^,<>") != std::string_view::npos) return Kind::other;
  for (const char* const of : {"joint.", "body.", "frame."}) {
    if (!name.starts_with(of)) continue;
    const std::string_view last = name.substr(name.rfind('.') + 1);
    if (last == "angle") return Kind::angle;
    if (last == "x" || last == "y" || last == "z" || last == "position") return Kind::place;
  }
  return Kind::other;
}

/// A minus within a name is none.
bool divides_terms(std::string_view text, std::size_t i) {
  const auto is_word = [&](std::size_t k) {
    return k < text.size() && (std::isalpha(static_cast<unsigned char>(text[k])) || text[k] == '_');
  };
  if (text[i] == '<' || text[i] == '>' || text[i] == '=') return true;
  if (text[i] != '-' && text[i] != '+') return false;
  const bool exponent = i > 1 && (text[i - 1] == 'e' || text[i - 1] == 'E') &&
                        (std::isdigit(static_cast<unsigned char>(text[i - 2])) || text[i - 2] == '.');
  return i > 0 && !exponent &&
         !(is_word(i + 1) && (is_word(i - 1) || std::isdigit(static_cast<unsigned char>(text[i - 1]))));
}

/// Calls `compare` with the terms that are compared or added, of each pair of brackets by itself.
using Compare = std::function<void(const std::vector<std::string_view>& terms)>;
void each_comparison(std::string_view text, bool commas_compare, const Compare& compare) {
  std::vector<std::string_view> terms;
  std::size_t begin = 0, open = 0;
  int depth = 0;
  const auto end_terms = [&] {
    if (terms.size() > 1) compare(terms);
    terms.clear();
  };
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const char c = i < text.size() ? text[i] : ',';
    if (c == '(' && depth++ == 0) open = i;
    if (c == ')' && depth > 0 && --depth == 0) {
      const std::string_view before = text.substr(0, open);
      const bool compares =
          std::ranges::any_of(comparing, [&](std::string_view name) { return before.ends_with(name); });
      each_comparison(text.substr(open + 1, i - open - 1), compares, compare);
    }
    if (depth > 0) continue;
    const bool comma = c == ',';
    if (!comma && !divides_terms(text, i)) continue;
    if (i > begin) terms.push_back(text.substr(begin, i - begin));
    begin = i + 1;
    if (comma && !commas_compare) end_terms();
  }
  end_terms();
}

bool is_beyond_a_turn(double number) {
  return number > bare_limit::angle * (1.0 + 1e-12) && 2.0 * number == std::round(2.0 * number);
}

/// The terms of a sum.
std::vector<std::string_view> terms_of(std::string_view text) {
  std::vector<std::string_view> terms;
  std::size_t begin = 0;
  int depth = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i < text.size()) depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
    if (i < text.size() && (depth > 0 || !divides_terms(text, i))) continue;
    if (i > begin) terms.push_back(text.substr(begin, i - begin));
    begin = i + 1;
  }
  return terms;
}

/// Of a number times a function, as in `20*smooth(t, 0, 1)`; NaN for all else.
double bare_factor(std::string_view term) {
  const std::size_t by = term.find('*'), open = term.find('(');
  if (by == std::string_view::npos || open == std::string_view::npos || open < by) return NAN;
  const std::string_view name = stripped(term.substr(by + 1, open - by - 1));
  return std::ranges::count(swinging, name) > 0 && stripped(term).ends_with(')') ? bare_number(term.substr(0, by))
                                                                                 : NAN;
}

class Thresholds {
 public:
  explicit Thresholds(const Draft& draft) : draft_(draft), size_(model_size(draft.model)) {}

  void judge(const char* section, const std::string& name) const {
    if (const auto entry = entry_of(draft_, section, name)) judge(*entry);
  }

 private:
  void judge(const CheckedValue& value) const {
    for (std::size_t k = 0; k < value.node().items.size(); ++k) judge(value.item(k));
    for (const Node::Entry& entry : value.node().entries)
      judge(CheckedValue(value.reading(), *entry.value, entry.key, value.path()));
    if (value.node().is_scalar() && value.node().text.find('.') != std::string::npos) judge_text(value);
  }

  void judge_text(const CheckedValue& written) const {
    bool said = false;
    each_comparison(written.node().text, false, [&](const std::vector<std::string_view>& terms) {
      for (const std::string_view channel : terms) {
        const Kind kind = kind_of(channel);
        for (const std::string_view other : terms) {
          const double number = bare_number(other);
          if (said || !is_out_of_reach(kind, number)) continue;
          said = true;
          warn(written, kind, std::string(without_brackets(stripped(channel))), number);
        }
      }
    });
  }

  bool is_out_of_reach(Kind kind, double number) const {
    if (!std::isfinite(number) || kind == Kind::other) return false;
    if (kind == Kind::place) return size_ > 0.0 && number > bare_limit::start * size_;
    return is_beyond_a_turn(number);
  }

  void warn(const CheckedValue& written, Kind kind, const std::string& channel, double number) const {
    if (kind == Kind::angle) {
      written.warn("doubtful-angle",
                   fmt::format("'{0}' compares '{1}' with {2:.6g} rad, {3:.3g} turns: write '{2:.6g} deg' if degrees "
                               "are meant, else '{2:.6g} rad'",
                               written.path(), channel, number, number / (2.0 * std::numbers::pi)));
    } else {
      written.warn("doubtful-length",
                   fmt::format("'{0}' compares '{1}' with {2:.6g} m in a mechanism of {3:.2g} m: write '{2:.6g} mm' if "
                               "millimetres are meant, else '{2:.6g} m'",
                               written.path(), channel, number, size_));
    }
  }

  const Draft& draft_;
  double size_;
};

}  // namespace

void doubt_thresholds(const Draft& draft) {
  const Thresholds thresholds(draft);
  const Model& model = draft.model;
  for (std::size_t i = 0; i < std::min(model.forces.size(), most_entries); ++i)
    thresholds.judge("forces", model.forces[i].name);
  for (std::size_t i = 0; i < std::min(model.joints.size(), most_entries); ++i) {
    thresholds.judge("joints", model.joints[i].name);
    thresholds.judge("forces", model.joints[i].name);
  }
  for (std::size_t i = 0; i < std::min(model.drivers.size(), most_entries); ++i)
    thresholds.judge("drivers", model.drivers[i].name);
}

bool doubt_bare_term(const CheckedValue& written) {
  if (!written.node().is_scalar()) return false;
  const std::vector<std::string_view> terms = terms_of(written.node().text);
  const bool united = names_a_unit(written);
  for (const std::string_view term : terms) {
    const double factor = bare_factor(term), number = united ? bare_number(term) : NAN;
    const double found = is_beyond_a_turn(factor) ? factor : number;
    if (!is_beyond_a_turn(found)) continue;
    written.warn("doubtful-angle", fmt::format("'{0}' has a term of {1:.6g} rad, {2:.3g} turns: write '{1:.6g} deg' if "
                                               "degrees are meant, else '{1:.6g} rad'",
                                               written.path(), found, found / (2.0 * std::numbers::pi)));
    return true;
  }
  return false;
}

void doubt_bare_place(const CheckedValue& written, double scale) {
  if (!written.node().is_scalar() || !(scale > 0.0)) return;
  for (const std::string_view term : terms_of(written.node().text)) {
    const double factor = bare_factor(term), number = std::isfinite(factor) ? factor : bare_number(term);
    if (!(std::abs(number) > bare_limit::bearing * scale)) continue;
    written.warn(
        "doubtful-length",
        fmt::format("'{0}' has a term of {1:.6g} m where the lengths of the mechanism are about {2:.3g} m: write "
                    "'{1:.6g} mm' if millimetres are meant, else '{1:.6g} m'",
                    written.path(), number, scale));
    return;
  }
}

double bare_swing(std::string_view sum) {
  for (const std::string_view term : terms_of(sum)) {
    if (const double factor = bare_factor(term); std::isfinite(factor)) return factor;
  }
  return NAN;
}

}  // namespace freeplay
