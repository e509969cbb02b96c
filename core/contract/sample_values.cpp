#include "contract/sample_values.h"

#include <algorithm>
#include <cmath>

namespace freeplay {
namespace {

struct SampleFunction {
  double size;
};
Status evaluate_sample(const void* self, double t, TimeValue* out, Message*) noexcept {
  const double c = static_cast<const SampleFunction*>(self)->size;
  *out = {c * (1.0 + 0.5 * std::sin(2.0 * t)), c * std::cos(2.0 * t), -2.0 * c * std::sin(2.0 * t)};
  return Status::ok;
}

constexpr abi::FormulaTable sample_formula{
    sizeof(abi::FormulaTable),
    [](const void* self, Span<const double> variables, double* value, Span<double> slopes, Message*) noexcept {
      const double c = static_cast<const SampleFunction*>(self)->size;
      for (std::size_t i = 0; i < slopes.size; ++i) slopes[i] = i == 0 ? c : 0.0;
      *value = c * variables[0];
      return Status::ok;
    },
    [](const void*) noexcept { return std::int32_t{0}; },
    [](const void*, Span<const double>, Span<double>) noexcept {}};

constexpr abi::FormulaTable closed_sample{
    sizeof(abi::FormulaTable),
    [](const void* self, Span<const double> variables, double* value, Span<double> slopes, Message*) noexcept {
      const double c = static_cast<const SampleFunction*>(self)->size;
      for (std::size_t i = 0; i < slopes.size; ++i) slopes[i] = i == 0 ? -0.2 * c * std::sin(variables[0]) : 0.0;
      *value = c * (1.0 + 0.2 * std::cos(variables[0]));
      return Status::ok;
    },
    [](const void*) noexcept { return std::int32_t{0}; },
    [](const void*, Span<const double>, Span<double>) noexcept {}};

void set_formula(const abi::FormulaTable& table, double size, ParameterValue& value) {
  const auto function = std::make_shared<const SampleFunction>(SampleFunction{size});
  value.formula = Formula(table, function.get());
  value.function_owner = function;
}

}  // namespace

double usual_size(const Dimension& d) {
  const struct {
    Dimension dimension;
    double size;
  } table[] = {{dimension::length, 0.01}, {dimension::pressure, 2e11}, {dimension::velocity, 0.01},
               {dimension::time, 0.01},   {dimension::stiffness, 1e5}, {dimension::damping, 10.0},
               {dimension::force, 10.0},  {dimension::torque, 1.0},    {dimension::none, 0.3},
               {{0.0, -1.0, 0.0}, 1e5}};  // 1/m: a surface that yields by 10 micrometres
  for (const auto& row : table) {
    if (row.dimension == d) return row.size;
  }
  // Contact stiffness N/m^n: what carries 100 N at 10 micrometres.
  if (d.kg == 1.0 && d.s == -2.0 && d.m <= 0.5) return 100.0 * std::pow(1e5, 1.0 - d.m);
  return 1.0;
}

double within(const Parameter& p, double factor, double wish) {
  const double low = p.minimum * factor, high = p.maximum * factor;
  const auto opens = [&](Open end) { return p.open == end || p.open == Open::both; };
  if (std::isfinite(low) && std::isfinite(high)) {
    const double margin = 0.1 * (high - low);
    if (wish <= low) return opens(Open::minimum) ? low + margin : low;
    if (wish >= high) return opens(Open::maximum) ? high - margin : high;
    return wish;
  }
  if (wish < low || (wish == low && opens(Open::minimum))) return low + std::max(std::abs(low), 1.0);
  if (wish > high || (wish == high && opens(Open::maximum))) return high - std::max(std::abs(high), 1.0);
  return wish;
}

void set_sample_function(double size, ParameterValue& value) {
  const auto function = std::make_shared<const SampleFunction>(SampleFunction{size});
  value.function = {&evaluate_sample, function.get()};
  value.function_owner = function;
}

void set_sample_formula(double slope, ParameterValue& value) { set_formula(sample_formula, slope, value); }

void set_closed_sample(double size, ParameterValue& value) { set_formula(closed_sample, size, value); }

std::shared_ptr<const ParameterPoints> sample_points(const Parameter& p, double factor, double size, double x_size,
                                                     SampleOrder order, std::size_t length) {
  auto points = std::make_shared<ParameterPoints>();
  const double middle = 0.5 * (static_cast<double>(length) - 1.0);
  const double first = order == SampleOrder::rising ? 0.0 : order == SampleOrder::falling ? 1.0 : -middle;
  const double slope = order == SampleOrder::rising ? 0.1 : order == SampleOrder::falling ? -0.02 : 0.0;
  for (std::size_t i = 0; i < length; ++i) {
    const auto k = static_cast<double>(i);
    points->y.push_back(within(p, factor, size * (1.0 + slope * k)));
    if (p.kind == ParameterKind::table) points->x.push_back(x_size * (first + k));
  }
  return points;
}

}  // namespace freeplay
