#include "component/instances.h"

#include <stdexcept>

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
  table.contact_law = [](const void* self, const char* name, const ContactPair* pair, ContactLawRef* law,
                         Message* m) noexcept {
    return abi::guarded(m, [&] {
      CreationFault fault;
      *law = of(self).owner.create_contact_law(of(self).law(name), *pair, fault);
      if (!fault.id.empty()) pass_on(fault, name);
    });
  };
  table.friction_law = [](const void* self, const char* name, FrictionLawRef* law, Message* m) noexcept {
    return abi::guarded(m, [&] {
      CreationFault fault;
      *law = of(self).owner.create_friction_law(of(self).law(name), fault);
      if (!fault.id.empty()) pass_on(fault, name);
    });
  };
  return table;
}

void Instances::Server::keep_functions() const {
  for (const auto& [name, value] : block.values) {
    // The deleter holds the owner; there is nothing else to delete.
    if (value.function_owner) owner.objects_.emplace_back(nullptr, [kept = value.function_owner](void*) {});
  }
}

/// Calls `make(table, &self, &message)`; returns the object, or null and the fault.
template <class Table, class Make>
void* Instances::create(const ParameterBlock& parameters, Make make, CreationFault& fault) {
  const Component& component = *parameters.component;
  const Server server{*this, parameters};
  const abi::ParameterTable served = server.table();
  void* self = nullptr;
  Message message;
  const Status status = make(&served, &self, &message);
  if (status != Status::ok || self == nullptr) {
    fault = fault_of(component, status, message);
    return nullptr;
  }
  objects_.emplace_back(self, table_of<Table>(component).destroy);
  server.keep_functions();
  return self;
}

JointRef Instances::create_joint(const ParameterBlock& parameters, CreationFault& fault) {
  const auto make = reinterpret_cast<CreateJoint>(parameters.component->create);
  void* self = create<abi::JointTable>(parameters, make, fault);
  return self == nullptr ? JointRef() : JointRef(table_of<abi::JointTable>(*parameters.component), self);
}

IntegratorRef Instances::create_integrator(const ParameterBlock& parameters, CreationFault& fault) {
  const auto make = reinterpret_cast<CreateIntegrator>(parameters.component->create);
  void* self = create<abi::IntegratorTable>(parameters, make, fault);
  return self == nullptr ? IntegratorRef() : IntegratorRef(table_of<abi::IntegratorTable>(*parameters.component), self);
}

ContactLawRef Instances::create_contact_law(const ParameterBlock& parameters, const ContactPair& pair,
                                            CreationFault& fault) {
  const auto create_law = reinterpret_cast<CreateContactLaw>(parameters.component->create);
  const auto make = [&](const abi::ParameterTable* table, void** self, Message* message) {
    return create_law(table, &pair, self, message);
  };
  void* self = create<abi::ContactLawTable>(parameters, make, fault);
  return self == nullptr ? ContactLawRef() : ContactLawRef(table_of<abi::ContactLawTable>(*parameters.component), self);
}

FrictionLawRef Instances::create_friction_law(const ParameterBlock& parameters, CreationFault& fault) {
  const auto make = reinterpret_cast<CreateFrictionLaw>(parameters.component->create);
  void* self = create<abi::FrictionLawTable>(parameters, make, fault);
  return self == nullptr ? FrictionLawRef()
                         : FrictionLawRef(table_of<abi::FrictionLawTable>(*parameters.component), self);
}

}  // namespace freeplay
