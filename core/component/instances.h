// Instances: creates components from checked parameters and keeps them alive.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "component/integrator_ref.h"
#include "component/joint_ref.h"
#include "component/parameter_block.h"

namespace freeplay {

/// A constructor refused its parameters, or failed. `path` starts with the names of the law blocks it lies in:
/// "clearance.contact" + "." + path within the law.
struct CreationFault {
  bool bad_parameter = false;  ///< an input error with `id`; otherwise the plugin itself failed
  std::string path, id, text;
};

/// Owner of joints, laws and integrators. Objects live as long as it does. Not thread-safe.
class Instances {
 public:
  Instances() = default;
  /// Keeps the tables of a registry's libraries alive as long as what was created from them.
  void keep(std::shared_ptr<const void> tables) { tables_.push_back(std::move(tables)); }
  Instances(Instances&&) = default;
  Instances& operator=(Instances&& other) noexcept {
    objects_ = std::move(other.objects_);  // what is replaced goes before its tables
    tables_ = std::move(other.tables_);
    return *this;
  }

  /// Empty handle and a filled `fault` when the component cannot be made.
  JointRef create_joint(const ParameterBlock& parameters, CreationFault& fault);
  IntegratorRef create_integrator(const ParameterBlock& parameters, CreationFault& fault);
  ContactLawRef create_contact_law(const ParameterBlock& parameters, const ContactPair& pair, CreationFault& fault);
  FrictionLawRef create_friction_law(const ParameterBlock& parameters, CreationFault& fault);

 private:
  struct Server;  // answers a constructor's questions
  using Owned = std::unique_ptr<void, std::function<void(void*)>>;
  template <class Table, class Make>
  void* create(const ParameterBlock& parameters, Make make, CreationFault& fault);
  std::vector<std::shared_ptr<const void>> tables_;  // outlive the objects below
  std::vector<Owned> objects_;
};

}  // namespace freeplay
