#include "component/registry.h"

#include <cstddef>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "unit/format/toy_components.h"

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

TEST(Registry, SaysWhatAMissingTypeNeedsUnlessAnotherLibraryHasIt) {
  Registry registry;
  registry.add(
      [](const Host* host, Manifest* manifest) noexcept {
        static const Component rows[] = {joint<toy::Slide>({.name = "glide", .space = Space::planar}),
                                         missing_type(ComponentKind::joint, "pin", "it needs a lathe")};
        return publish(*host, *manifest, "half", "1", rows);
      },
      "half");
  EXPECT_EQ(registry.find(ComponentKind::joint, "pin"), nullptr);
  EXPECT_EQ(registry.names(ComponentKind::joint), (std::vector<std::string>{"glide"}));
  EXPECT_STREQ(registry.remedy(ComponentKind::joint, "pin"), "it needs a lathe");
  EXPECT_EQ(registry.remedy(ComponentKind::integrator, "pin"), nullptr);
  EXPECT_EQ(registry.remedy(ComponentKind::joint, "pins"), nullptr);
  registry.add(&toy::publish_toys, "toys");
  EXPECT_NE(registry.find(ComponentKind::joint, "pin"), nullptr);
  EXPECT_EQ(registry.remedy(ComponentKind::joint, "pin"), nullptr);
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

// A joint that is described as `change` says, published after the toys.
template <class Change>
std::string claim(Change change) {
  static Component row;
  row = {};
  Registry registry;
  registry.add(&toy::publish_toys, "toys");
  const Component* pin = registry.find(ComponentKind::joint, "loose-pin");
  row = *pin;
  row.description.name = "mine";
  row.description.ideal = row.description.block = nullptr;
  row.description.first_end = row.description.second_end = nullptr;
  row.description.parameters = {};
  change(row.description);
  try {
    registry.add(
        [](const Host* host, Manifest* manifest) noexcept {
          return publish(*host, *manifest, "mine", "1", {&row, 1});
        },
        "mine.so");
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), "plugin-clash");
    return error.message();
  }
  return "";
}

TEST(Registry, KeepsTypesFromTakingWordsThatAreTaken) {
  using testing::HasSubstr;
  EXPECT_EQ(claim([](Description&) {}), "");
  EXPECT_EQ(claim([](Description& d) { d.ideal = "pin", d.block = "wear"; }), "");
  EXPECT_THAT(claim([](Description& d) { d.ideal = "pin", d.block = "play"; }),
              HasSubstr("as 'toys' says of 'loose-pin' already"));
  EXPECT_THAT(claim([](Description& d) { d.ideal = "pin", d.block = "between"; }), HasSubstr("every joint has"));
  EXPECT_THAT(claim([](Description& d) { d.ideal = "mine", d.block = "play"; }), HasSubstr("the type itself"));
  EXPECT_THAT(claim([](Description& d) { d.ideal = "pin"; }), HasSubstr("its ideal type and its block together"));
  EXPECT_THAT(claim([](Description& d) { d.first_end = "bearing"; }), HasSubstr("one of its ends only"));
  EXPECT_THAT(claim([](Description& d) { d.first_end = "type", d.second_end = "use"; }), HasSubstr("the key 'type'"));
  EXPECT_THAT(claim([](Description& d) { d.name = "gear"; }), HasSubstr("the model file has a meaning for"));
  static constexpr Parameter use[] = {{.name = "use.more"}};
  EXPECT_THAT(claim([](Description& d) { d.parameters = use; }), HasSubstr("the key 'use'"));
}

// A law with one parameter.
std::string refusal_of(const Parameter& parameter) {
  static Parameter row;
  row = parameter;
  Registry registry;
  try {
    registry.add(
        [](const Host* host, Manifest* manifest) noexcept {
          static Component law;
          law = friction_law<toy::Slippery>({.name = "measured", .parameters = {&row, 1}});
          return publish(*host, *manifest, "measured", "1", {&law, 1});
        },
        "measured.so");
  } catch (const Error& error) {
    return error.message();
  }
  return "";
}

// What a law built before them says of its memory: nothing.
TEST(Registry, StandsInForFunctionsThatCameAfterALaw) {
  static abi::FrictionLawTable table = abi::friction_law_table<toy::Slippery>;
  table.size = offsetof(abi::FrictionLawTable, memory);
  table.memory = nullptr;
  table.stored = nullptr;
  Registry registry;
  registry.add(
      [](const Host* host, Manifest* manifest) noexcept {
        static Component law;
        law = friction_law<toy::Slippery>({.name = "older"});
        law.table = &table;
        return publish(*host, *manifest, "older", "1", {&law, 1});
      },
      "older.so");
  const Component& older = *registry.find(ComponentKind::friction_law, "older");
  const FrictionLawRef law(*static_cast<const abi::FrictionLawTable*>(older.table), nullptr);
  double start[] = {0.0, 0.0}, slopes[] = {1.0, 1.0};
  MemoryReset resets[] = {MemoryReset::each_contact, MemoryReset::each_contact};
  law.memory(start, resets);
  EXPECT_EQ(start[0], 0.0);
  EXPECT_EQ(resets[1], MemoryReset::each_contact);
  EXPECT_EQ(law.stored(start, slopes), 0.0);
  EXPECT_EQ(slopes[1], 0.0);
}

TEST(Registry, RefusesListsAndTablesThatNothingCanFill) {
  using testing::HasSubstr;
  const auto list = [](double fallback, std::uint32_t least, std::uint32_t most) {
    return refusal_of(
        {.name = "speeds", .kind = ParameterKind::list, .default_value = fallback, .least = least, .most = most});
  };
  EXPECT_EQ(list(required, 1, 3), "");
  EXPECT_EQ(list(optional, 0, 1), "");
  EXPECT_THAT(list(0.5, 1, 3), HasSubstr("parameter 'speeds' that has a default"));
  EXPECT_THAT(list(required, 4, 3), HasSubstr("parameter 'speeds' whose length leaves nothing"));
  EXPECT_THAT(list(required, 0, 0), HasSubstr("whose length leaves nothing"));
  EXPECT_THAT(refusal_of({.name = "curve", .kind = ParameterKind::table}), HasSubstr("'curve' without variables"));
  EXPECT_EQ(refusal_of({.name = "curve", .kind = ParameterKind::table, .variables = "speed: m/s"}), "");
  EXPECT_THAT(refusal_of({.name = "curve", .kind = static_cast<ParameterKind>(10)}), HasSubstr("of an unknown kind"));
}

TEST(Registry, TakesRowsOfTheFirstReleaseAndLongerOnes) {
  struct Longer {
    Component known;
    double more[3];
  };
  static Longer rows[2];
  Registry toys;
  toys.add(&toy::publish_toys, "toys");
  rows[0].known = rows[1].known = *toys.find(ComponentKind::joint, "pin");
  rows[1].known.description.name = "second";
  Registry registry;
  registry.add(
      [](const Host* host, Manifest* manifest) noexcept {
        const Status status = publish(*host, *manifest, "longer", "1", {&rows[0].known, 2});
        manifest->component_size = sizeof(Longer);
        return status;
      },
      "longer.so");
  EXPECT_NE(registry.find(ComponentKind::joint, "second"), nullptr);
}

}  // namespace
}  // namespace freeplay
