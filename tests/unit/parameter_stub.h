// A component without a host: its parameters come from a map, its laws from functions.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "freeplay/plugin.h"

namespace freeplay::test {

/// The row named `name` of a plugin's table.
inline const Component& component(PluginEntry entry, const std::string& name) {
  static const Host host{sizeof(Host), abi_version, abi_fingerprint, struct_sizes};
  Manifest manifest{};
  if (entry(&host, &manifest) != Status::ok) throw std::runtime_error("the plugin refuses the host");
  for (const Component& row : manifest.components)
    if (name == row.description.name) return row;
  throw std::runtime_error("no component " + name);
}

/// A contact law and a friction law made of functions.
struct FunctionContact final : ContactLaw {
  explicit FunctionContact(std::function<ContactForce(const ContactState&)> f) : function(std::move(f)) {}
  ContactForce evaluate(const ContactState& s) const override { return function(s); }
  std::function<ContactForce(const ContactState&)> function;
};
struct FunctionFriction final : FrictionLaw {
  using Function = std::function<FrictionForce(const FrictionState&, Span<double>)>;
  explicit FunctionFriction(Function f, int count = 0) : function(std::move(f)), internal(count) {}
  int internal_variables() const override { return internal; }
  FrictionForce evaluate(const FrictionState& s, Span<double> rate) const override { return function(s, rate); }
  Function function;
  int internal;
};

/// What a model file would say of one component. Defaults come from the component's own table.
class ParameterStub {
 public:
  explicit ParameterStub(const Component& row) : row_(&row) {}

  std::map<std::string, double> numbers;
  std::map<std::string, std::vector<double>> vectors;
  std::map<std::string, Formula> formulas;
  std::map<std::string, int> words;       ///< index of the word; -1: something else was written
  std::shared_ptr<ContactLaw> contact;    ///< FunctionContact
  std::shared_ptr<FrictionLaw> friction;  ///< FunctionFriction; absent: no force
  mutable ContactPair pair{};             ///< what the joint handed to its contact law

  abi::ParameterTable table() const {
    return {sizeof(abi::ParameterTable),
            this,
            number,
            vector,
            word,
            given,
            function,
            contact_law,
            friction_law,
            formula,
            points};
  }

 private:
  static const ParameterStub& self(const void* s) { return *static_cast<const ParameterStub*>(s); }
  const Parameter& find(const std::string& name) const {
    for (const Parameter& p : row_->description.parameters)
      if (name == p.name) return p;
    throw std::runtime_error("no parameter " + name);
  }

  static Status number(const void* s, const char* name, double* value, Message* m) noexcept {
    return abi::guarded(m, [&] {
      const Parameter& p = self(s).find(name);
      const auto found = self(s).numbers.find(name);
      const bool word_written = self(s).words.count(name) > 0;
      if (found == self(s).numbers.end() && std::isnan(p.default_value) && !word_written)
        throw std::runtime_error(std::string("missing ") + name);
      *value = found != self(s).numbers.end()                ? found->second
               : word_written || std::isinf(p.default_value) ? std::numeric_limits<double>::quiet_NaN()
                                                             : p.default_value;
    });
  }
  static Status vector(const void* s, const char* name, double* xyz, Message* m) noexcept {
    return abi::guarded(m, [&] {
      self(s).find(name);
      const auto found = self(s).vectors.find(name);
      for (std::size_t i = 0; i < 3; ++i)
        xyz[i] = found != self(s).vectors.end() && i < found->second.size() ? found->second[i] : 0.0;
    });
  }
  static Status word(const void* s, const char* name, std::int32_t* index, Message* m) noexcept {
    return abi::guarded(m, [&] {
      const Parameter& p = self(s).find(name);
      const auto found = self(s).words.find(name);
      const bool choice = p.kind == ParameterKind::choice;
      *index = found != self(s).words.end() ? found->second : choice ? static_cast<int>(p.default_value) : -1;
    });
  }
  static Status given(const void* s, const char* name, std::int32_t* yes, Message* m) noexcept {
    return abi::guarded(m, [&] {
      self(s).find(name);
      *yes = self(s).numbers.count(name) + self(s).vectors.count(name) + self(s).words.count(name) > 0 ? 1 : 0;
    });
  }
  static Status function(const void*, const char*, TimeFunction*, Message*) noexcept { return Status::failed; }
  static Status formula(const void* s, const char* name, Formula* out, Message* m) noexcept {
    return abi::guarded(m, [&] {
      self(s).find(name);
      const auto found = self(s).formulas.find(name);
      if (found != self(s).formulas.end()) *out = found->second;
    });
  }
  static Status points(const void*, const char*, TablePoints*, Message*) noexcept { return Status::failed; }
  static Status contact_law(const void* s, const char* name, const ContactPair* pair, ContactLawRef* law,
                            Message* m) noexcept {
    return abi::guarded(m, [&] {
      self(s).find(name);
      self(s).pair = *pair;
      *law = {abi::contact_law_table<FunctionContact>, static_cast<FunctionContact*>(self(s).contact.get())};
    });
  }
  static Status friction_law(const void* s, const char* name, FrictionLawRef* law, Message* m) noexcept {
    return abi::guarded(m, [&] {
      self(s).find(name);
      static const FunctionFriction none([](const FrictionState&, Span<double>) { return FrictionForce{}; });
      const auto* given_law = static_cast<FunctionFriction*>(self(s).friction.get());
      *law = {abi::friction_law_table<FunctionFriction>, given_law ? given_law : &none};
    });
  }

  const Component* row_;
};

/// An object made by a component's create function, and the table to call it with. Throws what the constructor threw.
template <class Table>
class Instance {
 public:
  template <class... Extra>
  Instance(const Component& row, const ParameterStub& stub, const Extra*... extra)
      : table_(static_cast<const Table*>(row.table)) {
    using Create = Status (*)(const abi::ParameterTable*, const Extra*..., void**, Message*) noexcept;
    const abi::ParameterTable parameters = stub.table();
    Message message;
    abi::require(reinterpret_cast<Create>(row.create)(&parameters, extra..., &self_, &message), message);
  }
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;
  ~Instance() { table_->destroy(self_); }

  /// Calls a function of the table: instance.call(&abi::JointTable::apply, &in, &out).
  template <class Function, class... Arguments>
  void call(Function function, Arguments... arguments) const {
    Message message;
    abi::require((table_->*function)(self_, arguments..., &message), message);
  }
  const Table& table() const { return *table_; }
  void* self() const { return self_; }

 private:
  const Table* table_;
  void* self_ = nullptr;
};

using JointInstance = Instance<abi::JointTable>;
using IntegratorInstance = Instance<abi::IntegratorTable>;

/// The id of the BadParameter that `body` throws, "" without one.
template <class Body>
std::string bad_parameter_id(Body&& body) {
  try {
    body();
  } catch (const BadParameter& e) {
    return e.id();
  }
  return "";
}

}  // namespace freeplay::test
