#include "component/registry.h"

#include <gtest/gtest.h>

#include "../model/toy_components.h"
#include "base/error.h"

namespace freeplay {
namespace {

std::string refusal(PluginEntry entry) {
  Registry registry;
  try {
    registry.add(entry, "lib.so");
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 5);
    EXPECT_TRUE(registry.components().empty());
    return error.id();
  }
  return "";
}

TEST(Registry, FindsTypesByKindAndName) {
  Registry registry;
  registry.add(&toy::publish_toys, "toys");
  ASSERT_NE(registry.find(ComponentKind::joint, "pin"), nullptr);
  EXPECT_EQ(registry.find(ComponentKind::contact_law, "pin"), nullptr);
  EXPECT_STREQ(registry.preferred(ComponentKind::integrator)->description.name, "stepper");
  EXPECT_EQ(registry.preferred(ComponentKind::joint), nullptr);
  EXPECT_EQ(registry.names(ComponentKind::integrator), (std::vector<std::string>{"stepper", "stumbler"}));
  EXPECT_EQ(registry.components().front().library, "toys");
}

TEST(Registry, KnowsTheTwinForABlock) {
  Registry registry;
  registry.add(&toy::publish_toys, "toys");
  EXPECT_STREQ(registry.twin("pin", "play")->description.name, "loose-pin");
  EXPECT_EQ(registry.twin("pin", "plai"), nullptr);
  EXPECT_EQ(registry.twin("slide", "play"), nullptr);
}

TEST(Registry, RefusesANameThatIsTaken) {
  Registry registry;
  registry.add(&toy::publish_toys, "toys");
  const std::size_t before = registry.components().size();
  try {
    registry.add(&toy::publish_toys, "again");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), "plugin-clash");
  }
  EXPECT_EQ(registry.components().size(), before);
}

TEST(Registry, RefusesWhatItDoesNotUnderstand) {
  EXPECT_EQ(refusal([](const Host*, Manifest*) noexcept { return Status::failed; }), "plugin-refused");
  EXPECT_EQ(refusal([](const Host* host, Manifest* manifest) noexcept {
              const Status status = toy::publish_toys(host, manifest);
              manifest->abi_version = 99;
              return status;
            }),
            "plugin-refused");
  EXPECT_EQ(refusal([](const Host* host, Manifest* manifest) noexcept {
              const Status status = toy::publish_toys(host, manifest);
              manifest->component_size += 8;
              return status;
            }),
            "plugin-refused");
  EXPECT_EQ(refusal([](const Host* host, Manifest* manifest) noexcept {
              const Status status = toy::publish_toys(host, manifest);
              manifest->fingerprint = "ilp32 big";
              return status;
            }),
            "plugin-refused");
}

}  // namespace
}  // namespace freeplay
