// Instances: creates components from checked parameters and keeps them alive.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "component/integrator_ref.h"
#include "component/joint_ref.h"
#include "component/parameter_block.h"
#include "component/registry.h"

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
  /// Keeps the tables of a library alive as long as what was created from them, and knows the library by its path.
  void keep(const RegisteredLibrary& library) { libraries_.push_back(library); }
  const std::vector<RegisteredLibrary>& libraries() const { return libraries_; }
  Instances(Instances&&) = default;
  Instances& operator=(Instances&& other) noexcept {
    objects_ = std::move(other.objects_);  // what is replaced goes before its tables
    libraries_ = std::move(other.libraries_);
    return *this;
  }

  /// Empty handle and a filled `fault` when the component cannot be made. `space`: planar or spatial, of the model.
  JointRef create_joint(const ParameterBlock& parameters, Space space, CreationFault& fault);
  IntegratorRef create_integrator(const ParameterBlock& parameters, CreationFault& fault);
  ContactLawRef create_contact_law(const ParameterBlock& parameters, const ContactPair& pair, CreationFault& fault);
  FrictionLawRef create_friction_law(const ParameterBlock& parameters, CreationFault& fault);

  /// "type 'NAME'", and "of plugin 'PATH'" where a library of its own brings it: how messages name a component.
  std::string words_of(const Component& component) const;

 private:
  struct Server;  // answers a constructor's questions
  using Owned = std::unique_ptr<void, std::function<void(void*)>>;
  template <class Make>
  void* create(const ParameterBlock& parameters, Make make, void (*destroy)(void*) noexcept, CreationFault& fault);
  std::vector<RegisteredLibrary> libraries_;  // their tables outlive the objects below
  std::vector<Owned> objects_;
};

}  // namespace freeplay
