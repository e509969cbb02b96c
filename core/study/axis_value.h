// AxisValue: a value that a point sets, as a run takes it and as tables show it.
#pragma once

#include <optional>
#include <string>

#include "base/unit.h"
#include "format/document.h"

namespace freeplay {

struct AxisValue {
  std::string text;   ///< as `--set` takes it
  std::string shown;  ///< of a quantity the shortest decimal in SI, else as it is written; a hash is made of it

  /// Without a dimension the number alone.
  static AxisValue of(double number, const std::optional<Dimension>& dimension);
  /// A constant quantity, or whatever else `text` is.
  static AxisValue of(const std::string& text);
  static AxisValue of(const Node& node);

  /// For a table without quotes.
  std::string cell() const;
};

}  // namespace freeplay
