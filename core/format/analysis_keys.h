// The keys of the section `analysis`, and of grids.
#pragma once

#include "format/key_table.h"

namespace freeplay::analysis_keys {

inline constexpr FormatKey analysis[] = {
    {"frame", "frame", "", "that of the inverse kinematics", "The platform.", "platform"},
    {"joints", "name | list of name", "", "those of the inverse kinematics", "The inputs.", "leg*.A"},
    {"elbow", "integer | list of integer", "", "that of the inverse kinematics", "Working modes.", "1"},
    {"path", "text | map path", "", "that of the inverse kinematics", "Path of the frame.",
     "{x: 0.1*t, y: 0, angle: 0}"},
    {"time", "grid", "s", "the run, 101 points", "Instants on the path.", "{linspace: [0, 1, 101]}"},
    {"grid", "map pose_grid", "", "", "Poses.", "{x: {linspace: [0, 0.1, 11]}, y: 0}"},
    {"limits", "entries of list of quantity", "m or rad", "",
     "Lowest and highest coordinate of joints, by name or pattern; stops of the model count without it.",
     "{leg*.slide: [0.4 m, 0.7 m]}"},
    {"error", "map error", "", "", "Play that is looked at.", "{input: 0.1 deg}"}};

inline constexpr FormatKey pose_grid[] = {{"x", "grid", "m", "", "Of the frame.", "{linspace: [0, 0.1, 11]}"},
                                          {"y", "grid", "m", "", "Of the frame.", "[0, 0.05]"},
                                          {"z", "grid", "m", "", "Of the frame, in space.", "0.2"},
                                          {"angle", "grid", "rad", "0", "Of the frame, in the plane.", "10 deg"},
                                          {"roll", "grid", "rad", "0", "Of the frame, in space.", "10 deg"},
                                          {"pitch", "grid", "rad", "0", "Of the frame, in space.", "[0, 0.1]"},
                                          {"yaw", "grid", "rad", "0", "Of the frame, in space.", "0"}};

inline constexpr FormatKey grid[] = {
    {"linspace", "list of quantity", "", "", "First value, last value, number of points.", "[0, 1, 11]"},
    {"logspace", "list of quantity", "", "", "First value, last value, number of points.", "[0.01, 1, 3]"},
    {"list", "list of quantity", "", "", "Values.", "[0, 0.5, 2]"}};

inline constexpr FormatKey error[] = {
    {"clearance", "entries of quantity", "m", "that of each joint", "Radius of the play by joint.", "{leg1.B: 0.1 mm}"},
    {"input", "quantity", "rad", "0", "Error of each driven joint.", "0.1 deg"}};

}  // namespace freeplay::analysis_keys
