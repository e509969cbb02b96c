#include "run_model.h"

namespace freeplay::test {
namespace {

using Pair = std::array<double, 2>;

/// One instant of an ideal mechanism. Absolute coordinates with driver constraints, checked by virtual work and by the
/// power balance, independent program; torques of least norm where the drive is redundant.
struct Instant {
  const char* name;
  int legs;
  double time;
  const char* gravity;
  const char* angle;  ///< of the platform on its path
  std::vector<double> crank, torque;
  std::vector<Pair> at_a, at_b, at_c;  ///< forces on crank, coupler, platform [N]
  double power, kinetic_energy;
};

const std::vector<Instant>& instants() {
  static const char turning[] = "0.1*sin(2*2*pi*t/$T)";
  static const std::vector<Instant> all = {
      {"3-RRR at the start",
       3,
       0.0,
       "[0, 0]",
       "0",
       {1.2492592361438, -2.73824970993573, -0.489219141321088},
       {1.84637865681677, -0.294692908358901, -1.48045747299861},
       {{-7.56431885547628, 2.59529718748505},
        {0.423429251310153, 1.43439050233064},
        {-4.57031920048196, -4.88241638882777}},
       {{-6.67845099188862, 2.3322637724817},
        {0.0354651288870981, 1.51622769428969},
        {-4.02608541240121, -4.1764640433145}},
       {{-5.35732313891764, 2.16786788810461},
        {0.560447990601393, 1.56737593926411},
        {-2.91847885662203, -3.7352438273687}},
       -0.418777850596666,
       0.320345968941305},
      {"3-RRR after an eighth of a turn",
       3,
       0.0625,
       "[0, 0]",
       "0",
       {1.34978435452571, -2.89298169117157, -0.427256589245659},
       {0.65631927162719, 1.10299480194977, -1.79006605225009},
       {{-2.95588024811296, 0.187432038393693},
        {0.0614222808498197, -5.04422471843012},
        {-5.72320999925297, -6.1872492221122}},
       {{-2.35041166009261, 0.23978501396564},
        {-0.287717611701351, -4.16473321799704},
        {-5.03550214710511, -4.68190395934172}},
       {{-1.42931731241597, 0.815182103862027},
        {0.03674643561809, -3.07237455006245},
        {-4.06300825934878, -3.19838668994625}},
       -0.112190426856768,
       0.287884099829404},
      {"3-RRR under gravity",
       3,
       0.1,
       "[0, -9.81]",
       "0",
       {1.44151991172159, -2.94258677289534, -0.467040814318929},
       {0.881578769123124, -0.859643428608128, 0.121306137935927},
       {{-3.43096375856385, 4.03135220801853},
        {0.230195944873942, 4.89425691567997},
        {-1.06314199181068, 2.10734315555285}},
       {{-3.24113836708812, 1.21037514195443},
        {0.00940760498778381, 2.807794490854},
        {-0.313250214731621, 0.261283985827379}},
       {{-2.88533917949268, 0.177162726440517},
        {0.108573210482045, 2.23365372611391},
        {0.392590463865899, -0.162604744474894}},
       2.7840873848,
       0.300163049469177},
      {"3-RRR with a turning platform",
       3,
       0.17,
       "[0, 0]",
       turning,
       {1.63862984185273, -2.90642767867959, -0.612695855723117},
       {-2.30978978589854, 1.18200224056272, -1.14369299309532},
       {{10.2553090503057, -1.99815896178464},
        {1.34976911065854, -4.79892359478881},
        {-4.70571582972701, -2.80562073534784}},
       {{8.80909767329439, -1.90299237406788},
        {1.25346501237806, -4.64578024519262},
        {-4.1057180910352, -2.34965398879956}},
       {{7.22640203535109, -0.646001423272085},
        {0.439941556741866, -4.40857686052431},
        {-3.5322501834985, -1.45971055770685}},
       -0.948237520213933,
       0.322587893024787},
      {"4-RRR at the start",
       4,
       0.0,
       "[0, 0]",
       "0",
       {1.49771295992503, -3.0593708537901, -1.21265475264311, 0.143400878301351},
       {1.31968870833047, 0.415943126735528, -1.73128951141926, 0.000243830323190142},
       {{-5.77982426986968, 0.693512338134828},
        {-0.221196747115923, -1.95598528983526},
        {-8.15215026099153, -0.350360184957593},
        {-0.622818758665273, -0.0548182973407445}},
       {{-4.81964839542568, 0.628478898685238},
        {-0.543982775011026, -1.37782833223219},
        {-6.6014275319305, 0.227796772645467},
        {-0.355057931943328, -0.119851736790326}},
       {{-3.45207803566947, 0.587832999029239},
        {0.0217363957832452, -1.01648023373028},
        {-4.86476538803865, 0.589144871147374},
        {0.579753022986593, -0.160497636446321}},
       -0.22028453357941,
       0.339881007137127},
      {"4-RRR after an eighth of a turn",
       4,
       0.0625,
       "[0, 0]",
       "0",
       {1.56906021219525, 3.09630125271559, -1.30899693899575, 0.296179022076359},
       {0.928924841440936, 1.28047582453844, -0.986073075643274, -1.22792659931496},
       {{-4.11501700912155, -0.363443561485342},
        {-1.38620099287498, -5.60072813414334},
        {-4.74331499586026, 0.73978119862018},
        {0.171506483310779, -5.59898849575493}},
       {{-3.37291393330989, -0.237264269034748},
        {-1.40193371742245, -4.61809347727682},
        {-3.84964600760104, 0.714394578623221},
        {0.0571541947065426, -4.71497340294519}},
       {{-2.36642303076367, 0.384274268910794},
        {-0.869090190100698, -3.46127033657133},
        {-2.7484264097751, 1.24120442128904},
        {0.528360494492814, -3.61978748977518}},
       0.221465036090136,
       0.347052209155199},
      {"4-RRR under gravity",
       4,
       0.1,
       "[0, -9.81]",
       "0",
       {1.65052717696365, 3.06726603118428, -1.41691736572655, 0.35065071049716},
       {0.32523220314988, -0.390737661796615, -0.381990663485002, 0.685910151281769},
       {{-1.64067673082654, 3.34623080271317},
        {-0.0787182658892023, 2.839562277854},
        {-2.10623987765521, 5.0083722261355},
        {0.644127401869677, 4.29784058406254}},
       {{-1.24800518263279, 0.549520885295471},
        {-0.00848297464012951, 0.770337451988289},
        {-2.18830416065506, 1.61122280135537},
        {0.170176350450743, 2.6142249454859}},
       {{-0.765427147088576, -0.468524562314436},
        {0.272572400313658, 0.20697018659837},
        {-2.00243601960685, 0.217902661643936},
        {0.111115261237027, 2.29186342215165}},
       2.59515240763043,
       0.346519650927116},
      {"4-RRR with a turning platform",
       4,
       0.17,
       "[0, 0]",
       turning,
       {1.85465312262872, 3.13922356125938, -1.55207200814033, 0.341703642542096},
       {-1.5289818502001, 0.470391474749753, 0.410348737002384, -2.10156152666376},
       {{6.94361280576287, 0.221705185367106},
        {0.440028663010362, -2.00771061485636},
        {1.71877269809022, -0.485482226230522},
        {-0.329752535257502, -10.1457249867719}},
       {{5.82682591050684, 0.170892829089881},
        {0.329241003731264, -1.86538048825304},
        {1.72130365999634, -0.554863517461225},
        {-0.946964176754306, -8.13034104609474}},
       {{4.31691124063965, 1.24866559610879},
        {-0.612769360185103, -1.52913287285435},
        {1.71235663774131, -0.411780754743576},
        {-1.28240510960141, -5.82204081001409}},
       -0.482469282074552,
       0.345401135177583},
  };
  return all;
}

std::string ideal_text(int legs, const char* gravity, const char* angle, const std::string& interval) {
  std::string text = mechanism(legs == 3 ? "3-rrr" : "4-rrr");
  text = replaced(text, "space: planar\n", std::string("space: planar\ngravity: ") + gravity + "\n");
  text = replaced(text, "angle: 0}", std::string("angle: \"") + angle + "\"}");
  return replaced(text, "{interval: 0.1 ms, discard: $T/5}", "{interval: " + interval + "}");
}

/// Every coordinate is driven, so the step is of no consequence and the forces are good to the rounding of the solve.
constexpr double solve_rounding = 1e-10;  // of the largest; the program promises 1e-6

class InverseDynamics : public ::testing::TestWithParam<Instant> {
 protected:
  static ModelRun run_to(const Instant& instant) {
    const double end = instant.time > 0.0 ? instant.time : 1e-3;
    return ModelRun(ideal_text(instant.legs, instant.gravity, instant.angle, number(end) + " s"),
                    {.set = {}, .ideal = {"all"}, .end = end, .step = 1e-3, .integrator = {}});
  }
};

TEST_P(InverseDynamics, DriverTorquesEqualTheIndependentOnes) {
  const Instant& want = GetParam();
  const ModelRun run = run_to(want);
  ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  const std::size_t row = want.time > 0.0 ? run.rows() - 1 : 0;
  ASSERT_EQ(run.at(row, "time"), want.time);
  double largest = 0.0, worst = 0.0;
  for (const double torque : want.torque) largest = std::max(largest, std::abs(torque));
  for (std::size_t i = 0; i < want.torque.size(); ++i) {
    const std::string leg = "leg" + std::to_string(i + 1);
    worst = std::max(worst, std::abs(run.at(row, "driver." + leg + ".A.torque") - want.torque[i]));
    const double turned = run.at(row, "joint." + leg + ".A.angle") - want.crank[i];
    // The crank is where the closed form says, to rounding of angles of a few radians.
    EXPECT_NEAR(std::remainder(turned, 2.0 * M_PI), 0.0, 1e-11) << leg;
  }
  record("torque_error_of_largest", worst / largest);
  EXPECT_LE(worst, solve_rounding * largest);
}

TEST_P(InverseDynamics, PinForcesEqualTheIndependentOnes) {
  const Instant& want = GetParam();
  const ModelRun run = run_to(want);
  const std::size_t row = want.time > 0.0 ? run.rows() - 1 : 0;
  double largest = 0.0, worst = 0.0;
  const auto compare = [&](const char* pin, const std::vector<Pair>& forces) {
    for (std::size_t i = 0; i < forces.size(); ++i) {
      const std::string joint = "joint.leg" + std::to_string(i + 1) + "." + pin;
      worst = std::max({worst, std::abs(run.at(row, joint + ".fx") - forces[i][0]),
                        std::abs(run.at(row, joint + ".fy") - forces[i][1])});
      largest = std::max({largest, std::abs(forces[i][0]), std::abs(forces[i][1])});
    }
  };
  compare("A", want.at_a);
  compare("B", want.at_b);
  compare("C", want.at_c);
  record("force_error_of_largest", worst / largest);
  EXPECT_LE(worst, solve_rounding * largest);
}

TEST_P(InverseDynamics, PowerAndEnergyEqualTheIndependentOnes) {
  const Instant& want = GetParam();
  const ModelRun run = run_to(want);
  const std::size_t row = want.time > 0.0 ? run.rows() - 1 : 0;
  double power = 0.0;
  for (int i = 1; i <= want.legs; ++i) power += run.at(row, "driver.leg" + std::to_string(i) + ".A.power");
  EXPECT_NEAR(power, want.power, 1e-8);  // torques of 2 N m good to 1e-9, speeds of 3 rad/s
  EXPECT_NEAR(run.at(row, "energy.kinetic"), want.kinetic_energy, 1e-10);
}

void PrintTo(const Instant& instant, std::ostream* out) { *out << instant.name; }

std::string name_of(const ::testing::TestParamInfo<Instant>& info) {
  std::string name;
  for (const char c : std::string(info.param.name)) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
  }
  return name;
}
INSTANTIATE_TEST_SUITE_P(IdealParallelMechanisms, InverseDynamics, ::testing::ValuesIn(instants()), name_of);

// A quarter turn later the torques of the 4-RRR are those of the start moved on by one leg.
TEST(IdealParallelMechanism, FourLegsRepeatAfterAQuarterTurn) {
  const ModelRun run(ideal_text(4, "[0, 0]", "0", "0.125 s"),
                     {.set = {}, .ideal = {"all"}, .end = 0.125, .step = 1e-3, .integrator = {}});
  for (int i = 0; i < 4; ++i) {
    const auto torque = [&](std::size_t row, int leg) {
      return run.at(row, "driver.leg" + std::to_string(leg + 1) + ".A.torque");
    };
    EXPECT_NEAR(torque(run.rows() - 1, (i + 1) % 4), torque(0, i), 1e-8);  // rounding, against torques of 2 N m
  }
}

/// Residuals at every accepted step: the limits are those that the program promises.
class ConstraintResidual : public ::testing::TestWithParam<int> {};

TEST_P(ConstraintResidual, StaysSmallOverAWholeTurn) {
  const ModelRun run(ideal_text(GetParam(), "[0, 0]", "0", "10 ms"),
                     {.set = {}, .ideal = {"all"}, .end = 0.5, .step = 1e-4, .integrator = {}}, {"time"});
  ASSERT_EQ(run.outcome().steps, 5000);
  record("position_residual", run.statistics().position_residual());
  record("velocity_residual", run.statistics().velocity_residual());
  EXPECT_LT(run.statistics().position_residual(), 1e-10);
  EXPECT_LT(run.statistics().velocity_residual(), 1e-8);
}

TEST_P(ConstraintResidual, StaysSmallWithStepsOfTwoMicroseconds) {
  const ModelRun run(ideal_text(GetParam(), "[0, 0]", "0", "1 ms"),
                     {.set = {}, .ideal = {"all"}, .end = 2e-3, .step = 2e-6, .integrator = {}}, {"time"});
  ASSERT_EQ(run.outcome().steps, 1000);
  record("position_residual", run.statistics().position_residual());
  record("velocity_residual", run.statistics().velocity_residual());
  EXPECT_LT(run.statistics().position_residual(), 1e-10);
  EXPECT_LT(run.statistics().velocity_residual(), 1e-8);
}
INSTANTIATE_TEST_SUITE_P(Legs, ConstraintResidual, ::testing::Values(3, 4));

/// Where a driver alone moves everything its work is the energy of motion, and what it is off by is the sum over the
/// steps alone.
TEST(DrivenCrank, MethodsOfOrderTwoBookTheWorkOfItsDriver) {
  const std::string text =
      "freeplay: 1\n"
      "bodies:\n"
      "  crank: {mass: 0.3, inertia: 1e-4, frames: {tip: [0.05, 0]}}\n"
      "  coupler: {mass: 0.2, inertia: 2.5e-4, frames: {tip: [0.12, 0]}}\n"
      "  slider: {mass: 0.1, inertia: 1e-4}\n"
      "joints:\n"
      "  main: {type: revolute, between: [ground, crank]}\n"
      "  pin: {type: revolute, between: [crank/tip, coupler]}\n"
      "  guide: {type: prismatic, between: [ground, slider]}\n"
      "  wrist: {type: revolute, between: [coupler/tip, slider]}\n"
      "drivers: {m: {joint: main, kind: velocity, value: 20}}\n"
      "initial: {joints: {main: 0}}\n"
      "simulation: {end: 2, accuracy: 1e-4, output: {interval: 0.01}}\n";
  for (const char* integrator : {"bathe", "newmark", "hht", "generalized-alpha"}) {
    for (const auto& [accuracy, most] : {std::pair{1e-4, 1.5e-4}, std::pair{1e-6, 3e-6}}) {
      BuildOptions options;
      options.integrator = integrator;
      options.accuracy = accuracy;
      const ModelRun run(text, options);
      ASSERT_EQ(run.outcome().status, RunStatus::completed) << integrator << ": " << run.outcome().reason;
      double largest = 0.0, moved = 0.0;
      for (std::size_t row = 0; row < run.rows(); ++row) {
        largest = std::max(largest, std::abs(run.at(row, "energy.residual")));
        moved = std::max(moved, run.at(row, "energy.kinetic"));
      }
      EXPECT_LT(largest, most * moved / 0.18) << integrator << " " << accuracy;
    }
  }
}

}  // namespace
}  // namespace freeplay::test
