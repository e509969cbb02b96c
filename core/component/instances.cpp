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

/// A law, and how messages name it. It is called in every evaluation of a contact: calls go straight on to its table.
template <class Table>
struct NamedLaw {
  const Table& table;
  const void* law;
  std::string name;

  static const NamedLaw& of(const void* self) { return *static_cast<const NamedLaw*>(self); }
  /// The status of a call; puts the name before what one that failed has said.
  Status named(Status status, Message* message) const noexcept {
    return status == Status::ok ? status : add_name(status, message);
  }
  [[gnu::cold, gnu::noinline]] Status add_name(Status status, Message* message) const noexcept {
    Message text = *message;
    const std::size_t length = std::min(name.size(), sizeof text.text / 2);
    std::memcpy(text.text, name.data(), length);
    std::memcpy(text.text + length, ": ", 2);
    abi::copy_text(text.text + length + 2, sizeof text.text - length - 2, message->text);
    *message = text;
    return status;
  }
  /// The same of one for a force, which must be a finite number.
  Status named(Status status, bool finite, Message* message) const noexcept {
    return finite ? named(status, message) : refuse(status, message);
  }
  [[gnu::cold, gnu::noinline]] Status refuse(Status status, Message* message) const noexcept {
    if (status != Status::ok) return named(status, message);
    abi::copy_text(message->text, sizeof message->text, "it returned a force that is not a finite number");
    return named(Status::failed, message);
  }
};
using NamedContactLaw = NamedLaw<abi::ContactLawTable>;
using NamedFrictionLaw = NamedLaw<abi::FrictionLawTable>;

constexpr abi::ContactLawTable named_contact_law{
    sizeof(abi::ContactLawTable),
    nullptr,
    [](const void* self, const ContactState* in, ContactForce* out, Message* m) noexcept {
      const auto& me = NamedContactLaw::of(self);
      const Status status = me.table.evaluate(me.law, in, out, m);
      const bool asked_finite = std::isfinite(in->penetration + in->rate);
      return me.named(status, std::isfinite(out->normal + out->potential) || !asked_finite, m);
    },
    [](const void* self, const ContactState* in, const char** why, Message* m) noexcept {
      const auto& me = NamedContactLaw::of(self);
      return me.named(me.table.outside_range(me.law, in, why, m), m);
    },
    [](const void* self, std::int32_t* count, Message* m) noexcept {
      const auto& me = NamedContactLaw::of(self);
      return me.named(me.table.switches(me.law, count, m), m);
    },
    [](const void* self, const ContactState* in, Span<double> values, Message* m) noexcept {
      const auto& me = NamedContactLaw::of(self);
      return me.named(me.table.decide(me.law, in, values, m), m);
    }};

constexpr abi::FrictionLawTable named_friction_law{
    sizeof(abi::FrictionLawTable),
    nullptr,
    [](const void* self, std::int32_t* count, Message* m) noexcept {
      const auto& me = NamedFrictionLaw::of(self);
      return me.named(me.table.internal_variables(me.law, count, m), m);
    },
    [](const void* self, const FrictionState* in, Span<double> rate, FrictionForce* out, Message* m) noexcept {
      const auto& me = NamedFrictionLaw::of(self);
      const Status status = me.table.evaluate(me.law, in, rate, out, m);
      const bool asked_finite = std::isfinite(in->normal_force + in->slip_speed);
      return me.named(status, std::isfinite(out->tangential) || !asked_finite, m);
    },
    [](const void* self, Span<const double>* speeds, Message* m) noexcept {
      const auto& me = NamedFrictionLaw::of(self);
      return me.named(me.table.kinks(me.law, speeds, m), m);
    },
    [](const void* self, std::int32_t* count, Message* m) noexcept {
      const auto& me = NamedFrictionLaw::of(self);
      return me.named(me.table.switches(me.law, count, m), m);
    },
    [](const void* self, const FrictionState* in, Span<double> values, Message* m) noexcept {
      const auto& me = NamedFrictionLaw::of(self);
      return me.named(me.table.decide(me.law, in, values, m), m);
    },
    [](const void* self, Span<double> start, Span<MemoryReset> resets, Message* m) noexcept {
      const auto& me = NamedFrictionLaw::of(self);
      return me.named(me.table.memory(me.law, start, resets, m), m);
    },
    [](const void* self, Span<const double> internal, double* energy, Span<double> slopes, Message* m) noexcept {
      const auto& me = NamedFrictionLaw::of(self);
      return me.named(me.table.stored(me.law, internal, energy, slopes, m), m);
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

  static void* make_contact_law(Instances& owner, const ParameterBlock& parameters, const ContactPair& pair,
                                CreationFault& fault);
  static void* make_friction_law(Instances& owner, const ParameterBlock& parameters, CreationFault& fault);
  ContactLawRef serve_contact_law(const ParameterBlock& law, const ContactPair& pair, CreationFault& fault) const;
  FrictionLawRef serve_friction_law(const ParameterBlock& law, CreationFault& fault) const;

  /// A pair of surfaces as this program has it: the library of the joint may fill fewer of its fields.
  ContactPair whole(const ContactPair& given) const {
    std::size_t size = sizeof(ContactPair);
    for (const RegisteredLibrary& library : owner.libraries_) {
      for (const Component& row : library.table->components()) {
        if (&row == block.component) size = std::min(size, library.table->contact_pair_size());
      }
    }
    ContactPair pair{};
    std::memcpy(static_cast<void*>(&pair), &given, size);
    return pair;
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
  table.formula = [](const void* self, const char* name, Formula* out, Message* m) noexcept {
    return abi::guarded(m, [&] { *out = of(self).value(name).formula; });
  };
  table.points = [](const void* self, const char* name, TablePoints* out, Message* m) noexcept {
    return abi::guarded(m, [&] {
      const ParameterPoints* points = of(self).value(name).points.get();
      *out = points == nullptr
                 ? TablePoints{}
                 : TablePoints{{points->x.data(), points->x.size()}, {points->y.data(), points->y.size()}};
    });
  };
  table.contact_law = [](const void* self, const char* name, const ContactPair* pair, ContactLawRef* law,
                         Message* m) noexcept {
    return abi::guarded(m, [&] {
      CreationFault fault;
      *law = of(self).serve_contact_law(of(self).law(name), of(self).whole(*pair), fault);
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
  const void* made = make_contact_law(owner, law, pair, fault);
  if (!fault.id.empty()) return {};
  const auto& table = table_of<abi::ContactLawTable>(*law.component);
  auto* named = new NamedContactLaw{table, made, "contact law of " + owner.words_of(*law.component)};
  owner.objects_.emplace_back(named, [](void* self) { delete static_cast<NamedContactLaw*>(self); });
  return {named_contact_law, named};
}

FrictionLawRef Instances::Server::serve_friction_law(const ParameterBlock& law, CreationFault& fault) const {
  const void* made = make_friction_law(owner, law, fault);
  if (!fault.id.empty()) return {};
  const auto& table = table_of<abi::FrictionLawTable>(*law.component);
  auto* named = new NamedFrictionLaw{table, made, "friction law of " + owner.words_of(*law.component)};
  owner.objects_.emplace_back(named, [](void* self) { delete static_cast<NamedFrictionLaw*>(self); });
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
    if (value.points) owner.objects_.emplace_back(nullptr, [kept = value.points](void*) {});
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

void* Instances::Server::make_contact_law(Instances& owner, const ParameterBlock& parameters, const ContactPair& pair,
                                          CreationFault& fault) {
  const auto create_law = reinterpret_cast<CreateContactLaw>(parameters.component->create);
  const auto make = [&](const abi::ParameterTable* table, void** self, Message* message) {
    return create_law(table, &pair, self, message);
  };
  return owner.create(parameters, make, table_of<abi::ContactLawTable>(*parameters.component).destroy, fault);
}

void* Instances::Server::make_friction_law(Instances& owner, const ParameterBlock& parameters, CreationFault& fault) {
  const auto make = reinterpret_cast<CreateFrictionLaw>(parameters.component->create);
  return owner.create(parameters, make, table_of<abi::FrictionLawTable>(*parameters.component).destroy, fault);
}

ContactLawRef Instances::create_contact_law(const ParameterBlock& parameters, const ContactPair& pair,
                                            CreationFault& fault) {
  const void* self = Server::make_contact_law(*this, parameters, pair, fault);
  return self == nullptr ? ContactLawRef() : ContactLawRef(table_of<abi::ContactLawTable>(*parameters.component), self);
}

FrictionLawRef Instances::create_friction_law(const ParameterBlock& parameters, CreationFault& fault) {
  const void* self = Server::make_friction_law(*this, parameters, fault);
  return self == nullptr ? FrictionLawRef()
                         : FrictionLawRef(table_of<abi::FrictionLawTable>(*parameters.component), self);
}

}  // namespace freeplay
