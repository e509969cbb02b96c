#include "component/instances.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "component/plugin_memory.h"

namespace freeplay {
namespace {

using CreateJoint = Status (*)(const abi::ParameterTable*, void**, Message*) noexcept;
using CreateIntegrator = CreateJoint;
using CreateFrictionLaw = CreateJoint;
using CreateContactLaw = Status (*)(const abi::ParameterTable*, const ContactPair*, void**, Message*) noexcept;

template <class Table>
const Table& table_of(const Component& component) {
  return *static_cast<const Table*>(component.table);
}

std::string named(const Component& component, const std::string& text) {
  return std::string("'") + component.description.name + "': " + text;
}

/// A law, and how messages name it.
template <class Law>
struct NamedLaw {
  Law law;
  std::string name;

  /// Calls `body` on the law; puts the name before what is thrown.
  template <class Body>
  static Status call(const void* self, Message* message, Body&& body) noexcept {
    const auto& me = *static_cast<const NamedLaw*>(self);
    const Status status = abi::guarded(message, [&] { body(me.law); });
    if (status == Status::ok) return status;
    Message text = *message;
    const std::size_t length = std::min(me.name.size(), sizeof text.text / 2);
    std::memcpy(text.text, me.name.data(), length);
    std::memcpy(text.text + length, ": ", 2);
    abi::copy_text(text.text + length + 2, sizeof text.text - length - 2, message->text);
    *message = text;
    return status;
  }
};

void require_finite(bool finite) {
  if (!finite) throw std::runtime_error("it returned a force that is not a finite number");
}

constexpr abi::ContactLawTable named_contact_law{
    sizeof(abi::ContactLawTable),
    nullptr,
    [](const void* self, const ContactState* in, ContactForce* out, Message* m) noexcept {
      return NamedLaw<ContactLawRef>::call(self, m, [&](const ContactLawRef& law) {
        *out = law.evaluate(*in);
        require_finite(std::isfinite(out->normal + out->potential) || !std::isfinite(in->penetration + in->rate));
      });
    },
    [](const void* self, const ContactState* in, const char** why, Message* m) noexcept {
      return NamedLaw<ContactLawRef>::call(self, m, [&](const ContactLawRef& law) { *why = law.outside_range(*in); });
    },
    [](const void* self, std::int32_t* count, Message* m) noexcept {
      return NamedLaw<ContactLawRef>::call(self, m, [&](const ContactLawRef& law) { *count = law.switches(); });
    },
    [](const void* self, const ContactState* in, Span<double> values, Message* m) noexcept {
      return NamedLaw<ContactLawRef>::call(self, m, [&](const ContactLawRef& law) { law.decide(*in, values); });
    }};

constexpr abi::FrictionLawTable named_friction_law{
    sizeof(abi::FrictionLawTable),
    nullptr,
    [](const void* self, std::int32_t* count, Message* m) noexcept {
      return NamedLaw<FrictionLawRef>::call(self, m,
                                            [&](const FrictionLawRef& law) { *count = law.internal_variables(); });
    },
    [](const void* self, const FrictionState* in, Span<double> rate, FrictionForce* out, Message* m) noexcept {
      return NamedLaw<FrictionLawRef>::call(self, m, [&](const FrictionLawRef& law) {
        *out = law.evaluate(*in, rate);
        require_finite(std::isfinite(out->tangential) || !std::isfinite(in->normal_force + in->slip_speed));
      });
    },
    [](const void* self, Span<const double>* speeds, Message* m) noexcept {
      return NamedLaw<FrictionLawRef>::call(self, m, [&](const FrictionLawRef& law) { *speeds = law.kinks(); });
    },
    [](const void* self, std::int32_t* count, Message* m) noexcept {
      return NamedLaw<FrictionLawRef>::call(self, m, [&](const FrictionLawRef& law) { *count = law.switches(); });
    },
    [](const void* self, const FrictionState* in, Span<double> values, Message* m) noexcept {
      return NamedLaw<FrictionLawRef>::call(self, m, [&](const FrictionLawRef& law) { law.decide(*in, values); });
    }};

CreationFault fault_of(const Component& component, Status status, const Message& message) {
  if (status == Status::bad_parameter) return {true, message.path, message.id, message.text};
  return {false, "", "plugin-failed", named(component, message.text[0] == '\0' ? "creates nothing" : message.text)};
}

}  // namespace

/// Serves one component's parameters while its constructor runs.
struct Instances::Server {
  Instances& owner;
  const ParameterBlock& block;

  const ParameterValue& value(const char* name) const {
    const auto found = block.values.find(std::string_view(name));
    if (found != block.values.end()) return found->second;
    throw std::logic_error(std::string("asks for the parameter '") + name + "', which is not in its table");
  }
  const ParameterBlock& law(const char* name) const {
    const ParameterValue& found = value(name);
    if (found.law == nullptr)
      throw std::logic_error(std::string("asks for the law '") + name + "', which is not given");
    return *found.law;
  }

  /// A law's fault becomes the joint's, seen from the joint's block.
  static void pass_on(const CreationFault& fault, const char* name) {
    if (!fault.bad_parameter) throw std::runtime_error(fault.text);
    const std::string path = fault.path.empty() ? std::string(name) : std::string(name) + "." + fault.path;
    static thread_local std::string kept_path, kept_id;
    kept_path = path;
    kept_id = fault.id;
    throw BadParameter(kept_path.c_str(), kept_id.c_str(), fault.text);
  }

  ContactLawRef serve_contact_law(const ParameterBlock& law, const ContactPair& pair, CreationFault& fault) const;
  FrictionLawRef serve_friction_law(const ParameterBlock& law, CreationFault& fault) const;

  static const Server& of(const void* self) { return *static_cast<const Server*>(self); }
  abi::ParameterTable table() const;
  void keep_functions() const;
};

abi::ParameterTable Instances::Server::table() const {
  abi::ParameterTable table{};
  table.size = sizeof table;
  table.self = this;
  table.number = [](const void* self, const char* name, double* out, Message* m) noexcept {
    return abi::guarded(m, [&] { *out = of(self).value(name).number; });
  };
  table.vector = [](const void* self, const char* name, double* xyz, Message* m) noexcept {
    return abi::guarded(m, [&] {
      const std::array<double, 3>& vector = of(self).value(name).vector;
      for (std::size_t i = 0; i < vector.size(); ++i) xyz[i] = vector[i];
    });
  };
  table.word = [](const void* self, const char* name, std::int32_t* index, Message* m) noexcept {
    return abi::guarded(m, [&] { *index = of(self).value(name).word; });
  };
  table.given = [](const void* self, const char* name, std::int32_t* yes, Message* m) noexcept {
    return abi::guarded(m, [&] { *yes = of(self).value(name).given ? 1 : 0; });
  };
  table.function = [](const void* self, const char* name, TimeFunction* out, Message* m) noexcept {
    return abi::guarded(m, [&] { *out = of(self).value(name).function; });
  };
  table.formula = [](const void* self, const char* name, Formula* out, Message* m) noexcept {
    return abi::guarded(m, [&] { *out = of(self).value(name).formula; });
  };
  table.contact_law = [](const void* self, const char* name, const ContactPair* pair, ContactLawRef* law,
                         Message* m) noexcept {
    return abi::guarded(m, [&] {
      CreationFault fault;
      *law = of(self).serve_contact_law(of(self).law(name), *pair, fault);
      if (!fault.id.empty()) pass_on(fault, name);
    });
  };
  table.friction_law = [](const void* self, const char* name, FrictionLawRef* law, Message* m) noexcept {
    return abi::guarded(m, [&] {
      CreationFault fault;
      *law = of(self).serve_friction_law(of(self).law(name), fault);
      if (!fault.id.empty()) pass_on(fault, name);
    });
  };
  return table;
}

// A joint gets its law through a table of ours, so that a law that fails is named.
ContactLawRef Instances::Server::serve_contact_law(const ParameterBlock& law, const ContactPair& pair,
                                                   CreationFault& fault) const {
  const ContactLawRef inner = owner.create_contact_law(law, pair, fault);
  if (!fault.id.empty()) return {};
  auto* named = new NamedLaw<ContactLawRef>{inner, "contact law of " + owner.words_of(*law.component)};
  owner.objects_.emplace_back(named, [](void* self) { delete static_cast<NamedLaw<ContactLawRef>*>(self); });
  return {named_contact_law, named};
}

FrictionLawRef Instances::Server::serve_friction_law(const ParameterBlock& law, CreationFault& fault) const {
  const FrictionLawRef inner = owner.create_friction_law(law, fault);
  if (!fault.id.empty()) return {};
  auto* named = new NamedLaw<FrictionLawRef>{inner, "friction law of " + owner.words_of(*law.component)};
  owner.objects_.emplace_back(named, [](void* self) { delete static_cast<NamedLaw<FrictionLawRef>*>(self); });
  return {named_friction_law, named};
}

std::string Instances::words_of(const Component& component) const {
  std::string words = std::string("type '") + component.description.name + "'";
  for (const RegisteredLibrary& library : libraries_) {
    if (library.path == "built-in") continue;
    for (const Component& row : library.table->components()) {
      if (&row == &component) words += " of plugin '" + library.path + "'";
    }
  }
  return words;
}

void Instances::Server::keep_functions() const {
  for (const auto& [name, value] : block.values) {
    // The deleter holds the owner; there is nothing else to delete.
    if (value.function_owner) owner.objects_.emplace_back(nullptr, [kept = value.function_owner](void*) {});
  }
}

/// Calls `make(table, &self, &message)`; returns the object, or null and the fault.
template <class Make>
void* Instances::create(const ParameterBlock& parameters, Make make, void (*destroy)(void*) noexcept,
                        CreationFault& fault) {
  const Component& component = *parameters.component;
  const Server server{*this, parameters};
  const abi::ParameterTable served = server.table();
  void* self = nullptr;
  Message message;
  const Status status = make(&served, &self, &message);
  if (status != Status::ok || self == nullptr) {
    require_memory(message);
    fault = fault_of(component, status, message);
    return nullptr;
  }
  objects_.emplace_back(self, destroy);
  server.keep_functions();
  return self;
}

JointRef Instances::create_joint(const ParameterBlock& parameters, Space space, CreationFault& fault) {
  const Component& component = *parameters.component;
  JointFace face{component.table, component.create};
  if (space == Space::spatial && component.description.in_space.table != nullptr) face = component.description.in_space;
  const auto& table = *static_cast<const abi::JointTable*>(face.table);
  void* self = create(parameters, reinterpret_cast<CreateJoint>(face.create), table.destroy, fault);
  return self == nullptr ? JointRef() : JointRef(table, self);
}

IntegratorRef Instances::create_integrator(const ParameterBlock& parameters, CreationFault& fault) {
  const auto make = reinterpret_cast<CreateIntegrator>(parameters.component->create);
  void* self = create(parameters, make, table_of<abi::IntegratorTable>(*parameters.component).destroy, fault);
  return self == nullptr ? IntegratorRef() : IntegratorRef(table_of<abi::IntegratorTable>(*parameters.component), self);
}

ContactLawRef Instances::create_contact_law(const ParameterBlock& parameters, const ContactPair& pair,
                                            CreationFault& fault) {
  const auto create_law = reinterpret_cast<CreateContactLaw>(parameters.component->create);
  const auto make = [&](const abi::ParameterTable* table, void** self, Message* message) {
    return create_law(table, &pair, self, message);
  };
  void* self = create(parameters, make, table_of<abi::ContactLawTable>(*parameters.component).destroy, fault);
  return self == nullptr ? ContactLawRef() : ContactLawRef(table_of<abi::ContactLawTable>(*parameters.component), self);
}

FrictionLawRef Instances::create_friction_law(const ParameterBlock& parameters, CreationFault& fault) {
  const auto make = reinterpret_cast<CreateFrictionLaw>(parameters.component->create);
  void* self = create(parameters, make, table_of<abi::FrictionLawTable>(*parameters.component).destroy, fault);
  return self == nullptr ? FrictionLawRef()
                         : FrictionLawRef(table_of<abi::FrictionLawTable>(*parameters.component), self);
}

}  // namespace freeplay
