// Studies that are planned from texts in a folder of their own.
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "study/plan.h"
#include "unit/scratch_folder.h"

namespace freeplay {

inline constexpr const char* plain_ball =
    "freeplay: 1\nname: ball\nparameters: {g: 9.81 m/s^2, v: 0 m/s}\ngravity: [0, -$g]\n"
    "bodies: {ball: {mass: 1 kg, inertia: 0.1, velocity: {linear: [$v, 0]}}}\n"
    "simulation: {end: 0.1 s, step: 10 ms}\n";
inline constexpr const char* loose_crank =
    "freeplay: 1\nname: crank\nparameters: {c: 0.1 mm}\nbodies: {rod: {mass: 1, inertia: 1}, slider: {mass: 1, "
    "inertia: "
    "1}}\njoints:\n  a: {type: revolute, between: [ground, rod], clearance: {radial_clearance: $c, bearing_radius: 10 "
    "mm,"
    " contact: {law: flores, restitution: 0.9, K: 1e9}}}\n"
    "  b: {type: revolute, between: [rod, slider], clearance: {radial_clearance: 0.2 mm, bearing_radius: 10 mm, "
    "contact:"
    " {law: flores, restitution: 0.9, K: 1e9}}}\n";

class StudyPlanning : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories(folder_.file(name).parent_path());
    std::ofstream(folder_.file(name), std::ios::binary) << text;
  }

  std::unique_ptr<StudyPlan> read(const std::string& name, StudyPlanOptions options = {}) {
    Diagnostics diagnostics;
    auto plan = StudyPlan::read(folder_.file(name).string(), options, diagnostics);
    messages_.clear();
    for (const Diagnostic& one : diagnostics.sorted()) {
      messages_ += std::to_string(one.location.line) + ":" + std::to_string(one.location.column) + " " + one.id + " " +
                   one.message + " " + one.suggestion + " " + one.hint + "\n";
    }
    EXPECT_EQ(plan == nullptr, diagnostics.has_errors()) << messages_;
    return plan;
  }

  /// A study of the ball, whose section has these lines.
  std::unique_ptr<StudyPlan> of_ball(const std::string& section, const StudyPlanOptions& options = {}) {
    write("ball.yaml", std::string(plain_ball) + "study:\n" + section);
    return read("ball.yaml", options);
  }

  std::string refused(const std::string& section) {
    EXPECT_EQ(of_ball(section), nullptr) << section;
    return messages_;
  }

  static std::vector<std::string> cells(const StudyPlan& plan) {
    std::vector<std::string> rows;
    for (std::uint64_t i = 0; i < plan.points(); ++i) {
      std::string row;
      for (const std::string& cell : plan.point(i).cells) row += (row.empty() ? "" : ",") + (cell.empty() ? "-" : cell);
      rows.push_back(row);
    }
    return rows;
  }

  ScratchFolder folder_;
  std::string messages_;
};

}  // namespace freeplay
