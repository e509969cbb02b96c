// The law suites find what is wrong with a law, and nothing in one that is right.
#include "contract/law_contract.h"

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>

#include <gtest/gtest.h>

#include "allocation_counter.h"
#include "findings_text.h"

namespace freeplay::test {
namespace {

const Conditions law_conditions{.seed = 1, .allocations = &allocations};

/// A law made of a function.
struct Normal final : ContactLaw {
  using Function = std::function<ContactForce(const ContactState&)>;
  explicit Normal(Function f) : function(std::move(f)) {}
  ContactForce evaluate(const ContactState& s) const override { return function(s); }
  Function function;
};
ContactLawRef ref_of(const Normal& law) { return {abi::contact_law_table<Normal>, &law}; }

/// F = max(0, K delta^2 (1 + delta'/(2 v_0)))
ContactForce sound(const ContactState& s) {
  constexpr double stiffness = 1e9;
  const double x = s.penetration, elastic = stiffness * x * x;
  const double damping = s.approach_speed > 0.0 ? 0.5 / s.approach_speed : 0.0, factor = 1.0 + damping * s.rate;
  const double potential = elastic * x / 3.0;
  if (factor <= 0.0) return {0.0, 0.0, 0.0, potential};
  return {elastic * factor, 2.0 * stiffness * x * factor, elastic * damping, potential};
}

Findings judge(const Normal::Function& function, bool may_jump = false) {
  const Normal law(function);
  return check_contact_law({ref_of(law), ref_of(law), 1e-4, may_jump}, law_conditions);
}
void expect_found(const char* rule, const Normal::Function& function) {
  const Findings findings = judge(function);
  EXPECT_TRUE(findings.broken(rule)) << rule << " is not reported, but\n" << broken_rules(findings);
}
/// The sound law with its answer changed.
Normal::Function with(const std::function<void(ContactForce&, const ContactState&)>& change) {
  return [change](const ContactState& s) {
    ContactForce f = sound(s);
    change(f, s);
    return f;
  };
}

TEST(ContactLawContract, HoldsForASoundLaw) { EXPECT_TRUE(judge(sound).held()) << broken_rules(judge(sound)); }

TEST(ContactLawContract, FindsTension) {
  expect_found("no-tension", [](const ContactState& s) {
    const double damping = s.approach_speed > 0.0 ? 0.8 / s.approach_speed : 0.0;
    const double elastic = 1e9 * s.penetration * s.penetration, factor = 1.0 + damping * s.rate;
    return ContactForce{elastic * factor, 2e9 * s.penetration * factor, elastic * damping,
                        elastic * s.penetration / 3.0};
  });
}

TEST(ContactLawContract, FindsTensionAtFastSeparation) {
  // Below zero from 5 m/s on.
  expect_found("no-tension", [](const ContactState& s) {
    const double rate = s.approach_speed > 0.0 ? s.rate : 0.0, slope = s.approach_speed > 0.0 ? 0.2 : 0.0;
    const double elastic = 1e5 * s.penetration;
    return ContactForce{elastic * (1.0 + 0.2 * rate), 1e5 * (1.0 + 0.2 * rate), elastic * slope,
                        0.5 * elastic * s.penetration};
  });
}

TEST(ContactLawContract, DoesNotJudgeTheRoundingOfStoredEnergy) {
  // F = k c (e^(x/c) - 1), U = k c (c (e^(x/c) - 1) - x): terms of 1e-3 J cancel to 1e-19 J.
  const auto wall = [](const ContactState& s) {
    constexpr double k = 1e5, c = 1e-4;
    const double x = s.penetration, e = std::exp(x / c);
    return ContactForce{k * c * (e - 1.0), k * e, 0.0, k * c * (c * (e - 1.0) - x)};
  };
  EXPECT_TRUE(judge(wall).held()) << broken_rules(judge(wall));
}

TEST(ContactLawContract, FindsAJumpThatTheLawDoesNotDeclare) {
  const auto jumps = [](const ContactState& s) {
    const double damping = s.approach_speed > 0.0 ? 50.0 : 0.0, force = 1e5 * s.penetration + damping * s.rate;
    const double potential = 5e4 * s.penetration * s.penetration;
    if (force <= 0.0) return ContactForce{0.0, 0.0, 0.0, potential};
    return ContactForce{force, 1e5, damping, potential};
  };
  expect_found("continuous", jumps);
  EXPECT_TRUE(judge(jumps, true).held()) << broken_rules(judge(jumps, true));
  expect_found("continuous", with([](ContactForce& f, const ContactState&) { f.normal += 1.0; }));
}

TEST(ContactLawContract, FindsAFallingForce) {
  expect_found("monotone", with([](ContactForce& f, const ContactState& s) {
                 if (s.penetration > 1e-5) f.normal *= 1e-3;
               }));
}

TEST(ContactLawContract, FindsWrongDerivatives) {
  expect_found("derivatives", with([](ContactForce& f, const ContactState&) { f.d_penetration *= 1.001; }));
  expect_found("derivatives", with([](ContactForce& f, const ContactState&) { f.d_rate *= -1.0; }));
}

TEST(ContactLawContract, FindsAWrongPotential) {
  expect_found("potential", with([](ContactForce& f, const ContactState&) { f.potential *= 1.01; }));
  expect_found("elastic-part", with([](ContactForce& f, const ContactState&) { f.elastic = 1.01 * f.normal; }));
  expect_found("potential", with([](ContactForce& f, const ContactState& s) { f.potential *= 1.0 + s.rate; }));
}

TEST(ContactLawContract, FindsDampingWithoutApproach) {
  expect_found("elastic-part", with([](ContactForce& f, const ContactState& s) {
                 if (s.approach_speed == 0.0 && s.rate > 0.0) f.normal *= 1.0 + s.rate;
               }));
}

TEST(ContactLawContract, FindsEnergyThatIsMade) {
  expect_found("passive", with([](ContactForce& f, const ContactState& s) {
                 if (s.approach_speed > 0.0 && s.rate < 0.0) f.normal = 4.0 * sound({s.penetration, 0.0, 0.0}).normal;
               }));
}

TEST(ContactLawContract, FindsHiddenStateAndTwinsThatDiffer) {
  const auto calls = std::make_shared<int>(0);
  expect_found("no-hidden-state", with([calls](ContactForce& f, const ContactState&) { f.normal += 1e-9 * ++*calls; }));
  const Normal law(sound), other(with([](ContactForce&f, const ContactState&) { f.d_rate += 1e-12; }));
  EXPECT_TRUE(check_contact_law({ref_of(law), ref_of(other), 1e-4, false}, law_conditions).broken("same-twin"));
}

TEST(ContactLawContract, FindsWrongCalls) {
  expect_found("finite", with([](ContactForce& f, const ContactState& s) {
                 if (s.approach_speed == 0.0) f.d_rate = std::numeric_limits<double>::quiet_NaN();
               }));
  expect_found("answers", with([](ContactForce&, const ContactState& s) {
                 if (s.rate < -0.5) throw std::runtime_error("too fast");
               }));
  expect_found("allocation", with([](ContactForce&, const ContactState&) { ::operator delete(::operator new(8)); }));
}

struct Tangential final : FrictionLaw {
  using Function = std::function<FrictionForce(const FrictionState&, Span<double>)>;
  Tangential(Function f, int variables) : function(std::move(f)), count(variables) {}
  int internal_variables() const override { return count; }
  FrictionForce evaluate(const FrictionState& s, Span<double> rate) const override { return function(s, rate); }
  Function function;
  int count;
};
FrictionLawRef ref_of(const Tangential& law) { return {abi::friction_law_table<Tangential>, &law}; }

/// -F_N atan(v/v_s)/4
FrictionForce smooth(const FrictionState& s, Span<double>) {
  const double u = s.slip_speed / 0.01;
  return {-0.25 * std::atan(u) * s.normal_force, -0.25 * std::atan(u), -25.0 / (1.0 + u * u) * s.normal_force};
}
/// -F_N s_0 z, z' = v - s_0 |v| z/mu
FrictionForce bristle(const FrictionState& s, Span<double> rate) {
  rate[0] = s.slip_speed - 1e5 / 0.3 * std::abs(s.slip_speed) * s.internal[0];
  return {-1e5 * s.internal[0] * s.normal_force, -1e5 * s.internal[0], 0.0};
}

Findings judge(const Tangential::Function& function, int variables = 0) {
  const Tangential law(function, variables);
  return check_friction_law({ref_of(law), ref_of(law)}, law_conditions);
}
void expect_slip_found(const char* rule, const std::function<void(FrictionForce&, const FrictionState&)>& change) {
  const Findings findings = judge([change](const FrictionState& s, Span<double> rate) {
    FrictionForce f = smooth(s, rate);
    change(f, s);
    return f;
  });
  EXPECT_TRUE(findings.broken(rule)) << rule << " is not reported, but\n" << broken_rules(findings);
}

TEST(FrictionLawContract, HoldsForSoundLaws) {
  EXPECT_TRUE(judge(smooth).held()) << broken_rules(judge(smooth));
  EXPECT_TRUE(judge(bristle, 1).held()) << broken_rules(judge(bristle, 1));
}

TEST(FrictionLawContract, FindsForcesThatPush) {
  expect_slip_found("opposes-slip", [](FrictionForce& f, const FrictionState&) { f.tangential *= -1.0; });
  expect_slip_found("passive", [](FrictionForce& f, const FrictionState&) { f.tangential *= -1.0; });
  const auto pushes = [](const FrictionState& s, Span<double> rate) {
    FrictionForce f = bristle(s, rate);
    return FrictionForce{-f.tangential, -f.d_normal, 0.0};
  };
  EXPECT_TRUE(judge(pushes, 1).broken("opposes-slip"));
  EXPECT_TRUE(judge(pushes, 1).broken("passive"));
}

TEST(FrictionLawContract, FindsAPushAtHighSpeed) {
  for (const double from : {8.0, 28.0}) {
    expect_slip_found("opposes-slip", [from](FrictionForce& f, const FrictionState& s) {
      if (std::abs(s.slip_speed) > from) f = {-f.tangential, -f.d_normal, -f.d_slip};
    });
  }
}

TEST(FrictionLawContract, LetsFrictionDependOnTheDirection) {
  const auto sided = [](const FrictionState& s, Span<double> rate) {
    const double more = s.slip_speed > 0.0 ? 1.5 : 1.0;
    const FrictionForce f = smooth(s, rate);
    return FrictionForce{more * f.tangential, more * f.d_normal, more * f.d_slip};
  };
  EXPECT_TRUE(judge(sided).held()) << broken_rules(judge(sided));
}

TEST(FrictionLawContract, FindsFrictionWithoutLoad) {
  expect_slip_found("unloaded", [](FrictionForce& f, const FrictionState& s) { f.tangential -= s.slip_speed; });
}

TEST(FrictionLawContract, FindsWrongDerivatives) {
  expect_slip_found("derivatives", [](FrictionForce& f, const FrictionState&) { f.d_slip *= 1.001; });
  expect_slip_found("derivatives", [](FrictionForce& f, const FrictionState&) { f.d_normal *= 1.001; });
}

TEST(FrictionLawContract, FindsHiddenStateAndTwinsThatDiffer) {
  const auto last = std::make_shared<double>(0.0);
  expect_slip_found("no-hidden-state", [last](FrictionForce& f, const FrictionState& s) {
    f.tangential += 1e-9 * *last;
    *last = s.slip_speed;
  });
  const Tangential law(smooth, 0), other([](const FrictionState&, Span<double>) { return FrictionForce{}; }, 0);
  EXPECT_TRUE(check_friction_law({ref_of(law), ref_of(other)}, law_conditions).broken("same-twin"));
}

/// bristle(), whose memory starts and is reset and stores as the members say.
struct Remembering final : FrictionLaw {
  int internal_variables() const override { return 1; }
  FrictionForce evaluate(const FrictionState& s, Span<double> rate) const override { return bristle(s, rate); }
  void memory(Span<double> start, Span<MemoryReset> resets) const override {
    start[0] = starts_with;
    resets[0] = reset;
    if (writes_beside) start.data[1] = 0.0;
  }
  double stored(Span<const double> z, Span<double> slopes) const override {
    slopes[0] = slope * z[0];
    return 50.0 * (z[0] * z[0] - zero * zero);
  }
  double starts_with = 0.0, zero = 0.0, slope = 100.0;
  MemoryReset reset = MemoryReset::each_contact;
  bool writes_beside = false;
};
Findings judge_memory(const std::function<void(Remembering&)>& change) {
  Remembering law;
  change(law);
  const FrictionLawRef given{abi::friction_law_table<Remembering>, &law};
  return check_friction_law({given, given}, law_conditions);
}

TEST(FrictionLawContract, HoldsForSoundMemory) {
  const Findings sound = judge_memory([](Remembering&) {});
  EXPECT_TRUE(sound.held()) << broken_rules(sound);
  const Findings started = judge_memory([](Remembering& law) { law.starts_with = law.zero = 1e-6; });
  EXPECT_TRUE(started.held()) << broken_rules(started);
}

TEST(FrictionLawContract, FindsWrongMemory) {
  const auto expect_memory = [](const char* rule, const std::function<void(Remembering&)>& change) {
    const Findings findings = judge_memory(change);
    EXPECT_TRUE(findings.broken(rule)) << rule << " is not reported, but\n" << broken_rules(findings);
  };
  expect_memory("memory", [](Remembering& law) { law.starts_with = std::numeric_limits<double>::infinity(); });
  expect_memory("memory", [](Remembering& law) { law.reset = static_cast<MemoryReset>(7); });
  expect_memory("stays-in-span", [](Remembering& law) { law.writes_beside = true; });
  expect_memory("stored-energy", [](Remembering& law) { law.slope = 101.0; });
  expect_memory("stored-energy", [](Remembering& law) { law.starts_with = 1e-6; });
  expect_memory("stored-energy", [](Remembering& law) { law.reset = MemoryReset::never; });
}

TEST(FrictionLawContract, FindsWrongCalls) {
  expect_slip_found("finite",
                    [](FrictionForce& f, const FrictionState& s) { f.d_slip /= s.normal_force > 0.0 ? 1.0 : 0.0; });
  expect_slip_found("answers", [](FrictionForce&, const FrictionState& s) {
    if (s.normal_force > 500.0) throw std::runtime_error("too much");
  });
  expect_slip_found("allocation", [](FrictionForce&, const FrictionState&) { ::operator delete(::operator new(8)); });
  const auto beside = [](const FrictionState& s, Span<double> rate) {
    rate.data[1] = 0.0;
    return bristle(s, rate);
  };
  EXPECT_TRUE(judge(beside, 1).broken("stays-in-span"));
}

}  // namespace
}  // namespace freeplay::test
