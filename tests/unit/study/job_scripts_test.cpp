#include "study/job_scripts.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "base/error.h"

namespace freeplay {
namespace {

JobRequest request_of(std::uint64_t points, double seconds) {
  JobRequest request;
  request.program = "/opt/free play/freeplay";
  request.folder = std::filesystem::path(testing::TempDir()) / "it's a study";
  request.name = "crank & rod";
  request.points_left = points;
  request.seconds_per_point = seconds;
  return request;
}

std::string script_text(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// Section 5.3 of the contract of studies: 10^7 points of 0.017 s are 47 core-hours, 94 tasks of 30 minutes.
TEST(JobScripts, TasksTakeTheMinutesThatWereAskedFor) {
  const JobPlan plan = plan_jobs(request_of(10'000'000, 0.017));
  EXPECT_EQ(95u, plan.tasks);
  EXPECT_NEAR(30.0, plan.minutes, 0.5);
  EXPECT_EQ("01:30:00", plan.time);
}

TEST(JobScripts, AFewQuickPointsAreOneTaskOfTenMinutes) {
  const JobPlan plan = plan_jobs(request_of(8, 0.01));
  EXPECT_EQ(1u, plan.tasks);
  EXPECT_EQ("00:10:00", plan.time);
}

TEST(JobScripts, TasksGrowToAnHourBeforeThereAreTooMany) {
  JobRequest request = request_of(3'600'000, 1.0);  // 1000 h
  EXPECT_EQ(1000u, plan_jobs(request).tasks);
  EXPECT_NEAR(60.0, plan_jobs(request).minutes, 1e-9);
  request.max_array = 400;
  try {
    plan_jobs(request);
    FAIL() << "more tasks than allowed";
  } catch (const Error& error) {
    EXPECT_EQ(2, error.exit_code());
    EXPECT_EQ("--cores 3 would do", error.hint());
    request.cores = 3;
    EXPECT_LE(plan_jobs(request).tasks, 400u);
  }
}

TEST(JobScripts, WordsOfScriptsAreQuoted) {
  JobRequest request = request_of(100, 60.0);
  const JobScripts made = write_job_scripts(request, plan_jobs(request));
  ASSERT_EQ(3u, made.files.size());
  const std::string array = script_text(made.files[0]);
  EXPECT_NE(std::string::npos, array.find("#SBATCH --array=1-4\n")) << array;
  EXPECT_NE(std::string::npos, array.find("#SBATCH --job-name=crank---rod\n")) << array;
  EXPECT_NE(std::string::npos, array.find("exec '/opt/free play/freeplay' study run '")) << array;
  EXPECT_NE(std::string::npos, array.find("it'\\''s a study' --shard \"$SLURM_ARRAY_TASK_ID\"/4")) << array;
}

TEST(JobScripts, SignsThatEnginesFillInStayAsTheyAre) {
  JobRequest request = request_of(100, 60.0);
  request.folder = request.folder.parent_path() / "50 %a of {x}";
  EXPECT_NE(std::string::npos,
            script_text(write_job_scripts(request, plan_jobs(request)).files[0]).find("50 %%a of {x}/jobs/%A_%a.log'"));
  request.engine = JobEngine::gnu_parallel;
  write_job_scripts(request, plan_jobs(request));
  request.folder = request.folder.parent_path() / "{1}";
  EXPECT_THROW(write_job_scripts(request, plan_jobs(request)), Error);
}

TEST(JobScripts, ATimeThatIsNoneIsRefused) {
  JobRequest request = request_of(1, 1.0);
  request.time = "1h";
  EXPECT_THROW(plan_jobs(request), Error);
  request.time = "02:30:00";
  EXPECT_EQ("02:30:00", plan_jobs(request).time);
}

}  // namespace
}  // namespace freeplay
