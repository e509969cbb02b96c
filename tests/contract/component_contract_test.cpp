// Descriptions, sample parameters and the whole of a component's contract.
#include "contract/component_contract.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "contract/description_contract.h"
#include "contract/sample_parameters.h"
#include "findings_text.h"

namespace freeplay::test {
namespace {

/// Needs `wide` above `narrow`, either `hardness` or both `young` and `poisson`, and no more than that.
class Picky final : public FrictionLaw {
 public:
  explicit Picky(const Parameters& p) {
    if (!(p.number("wide") > p.number("narrow"))) throw BadParameter("wide", "out-of-range", "must be above 'narrow'");
    const bool young = p.given("young"), poisson = p.given("poisson");
    if (p.given("hardness") == (young || poisson)) throw BadParameter("", "missing-key", "give one or the other");
    if (young != poisson) throw BadParameter("", "missing-key", "give both");
    if (std::isnan(p.number("share")) == (p.word("share") < 0)) throw std::logic_error("neither number nor word");
  }
  FrictionForce evaluate(const FrictionState&, Span<double>) const override { return {}; }
};
constexpr Parameter picky_parameters[] = {
    {.name = "wide", .unit = "m/s", .minimum = 0.0, .open = Open::minimum, .summary = "Above."},
    {.name = "narrow", .unit = "m/s", .minimum = 0.0, .open = Open::minimum, .summary = "Below."},
    {.name = "hardness", .unit = "N/m^power", .default_value = optional, .summary = "One way."},
    {.name = "power", .default_value = 1.5, .minimum = 1.0, .maximum = 2.0, .summary = "Of the unit."},
    {.name = "young", .unit = "Pa", .default_value = optional, .minimum = 0.0, .summary = "Other way."},
    {.name = "poisson", .default_value = optional, .minimum = 0.0, .maximum = 0.5, .summary = "With it."},
    {.name = "share",
     .default_value = 0.5,
     .minimum = 0.0,
     .maximum = 1.0,
     .open = Open::both,
     .choices = "half|most",
     .summary = "A number or a word."},
};

class Never final : public FrictionLaw {
 public:
  explicit Never(const Parameters&) { throw BadParameter("mu", "out-of-range", "I like no number"); }
  FrictionForce evaluate(const FrictionState&, Span<double>) const override { return {}; }
};

/// Feeds energy by `push`, which is zero unless the file says otherwise, or by the second word of `way`.
class Feeds final : public FrictionLaw {
 public:
  explicit Feeds(const Parameters& p)
      : push_(p.number("push")), turned_(p.word("way") == 1 && p.number("share") < 0.5) {}
  FrictionForce evaluate(const FrictionState& s, Span<double>) const override {
    const double mu = turned_ ? -0.1 : 0.1, u = std::tanh(s.slip_speed / 0.01);
    return {-mu * s.normal_force * u + push_ * s.slip_speed, -mu * u,
            -mu * s.normal_force * (1.0 - u * u) / 0.01 + push_};
  }

 private:
  double push_;
  bool turned_;
};
constexpr Parameter feeds_parameters[] = {
    {.name = "push", .unit = "N*s/m", .default_value = 0.0, .minimum = 0.0, .summary = "Wrong sign."},
    {.name = "share", .default_value = 1.0, .minimum = 0.0, .maximum = 1.0, .summary = "Chooses."},
    {.name = "way", .kind = ParameterKind::choice, .default_value = 0.0, .choices = "right|wrong", .summary = "Sign."}};

/// Another law times a factor.
class Scaled final : public ContactLaw {
 public:
  Scaled(const Parameters& p, const ContactPair& pair)
      : base_(p.contact_law("base", pair)), factor_(p.number("factor")) {}
  ContactForce evaluate(const ContactState& s) const override {
    const ContactForce f = base_.evaluate(s);
    return {factor_ * f.normal, factor_ * f.d_penetration, factor_ * f.d_rate, factor_ * f.potential};
  }

 private:
  ContactLawRef base_;
  double factor_;
};
constexpr Parameter scaled_parameters[] = {
    {.name = "base", .kind = ParameterKind::contact_law, .summary = "What is scaled."},
    {.name = "factor", .default_value = 1.0, .minimum = 0.0, .open = Open::minimum, .summary = "Times."}};

/// A joint whose columns are those of `channels`.
template <const char* const& name>
class Shows final : public Joint {
 public:
  explicit Shows(const Parameters&) {}
  void declare(JointLayout& layout) const override {
    static const Channel channels[] = {{name, "N"}};
    layout.forces = 1;
    layout.coordinate = Coordinate::angle;
    layout.channels = channels;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    const double *a = in.a->rotation, *b = in.b->rotation;
    row.value = std::atan2(a[0] * b[3] - a[3] * b[0], a[0] * b[0] + a[3] * b[3]);
    row.jacobian[5] = -1.0;
    row.jacobian[11] = 1.0;
  }
};
constexpr const char *fx = "fx", *speed = "speed", *angle = "angle", *power = "power", *position = "position";

Status publish_samples(const Host* host, Manifest* manifest) noexcept {
  static const Component components[] = {
      friction_law<Picky>({.name = "picky", .summary = "Hard to please.", .parameters = picky_parameters}),
      friction_law<Never>({.name = "never", .summary = "Impossible to please."}),
      friction_law<Feeds>({.name = "feeds", .summary = "Pushes.", .parameters = feeds_parameters}),
      contact_law<Scaled>({.name = "scaled", .summary = "Another law.", .parameters = scaled_parameters}),
      contact_law<Scaled>({.name = "scaled-too", .summary = "Another law.", .parameters = scaled_parameters}),
      joint<Shows<fx>>({.name = "shows-fx", .space = Space::planar, .summary = "Shows."}),
      joint<Shows<speed>>({.name = "shows-speed", .space = Space::planar, .summary = "Shows."}),
      joint<Shows<angle>>({.name = "shows-angle", .space = Space::planar, .summary = "Shows."}),
      joint<Shows<power>>({.name = "shows-power", .space = Space::planar, .summary = "Shows."}),
      joint<Shows<position>>({.name = "shows-position", .space = Space::planar, .summary = "Shows."})};
  return publish(*host, *manifest, "samples", "1", components);
}
Registry samples() {
  Registry registry;
  registry.add(publish_samples, "samples");
  return registry;
}

TEST(SampleParameters, AreFoundForAPickyConstructor) {
  const Registry registry = samples();
  const ParameterSamples found = sample_parameters(*registry.find(ComponentKind::friction_law, "picky"), registry);
  ASSERT_FALSE(found.accepted.empty()) << found.refusal;
  const auto& few = found.accepted[0].block->values;
  EXPECT_GT(few.at("wide").number, few.at("narrow").number);
  EXPECT_TRUE(few.at("hardness").given);
  EXPECT_FALSE(few.at("young").given);
  // Both words, and both ends of the one range that has ends.
  int words = 0, ends = 0;
  for (const ParameterSample& sample : found.accepted) {
    const auto& values = sample.block->values;
    if (values.at("share").word >= 0) ++words;
    if (values.at("power").number == 1.0 || values.at("power").number == 2.0) ++ends;
  }
  EXPECT_EQ(words, 2);
  EXPECT_EQ(ends, 2);
}

TEST(SampleParameters, VaryWhatHasADefault) {
  const Registry registry = samples();
  const ParameterSamples found = sample_parameters(*registry.find(ComponentKind::friction_law, "feeds"), registry);
  const auto values = [&](const std::string& name) {
    const auto sample = std::ranges::find(found.accepted, name, &ParameterSample::name);
    EXPECT_NE(sample, found.accepted.end()) << name;
    return sample != found.accepted.end() ? sample->block->values : decltype(sample->block->values)();
  };
  const auto few = values("as few as possible"), many = values("as many as possible"), all = values("everything given");
  EXPECT_EQ(few.at("push").number, 0.0);
  EXPECT_EQ(few.at("share").number, 1.0);
  EXPECT_GT(many.at("push").number, 0.0);
  EXPECT_LT(many.at("share").number, 1.0);
  EXPECT_TRUE(many.at("push").given);
  EXPECT_EQ(many.at("way").word, 0);
  EXPECT_EQ(all.at("way").word, 1);
  EXPECT_GT(all.at("push").number, 0.0);
}

TEST(SampleParameters, OfALawThatAsksForALawComeToAnEnd) {
  Registry registry = Registry::with_builtins();
  registry.add(publish_samples, "samples");
  const Component& scaled = *registry.find(ComponentKind::contact_law, "scaled");
  const ParameterSamples found = sample_parameters(scaled, registry);
  EXPECT_GE(found.accepted.size(), registry.names(ComponentKind::contact_law).size() - 1);
  for (const ParameterSample& sample : found.accepted) {
    EXPECT_NE(sample.block->values.at("base").law->component, &scaled) << sample.name;
  }
  const Findings findings = check_component(scaled, registry, {});
  EXPECT_TRUE(findings.held()) << broken_rules(findings);
}

TEST(ComponentContract, FindsFaultsThatADefaultHides) {
  const Registry registry = samples();
  const Findings findings = check_component(*registry.find(ComponentKind::friction_law, "feeds"), registry, {});
  EXPECT_TRUE(findings.broken("opposes-slip")) << broken_rules(findings);
}

TEST(ComponentContract, FindsChannelsThatRepeatAColumn) {
  const Registry registry = samples();
  const auto judge = [&](const char* name) {
    return check_component(*registry.find(ComponentKind::joint, name), registry, {});
  };
  for (const char* name : {"shows-fx", "shows-speed", "shows-angle", "shows-power"}) {
    EXPECT_TRUE(judge(name).broken("channel-names")) << name;
  }
  EXPECT_TRUE(judge("shows-position").held()) << broken_rules(judge("shows-position"));
}

TEST(SampleParameters, StayWithinBoundsLong) {
  const Registry registry = Registry::with_builtins();
  for (const RegisteredComponent& entry : registry.components()) {
    const ParameterSamples found = sample_parameters(*entry.component, registry);
    EXPECT_FALSE(found.accepted.empty()) << entry.component->description.name << ": " << found.refusal;
    for (const ParameterSample& sample : found.accepted) {
      for (const Parameter& p : entry.component->description.parameters) {
        const ParameterValue& value = sample.block->values.at(p.name);
        const double number = value.number;
        if (p.kind == ParameterKind::vector && value.given && p.minimum == 0.0) {
          for (const double one : value.vector)
            EXPECT_GT(one, 0.0) << entry.component->description.name << " " << p.name;
        }
        if (p.kind != ParameterKind::number || std::string_view(p.unit) != "1" || std::isnan(number)) continue;
        EXPECT_GE(number, p.minimum) << entry.component->description.name << " " << p.name;
        EXPECT_LE(number, p.maximum) << entry.component->description.name << " " << p.name;
      }
    }
  }
}

TEST(ComponentContract, FindsAConstructorThatRefusesEverything) {
  const Registry registry = samples();
  const Findings findings = check_component(*registry.find(ComponentKind::friction_law, "never"), registry, {});
  EXPECT_TRUE(findings.broken("accepts-parameters"));
  EXPECT_NE(broken_rules(findings).find("I like no number"), std::string::npos);
}

Findings describe(const Description& description) { return check_description(friction_law<Never>(description)); }
Findings describe_with(const Parameter& parameter) {
  return describe(Description{.name = "some-law", .summary = "Some.", .parameters = {&parameter, 1}});
}

TEST(DescriptionContract, FindsWrongNames) {
  EXPECT_TRUE(describe({.name = "some-law2", .summary = "Some."}).held());
  for (const char* name : {"", "Some-law", "some_law", "-law", "law-", "some--law"}) {
    EXPECT_TRUE(describe({.name = name, .summary = "Some."}).broken("name")) << name;
  }
  EXPECT_TRUE(describe({.name = "law"}).broken("summary"));
}

TEST(DescriptionContract, FindsWrongParameters) {
  const Parameter good{
      .name = "block.share_of_E", .default_value = 0.5, .minimum = 0.0, .maximum = 1.0, .summary = "S."};
  EXPECT_TRUE(describe_with(good).held()) << broken_rules(describe_with(good));
  const auto with = [&](auto change) {
    Parameter changed = good;
    change(changed);
    return describe_with(changed);
  };
  EXPECT_TRUE(with([](Parameter& p) { p.name = "block..share"; }).broken("parameter-names"));
  EXPECT_TRUE(with([](Parameter& p) { p.name = "a-b"; }).broken("parameter-names"));
  EXPECT_TRUE(with([](Parameter& p) { p.summary = ""; }).broken("summary"));
  EXPECT_TRUE(with([](Parameter& p) { p.unit = "furlong"; }).broken("parameter-units"));
  EXPECT_TRUE(with([](Parameter& p) { p.unit = "N/m^nothing"; }).broken("parameter-units"));
  EXPECT_TRUE(with([](Parameter& p) { p.minimum = 2.0; }).broken("parameter-bounds"));
  EXPECT_TRUE(with([](Parameter& p) { p.default_value = 1.5; }).broken("parameter-defaults"));
  EXPECT_TRUE(with([](Parameter& p) { p.default_value = 1.0, p.open = Open::maximum; }).broken("parameter-defaults"));
  EXPECT_TRUE(with([](Parameter& p) { p.kind = ParameterKind::integer; }).broken("parameter-defaults"));
  const auto choice = [&](const char* words, double index) {
    return with([&](Parameter& p) { p.kind = ParameterKind::choice, p.choices = words, p.default_value = index; });
  };
  EXPECT_TRUE(choice("one|two", 1.0).held());
  EXPECT_TRUE(choice("one|two", 2.0).broken("parameter-defaults"));
  EXPECT_TRUE(choice("one|one", 0.0).broken("parameter-choices"));
  EXPECT_TRUE(choice(nullptr, 0.0).broken("parameter-choices"));
  const auto units = [&](const char* unit) {
    const Parameter table[] = {
        good,
        {.name = "kind", .kind = ParameterKind::choice, .default_value = 0.0, .choices = "shift|turn", .summary = "S."},
        {.name = "length", .unit = "m", .default_value = 1.0, .summary = "S."},
        {.name = "power", .default_value = 1.0, .summary = "S."},
        {.name = "stiffness", .unit = unit, .default_value = 1.0, .summary = "S."}};
    return describe({.name = "law", .summary = "Some.", .parameters = table});
  };
  for (const char* unit : {"kind: N/m | N*m/rad", "kind: N/m^power | N", "N/m^power"}) {
    EXPECT_TRUE(units(unit).held()) << broken_rules(units(unit));
  }
  for (const char* unit : {"kind: N/m | furlong", "kind: furlong | N/m", "kind: N/m", "kind: N | N | N", "power: N | m",
                           "other: N | m", "N/m^length", "N/m^kind", "kind: N/m | N/m^nothing"}) {
    EXPECT_TRUE(units(unit).broken("parameter-units")) << unit;
  }
  const Parameter twice[] = {good, good};
  EXPECT_TRUE(describe({.name = "law", .summary = "Some.", .parameters = twice}).broken("parameter-names"));
}

TEST(DescriptionContract, FindsParametersThatCannotBeGiven) {
  const auto names = [](auto make, const char* name) {
    const Parameter table[] = {{.name = name, .default_value = 1.0, .summary = "S."}};
    return check_description(make(Description{.name = "some-type",
                                              .space = Space::planar,
                                              .summary = "S.",
                                              .parameters = table,
                                              .first_end = "frame",
                                              .second_end = "slider"}))
        .broken("parameter-names");
  };
  for (const char* name : {"type", "between", "use", "use.more", "frame", "slider"}) {
    EXPECT_TRUE(names(joint<Shows<fx>>, name)) << name;
  }
  for (const char* name : {"law", "types", "user"}) EXPECT_FALSE(names(joint<Shows<fx>>, name)) << name;
  EXPECT_TRUE(names(contact_law<Scaled>, "law"));
  EXPECT_FALSE(names(contact_law<Scaled>, "type"));
}

TEST(DescriptionContract, FindsAnUnknownSpace) {
  const auto of = [](std::uint32_t space) {
    return check_description(
        joint<Shows<fx>>({.name = "some-joint", .space = static_cast<Space>(space), .summary = "S."}));
  };
  for (const std::uint32_t space : {1u, 2u, 3u}) EXPECT_TRUE(of(space).held()) << space;
  for (const std::uint32_t space : {0u, 4u, 7u}) EXPECT_TRUE(of(space).broken("space")) << space;
}

Findings check_names(Span<const Event> events, Span<const Channel> channels) {
  JointLayout layout;
  layout.events = events;
  layout.channels = channels;
  return check_joint_names(layout);
}

TEST(DescriptionContract, FindsWrongNamesOfEventsAndChannels) {
  constexpr Channel good[] = {{"depth", "m"}, {"max_fn", "N"}}, twice[] = {{"depth", "m"}, {"depth", "m"}},
                    capital[] = {{"Depth", "m"}}, unit[] = {{"depth", "furlong"}};
  const Event event[] = {{"touch", Crossing::rising, 0, good}}, blank[] = {{"", Crossing::rising, 0, {}}};
  EXPECT_TRUE(check_names(event, good).held());
  EXPECT_TRUE(check_names({}, twice).broken("channel-names"));
  EXPECT_TRUE(check_names({}, capital).broken("channel-names"));
  EXPECT_TRUE(check_names({}, unit).broken("channel-units"));
  EXPECT_TRUE(check_names(blank, {}).broken("event-names"));
}

}  // namespace
}  // namespace freeplay::test
