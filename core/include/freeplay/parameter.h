// Parameters: what may be given to a component in the model file, and how its constructor reads it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>

#include "freeplay/span.h"

namespace freeplay {

/// Outcome of every call that crosses the plugin boundary. Exceptions never do.
enum class Status : std::int32_t { ok = 0, failed = 1, bad_parameter = 2 };

/// Text of a failure, owned by the caller so that reporting never allocates.
struct Message {
  char text[384];
  char path[96];  ///< bad_parameter: which parameter, as in the component's table; "" is the whole component
  char id[32];    ///< bad_parameter: message id of the model format, such as "missing-key"
  Message() { text[0] = path[0] = id[0] = '\0'; }
};

/// Marks a number that the model file must give.
inline constexpr double required = std::numeric_limits<double>::quiet_NaN();
/// Marks a number that may be absent, see Parameters::given().
inline constexpr double optional = -std::numeric_limits<double>::infinity();
inline constexpr double unbounded = std::numeric_limits<double>::infinity();

enum class ParameterKind : std::uint32_t {
  number,
  integer,
  choice,
  vector,
  function,
  contact_law,
  friction_law,
  formula,
  list,  ///< numbers of one unit
  table  ///< points (x, y) of rising x
};

/// Which ends of a parameter's range do not belong to it.
enum class Open : std::uint32_t { none = 0, minimum = 1, maximum = 2, both = 3 };

/// One entry of a component's parameter table. The same table drives validation, `freeplay describe`,
/// the reference manual and the JSON Schema. `name` may be a path: "clearance.material.E" is key `E` in the
/// map `material` in the map `clearance`; a path that is both a choice and the start of others accepts a word or
/// a map. `unit` is a unit of the model format; "1" is dimensionless; an exponent may name another number of
/// the table: "N/m^exponent"; "kind: N/m | N*m/rad" has a unit for each word of the choice `kind`. A default of
/// `required` or `optional` applies to every kind; for a choice any other default is the index of the word; for a
/// law, `preferred` of that kind is used when it is absent and not required. Default and bounds are in `unit`; those
/// of a vector or a list hold for each of its numbers, those of a table for each y. A list or a table is `required` or
/// `optional`.
struct Parameter {
  const char* name;
  ParameterKind kind = ParameterKind::number;
  const char* unit = "1";
  double default_value = required;
  double minimum = -unbounded;
  double maximum = unbounded;
  Open open = Open::none;
  const char* choices = nullptr;  ///< words separated by '|'; of a number: words accepted in its place
  const char* summary = "";       ///< one sentence for the manual
  // Appended.
  /// Of a formula: its variables and their units, "delta: m; rate: m/s", at most Formula::most_variables. Of a table:
  /// its x and the unit of that, "speed: m/s". Of a number or a function "motion": of a force element it may depend on
  /// time and on channels of the motion, and then stands in JointInput::functions; what the constructor reads is NaN.
  const char* variables = nullptr;
  /// How many numbers a list or points a table may have.
  std::uint32_t least = 1, most = 1000;
};

/// Points of a table, SI: x rises, y has as many numbers. Empty: it is optional and was not given.
struct TablePoints {
  Span<const double> x, y;
};

/// A function of time and its exact first and second derivative.
struct TimeValue {
  double value, rate, acceleration;
};

/// A function of time written in the model file as an expression; the host evaluates it.
struct TimeFunction {
  Status (*evaluate)(const void* self, double t, TimeValue*, Message*) noexcept = nullptr;
  const void* self = nullptr;
  TimeValue at(double t) const;
};

namespace abi {
/// How the host serves a formula; functions are only ever appended.
struct FormulaTable {
  std::uint32_t size;
  Status (*evaluate)(const void* self, Span<const double> variables, double* value, Span<double> slopes,
                     Message*) noexcept;
  std::int32_t (*switches)(const void* self) noexcept;
  void (*decide)(const void* self, Span<const double> variables, Span<double> values) noexcept;
  /// Null, or not there in older hosts: no integral is known. False: of this one none is.
  bool (*integral)(const void* self, double from, double to, double* value) noexcept = nullptr;
};
}  // namespace abi

/// A formula that the model file gives for a parameter, in the variables that the parameter's row names; SI. The host
/// evaluates it: nothing allocates, and several threads may. Lives as long as the component.
class Formula {
 public:
  static constexpr std::size_t most_variables = 4;

  Formula() = default;
  Formula(const abi::FormulaTable& table, const void* self) : table_(&table), self_(self) {}
  /// False: it is optional and was not given.
  explicit operator bool() const { return table_ != nullptr; }

  /// Its value, and in `slopes`, which may be empty, its exact partial derivatives by the first variables; beside a
  /// kink those of the side where the variables are. Throws where the formula has no value; a component that lets that
  /// pass shows the place in the model file.
  double at(Span<const double> variables, Span<double> slopes = {}) const;
  /// How many abs, sign, min, max and if of variables there are. What decides one, its `decide` number, passes zero
  /// where the formula changes its form; NaN where it has none.
  std::int32_t switches() const { return table_->switches(self_); }
  void decide(Span<const double> variables, Span<double> values) const { table_->decide(self_, variables, values); }
  /// Of one variable: its exact integral, where the host knows one, as of points that repeat for ever.
  bool integral(double from, double to, double& value) const {
    const bool has = table_->size > offsetof(abi::FormulaTable, integral) && table_->integral != nullptr;
    return has && table_->integral(self_, from, to, &value);
  }

 private:
  const abi::FormulaTable* table_ = nullptr;
  const void* self_ = nullptr;
};

struct ContactPair;
class ContactLawRef;
class FrictionLawRef;

/// Thrown by a constructor that finds a fault across parameters: two radii that disagree, a missing material.
/// The host turns it into a located input error. `path` is the parameter as named in the table (or a block of
/// it, or "" for the component itself), `id` a message id of the model format ("conflicting-keys", "missing-key").
class BadParameter : public std::exception {
 public:
  BadParameter(const char* path, const char* id, std::string text) : path_(path), id_(id), text_(std::move(text)) {}
  /// Number `index`, from 0, of a list, or that point of a table.
  BadParameter(const char* path, std::size_t index, const char* id, std::string text)
      : BadParameter(path, id, std::move(text)) {
    of_item_ = std::string(path) + "." + std::to_string(index);
  }
  const char* what() const noexcept override { return text_.c_str(); }
  const char* path() const { return of_item_.empty() ? path_ : of_item_.c_str(); }
  const char* id() const { return id_; }

 private:
  std::string of_item_;
  const char* path_;
  const char* id_;
  std::string text_;
};

namespace abi {

/// Served by the host while a component is being created; never used later.
struct ParameterTable {
  std::uint32_t size;
  const void* self;
  Status (*number)(const void* self, const char* name, double* value, Message*) noexcept;
  Status (*vector)(const void* self, const char* name, double* xyz, Message*) noexcept;
  Status (*word)(const void* self, const char* name, std::int32_t* index, Message*) noexcept;
  Status (*given)(const void* self, const char* name, std::int32_t* yes, Message*) noexcept;
  Status (*function)(const void* self, const char* name, TimeFunction*, Message*) noexcept;
  Status (*contact_law)(const void* self, const char* name, const ContactPair*, ContactLawRef*, Message*) noexcept;
  Status (*friction_law)(const void* self, const char* name, FrictionLawRef*, Message*) noexcept;
  // Appended.
  Status (*formula)(const void* self, const char* name, Formula*, Message*) noexcept;
  /// Of a list: its numbers in `y`, and nothing in `x`.
  Status (*points)(const void* self, const char* name, TablePoints*, Message*) noexcept;
};

inline void copy_text(char* to, std::size_t capacity, const char* from) noexcept {
  std::size_t i = 0;
  for (; from[i] != '\0' && i + 1 < capacity; ++i) to[i] = from[i];
  to[i] = '\0';
}

[[noreturn, gnu::cold, gnu::noinline]] inline void throw_failure(Status status, const Message& message) {
  if (status != Status::bad_parameter) throw std::runtime_error(message.text);
  // The message dies with this frame, so its words move to storage that lives as long as the exception is handled.
  static thread_local Message kept;
  kept = message;
  throw BadParameter(kept.path, kept.id, kept.text);
}
/// Turns a failed call back into an exception on the author's side of the boundary.
inline void require(Status status, const Message& message) {
  if (status != Status::ok) throw_failure(status, message);
}

/// Runs `body` and turns whatever it throws into a Status and a Message.
template <class Body>
Status guarded(Message* message, Body&& body) noexcept {
  try {
    body();
    return Status::ok;
  } catch (const BadParameter& e) {
    copy_text(message->text, sizeof message->text, e.what());
    copy_text(message->path, sizeof message->path, e.path());
    copy_text(message->id, sizeof message->id, e.id());
    return Status::bad_parameter;
  } catch (const std::exception& e) {
    copy_text(message->text, sizeof message->text, e.what());
  } catch (...) {
    copy_text(message->text, sizeof message->text, "unknown exception");
  }
  return Status::failed;
}

}  // namespace abi

inline TimeValue TimeFunction::at(double t) const {
  TimeValue value{};
  Message message;
  abi::require(evaluate(self, t, &value, &message), message);
  return value;
}

inline double Formula::at(Span<const double> variables, Span<double> slopes) const {
  double value = 0.0;
  Message message;
  abi::require(table_->evaluate(self_, variables, &value, slopes, &message), message);
  return value;
}

/// Checked values of one component's parameters, in SI units, handed to its constructor.
/// Asking for a name that is not in the component's table throws.
class Parameters {
 public:
  explicit Parameters(const abi::ParameterTable& table) : table_(&table) {}

  /// Value of a number or integer; NaN when it is optional and absent, or when a word was written in its place.
  double number(const char* name) const { return read<double>(table_->number, name); }
  int integer(const char* name) const { return static_cast<int>(number(name)); }
  /// Was it written in the model file?
  bool given(const char* name) const { return read<std::int32_t>(table_->given, name) != 0; }
  /// Components beyond the model's dimension are zero; zero when optional and absent.
  std::array<double, 3> vector(const char* name) const {
    std::array<double, 3> xyz{};
    Message message;
    abi::require(table_->vector(table_->self, name, xyz.data(), &message), message);
    return xyz;
  }
  /// Index of the word among the parameter's `choices`; -1 when something else was written.
  int word(const char* name) const { return static_cast<int>(read<std::int32_t>(table_->word, name)); }

  TimeFunction function(const char* name) const { return read<TimeFunction>(table_->function, name); }
  Formula formula(const char* name) const { return read<Formula>(table_->formula, name); }
  /// Numbers of a list and points of a table. The host keeps them as long as the component lives: nothing is copied.
  Span<const double> list(const char* name) const { return read<TablePoints>(table_->points, name).y; }
  TablePoints table(const char* name) const { return read<TablePoints>(table_->points, name); }

  /// Creates the law named in the sub-block `name`; the model owns it and outlives the caller.
  ContactLawRef contact_law(const char* name, const ContactPair& pair) const;
  FrictionLawRef friction_law(const char* name) const;

 private:
  template <class T, class Read>
  T read(Read read_value, const char* name) const {
    T value{};
    Message message;
    abi::require(read_value(table_->self, name, &value, &message), message);
    return value;
  }
  const abi::ParameterTable* table_;
};

}  // namespace freeplay
