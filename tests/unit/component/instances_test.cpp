#include "component/instances.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

int living = 0;

struct Counted {
  Counted() { ++living; }
  ~Counted() { --living; }
  Counted(const Counted&) = delete;
};

class Law final : public ContactLaw, Counted {
 public:
  Law(const Parameters& p, const ContactPair& pair) : k_(p.number("K") * pair.length) {
    if (p.word("mood") == 1) throw BadParameter("K", "out-of-range", "too soft");
  }
  ContactForce evaluate(const ContactState&) const override { return {k_, 0, 0, 0}; }

 private:
  double k_;
};

class Bearing final : public Joint, Counted {
 public:
  explicit Bearing(const Parameters& p) : law_(p.contact_law("block.law", pair(p))) {
    if (p.given("typo")) p.number("nonsense");
  }
  static ContactPair pair(const Parameters& p) {
    ContactPair pair{};
    pair.length = p.vector("size")[1];
    return pair;
  }
  void declare(JointLayout& layout) const override { layout.clearance = law_.evaluate({}).normal; }

 private:
  ContactLawRef law_;
};

const Component law_component = contact_law<Law>({.name = "law"});
const Component host_component = joint<Bearing>({.name = "host"});

ParameterBlock block(int mood, bool typo = false) {
  auto law = std::make_shared<ParameterBlock>();
  law->component = &law_component;
  law->values["K"].number = 3.0;
  law->values["mood"].word = mood;
  ParameterBlock host;
  host.component = &host_component;
  host.values["block.law"].law = law;
  host.values["size"].vector = {1.0, 2.0, 0.0};
  host.values["typo"].given = typo;
  return host;
}

TEST(Instances, ServeParametersAndCreateLawsForAJoint) {
  {
    Instances instances;
    CreationFault fault;
    const JointRef joint = instances.create_joint(block(0), Space::planar, fault);
    ASSERT_TRUE(joint) << fault.text;
    JointLayout layout;
    Message message;
    ASSERT_TRUE(joint.declare(layout, message));
    EXPECT_DOUBLE_EQ(layout.clearance, 6.0);
    EXPECT_EQ(living, 2);
    const Instances moved = std::move(instances);
    EXPECT_TRUE(joint.declare(layout, message));
  }
  EXPECT_EQ(living, 0);
}

TEST(Instances, ComposeThePathOfALawsFault) {
  Instances instances;
  CreationFault fault;
  EXPECT_FALSE(instances.create_joint(block(1), Space::planar, fault));
  EXPECT_TRUE(fault.bad_parameter);
  EXPECT_EQ(fault.path, "block.law.K");
  EXPECT_EQ(fault.id, "out-of-range");
  EXPECT_EQ(fault.text, "too soft");
}

TEST(Instances, NameAPluginInItsOwnFailure) {
  Instances instances;
  CreationFault fault;
  EXPECT_FALSE(instances.create_joint(block(0, true), Space::planar, fault));
  EXPECT_FALSE(fault.bad_parameter);
  EXPECT_EQ(fault.id, "plugin-failed");
  EXPECT_NE(fault.text.find("nonsense"), std::string::npos);
}

double seen_face_length = 0.0;
SurfaceShape seen_shape{};

class Looking final : public ContactLaw {
 public:
  Looking(const Parameters&, const ContactPair& pair) {
    seen_face_length = pair.face_length;
    seen_shape = pair.bearing_shape;
  }
  ContactForce evaluate(const ContactState&) const override { return {}; }
};
class AtWall final : public Joint {
 public:
  explicit AtWall(const Parameters& p) {
    ContactPair pair{1.0, 2.0, 3.0, 4.0, {5.0, 6.0}, {7.0, 8.0}};
    pair.bearing_shape = SurfaceShape::plane;
    pair.face_length = 9.0;
    p.contact_law("law", pair);
  }
  void declare(JointLayout&) const override {}
};

// A joint of a library that was built when a pair had fewer fields fills no others: what comes after it is not its.
TEST(Instances, GiveALawTheFieldsOfAPairThatTheJointsLibraryKnows) {
  static Component rows[] = {joint<AtWall>({.name = "at-wall"}), contact_law<Looking>({.name = "looking"})};
  const auto look = [](PluginEntry entry) {
    Registry registry;
    registry.add(entry, "lib.so");
    Instances instances;
    instances.keep(registry.libraries().front());
    auto law = std::make_shared<ParameterBlock>();
    law->component = registry.find(ComponentKind::contact_law, "looking");
    ParameterBlock wall;
    wall.component = registry.find(ComponentKind::joint, "at-wall");
    wall.values["law"].law = law;
    CreationFault fault;
    instances.create_joint(wall, Space::planar, fault);
    EXPECT_EQ(fault.text, "");
  };
  look([](const Host* host, Manifest* manifest) noexcept { return publish(*host, *manifest, "new", "1", rows); });
  EXPECT_EQ(seen_shape, SurfaceShape::plane);
  EXPECT_EQ(seen_face_length, 9.0);
  look([](const Host* host, Manifest* manifest) noexcept {
    static std::vector<std::uint32_t> sizes;
    const Status status = publish(*host, *manifest, "old", "1", rows);
    sizes.assign(manifest->struct_sizes.begin(), manifest->struct_sizes.end());
    sizes[3] = 64;  // of the first release
    manifest->struct_sizes = {sizes.data(), sizes.size()};
    return status;
  });
  EXPECT_EQ(seen_shape, SurfaceShape::unknown);
  EXPECT_TRUE(std::isnan(seen_face_length));
}

TEST(Instances, KeepTheFunctionsOfTimeAlive) {
  const auto owner = std::make_shared<const int>(1);
  ParameterBlock host = block(0);
  host.values["function"].function_owner = owner;
  {
    Instances instances;
    CreationFault fault;
    instances.create_joint(host, Space::planar, fault);
    host = {};
    EXPECT_EQ(owner.use_count(), 2);
  }
  EXPECT_EQ(owner.use_count(), 1);
}

}  // namespace
}  // namespace freeplay
