#include "format/key_table.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "format/analysis_keys.h"

namespace freeplay {
namespace {

constexpr FormatKey use{"use", "name | list of name", "", "", "Presets whose keys are copied here.", "steel"};

constexpr FormatKey model[] = {
    {"freeplay", "integer", "", "required", "Version of the format: 1.", "1"},
    {"name", "text", "", "name of the file", "Used in reports and for the folder of results.", "four-bar"},
    {"description", "text", "", "", "Free text.", "A loose four-bar"},
    {"space", "'planar' | 'spatial'", "", "planar", "Length of vectors and kind of bodies.", "planar"},
    {"gravity", "vector", "m/s^2", "zero", "Acceleration of free fall.", "[0, -9.81]"},
    {"parameters", "entries of quantity", "", "", "Named numbers for expressions: $name.", "{l: 240 mm}"},
    {"presets", "entries of contents", "", "", "Named keys that entries copy with `use`.", "{steel: {mass: 1 kg}}"},
    {"plugins", "list of text", "", "", "Libraries with more types: paths from the model's folder, or names.",
     "[./my_joint.so]"},
    {"urdf", "text | map urdf", "", "", "A robot file, URDF, MJCF or SDFormat, that this file adds to.", "robot.urdf"},
    {"bodies", "entries of map body", "", "", "What moves; `ground` may carry frames.",
     "{rod: {mass: 1, inertia: 0.1}}"},
    {"frames", "entries of frame value", "", "", "More frames; the keys are BODY/NAME.", "{rod/tip: [1, 0]}"},
    {"joints", "entries of map joint", "", "", "What connects bodies.", "{pin: {type: TYPE, between: [ground, rod]}}"},
    {"drivers", "entries of map driver", "", "", "What moves joints.",
     "{motor: {joint: pin, kind: angle, value: 10*t}}"},
    {"forces", "entries of map force", "", "", "Forces and torques.", "{push: {type: force, at: rod, value: [1, 0]}}"},
    {"templates", "entries of map template", "", "", "Pieces of mechanism that instances repeat.",
     "{leg: {bodies: {crank: {mass: 1, inertia: 0.1}}}}"},
    {"instances", "entries of map instance", "", "", "Copies of templates.", "{leg: {template: leg, count: 3}}"},
    {"initial", "map initial", "", "", "Where and how fast the mechanism starts.", "{joints: {pin: 30 deg}}"},
    {"simulation", "map simulation", "", "", "Time span, steps, output.", "{end: 2 s, step: 1 ms}"},
    {"analysis", "map analysis", "", "", "Platform, inputs and grids of `freeplay analyze`.", "{frame: platform}"},
    {"study", "map study", "", "", "Many runs, and what is kept of each.", "{axes: {l: [0.1, 0.2]}}"}};

constexpr FormatKey urdf[] = {
    {"file", "text", "", "required", "Path from the model's folder.", "robot.urdf"},
    {"plane", "'xy' | 'xz' | 'yz'", "", "xy", "Plane of a planar mechanism, in axes of the root link.", "xz"},
    {"base", "'fixed' | 'floating'", "", "fixed", "How a root link with mass meets ground.", "floating"},
    {"loops", "'elements' | 'two-parents'", "", "elements", "Whether a second parent closes a loop.", "two-parents"},
    {"repair", "'inertia'", "", "", "Mend impossible inertia instead of refusing it.", "inertia"},
    {"merge_fixed", "boolean", "", "false", "Bodies on fixed joints become part of what carries them.", "true"},
    {"limits", "'ignore' | 'stop'", "", "ignore", "Whether joint limits become stops.", "stop"}};

constexpr FormatKey body[] = {
    {"mass", "quantity", "kg", "required", "Greater than 0.", "0.2 kg"},
    {"inertia", "quantity", "kg*m^2", "required", "About the centre of mass; 0 for a point mass.", "1 kg*m^2 / 12"},
    {"com", "vector", "m", "zero", "Centre of mass in the body frame.", "[$l/2, 0]"},
    {"pose", "map pose", "", "", "Guess of the start.", "{angle: 30 deg}"},
    {"velocity", "map velocity", "", "zero", "Guess of the start.", "{angular: 3 rad/s}"},
    {"frames", "entries of frame value", "", "", "Points with axes that joints hold.", "{tip: [0.24, 0]}"},
    use};

constexpr FormatKey ground_keys[] = {
    {"frames", "entries of frame value", "", "", "Points with axes that joints hold.", "{anchor: [0.5, 0]}"}};

constexpr FormatKey pose[] = {{"position", "vector", "m", "follows from the joints", "Of the body frame.", "[0, 0.1]"},
                              {"angle", "quantity", "rad", "follows from the joints", "Counter-clockwise.", "30 deg"},
                              {"rpy", "list of quantity", "rad", "follows from the joints",
                               "In space: roll, pitch, yaw about fixed x, y, z.", "[0, 0, 90 deg]"},
                              {"quaternion", "list of quantity", "", "follows from the joints",
                               "In space: w, x, y, z; made a unit one.", "[1, 0, 0, 0]"}};

constexpr FormatKey velocity[] = {
    {"linear", "vector", "m/s", "zero", "Of the body frame's origin, global axes.", "[1, 0]"},
    {"angular", "quantity", "rad/s", "0", "Counter-clockwise.", "60 rpm"}};

constexpr FormatKey frame[] = {
    {"position", "vector", "m", "zero", "In the body frame.", "[0.1, 0]"},
    {"polar", "list of quantity", "", "", "Instead of `position`: radius and angle.", "[0.1, 120 deg]"},
    {"angle", "quantity", "rad", "0", "Of the frame's x axis in the body frame.", "90 deg"},
    {"rpy", "list of quantity", "rad", "0", "In space: roll, pitch, yaw about the body's x, y, z.", "[0, 0, 90 deg]"},
    {"quaternion", "list of quantity", "", "[1, 0, 0, 0]", "In space: w, x, y, z; made a unit one.", "[1, 0, 0, 0]"}};

constexpr FormatKey joint[] = {
    {"type", "name", "", "required", "A type that `freeplay list joints` shows, or gear.", "TYPE"},
    {"between", "list of frame", "", "required", "First and second frame; some types have names of their own for them.",
     "[ground/anchor, rod]"},
    use};

constexpr FormatKey gear[] = {
    {"type", "'gear'", "", "required", "coordinate(second) = ratio coordinate(first) + offset.", "gear"},
    {"of", "list of name", "", "required", "Two joints that have a coordinate.", "[input, output]"},
    {"ratio", "quantity", "", "required", "Plain, or length per angle between a turn and a slide.", "-2"},
    {"offset", "quantity | 'auto'", "", "auto", "auto: what the assembled start has.", "0"},
    {"pressure_angle", "quantity", "rad", "",
     "Of teeth that press at the pitch point; without it a torque alone passes.", "20 deg"},
    {"clearance", "contents", "", "", "Teeth with play: the keys of the loose gear.",
     "{pitch_radius: 50 mm, gap: 50 um}"},
    use};

constexpr FormatKey driver[] = {
    {"joint", "name", "", "required unless inverse_kinematics", "The joint that it moves.", "pin"},
    {"kind", "'angle' | 'position' | 'velocity' | 'torque' | 'force'", "", "required unless inverse_kinematics",
     "What is prescribed, or the effort that acts.", "angle"},
    {"value", "time function", "by kind", "",
     "Function of t, an effort also of the motion; either this, `table` or `input`.", "2*pi*t"},
    {"table", "text | map table", "", "", "Values from a file or a list.", "motor.csv"},
    {"input", "quantity", "by kind", "", "Of a torque or force that a script sets during a run: what it begins with.",
     "0 N*m"},
    {"inverse_kinematics", "map inverse_kinematics", "", "", "Instead of all these: a frame follows a path.",
     "{frame: platform, path: {x: 0.1*t}, joints: [A]}"},
    use};

constexpr FormatKey column[] = {
    {"file", "text", "", "required", "CSV file beside the model; the name alone is short for it.", "angles.csv"},
    {"value", "text", "", "first", "Column of the numbers.", "angle"},
    {"unit", "text", "", "SI", "Of the column.", "deg"}};

constexpr FormatKey column_points[] = {
    {"file", "text", "", "required", "CSV file beside the model; the name alone is short for it.", "pull.csv"},
    {"x", "text", "", "first", "Column of the variable, which must increase.", "stretch"},
    {"value", "text", "", "second", "Column of the values.", "pull"},
    {"x_unit", "text", "", "SI", "Of the column of the variable.", "mm"},
    {"unit", "text", "", "SI", "Of the column of the values.", "kN"}};

constexpr FormatKey points[] = {
    {"points", "list of list of quantity", "", "required", "Pairs of the variable and the value, the first increasing.",
     "[[-10 mm, -900 N], [0 m, 0 N], [10 mm, 600 N]]"},
    {"interpolation", "'cubic' | 'linear'", "", "cubic", "Cubic spline, or straight lines.", "linear"},
    {"ends", "'natural' | 'periodic'", "", "natural", "Straight on beyond them, or the same again.", "periodic"}};

constexpr FormatKey arcs[] = {
    {"arcs", "list of list of quantity", "", "required",
     "Circles [x, y, radius] joined by tangents, a negative radius clockwise; [x, y]: an end of a curve over x.",
     "[[0 m, 0 m, 20 mm], [30 mm, 0 m, 8 mm]]"},
    {"roller", "quantity", "m", "0", "The curve is the way of the centre of a roller of this radius.", "10 mm"}};

constexpr FormatKey inverse_kinematics[] = {
    {"frame", "frame", "", "required", "What follows the path.", "platform"},
    {"path", "text | map path", "", "required", "At least one component, or a file of poses.",
     "{x: 0.1*cos(t), y: 0.1*sin(t)}"},
    {"joints", "name | list of name", "", "required", "The joints that are driven; patterns with * are allowed.",
     "leg*.A"},
    {"elbow", "integer | list of integer", "", "1", "Working mode of each leg, 1 or -1.", "[1, -1, 1]"}};

constexpr FormatKey path[] = {
    {"x", "time function", "m", "follows from the mechanism", "Global position of the frame.", "0.1*cos(t)"},
    {"y", "time function", "m", "follows from the mechanism", "Global position of the frame.", "0.1*sin(t)"},
    {"z", "time function", "m", "follows from the mechanism", "Global position of the frame, in space.", "0.3"},
    {"angle", "time function", "rad", "follows from the mechanism", "Angle of the frame, in the plane.", "0"},
    {"roll", "time function", "rad", "follows from the mechanism", "In space: turn about fixed x, first.", "0"},
    {"pitch", "time function", "rad", "follows from the mechanism", "In space: turn about fixed y, then.", "0"},
    {"yaw", "time function", "rad", "follows from the mechanism", "In space: turn about fixed z, last.",
     "10 deg*sin(t)"},
    {"file", "text", "", "", "Instead: CSV file with the columns time, x, y, angle or time, x, y, z, qw, qx, qy, qz.",
     "poses.csv"},
    {"time", "text", "", "first column", "Column of times, with `file`.", "t"},
    {"time_unit", "text", "", "s", "Unit of the times.", "ms"},
    {"unit", "text", "", "m", "Unit of x, y and z.", "mm"},
    {"angle_unit", "text", "", "rad", "Unit of the angle.", "deg"},
    {"interpolation", "'cubic' | 'linear'", "", "cubic", "Spline with continuous second derivative, or lines.",
     "linear"},
    {"ends", "'natural' | 'clamped' | 'periodic'", "", "natural",
     "Second derivative zero, first derivative zero, or periodic.", "clamped"},
    {"outside", "'hold' | 'repeat' | 'error'", "", "hold", "Before the first and after the last time.", "repeat"}};

constexpr FormatKey table[] = {
    {"file", "text", "", "", "CSV file: comma, point, # comments, a header row of names.", "motor.csv"},
    {"points", "list of list of quantity", "", "", "Instead of `file`: pairs of time and value.",
     "[[0 s, 0 deg], [1 s, 90 deg]]"},
    {"time", "text", "", "first column", "Column of times, with `file`.", "t"},
    {"value", "text", "", "second column", "Column of values, with `file`.", "angle"},
    {"time_unit", "text", "", "s", "Unit of the times.", "ms"},
    {"unit", "text", "", "SI", "Unit of the values.", "deg"},
    {"interpolation", "'cubic' | 'linear'", "", "cubic", "Spline with continuous second derivative, or lines.",
     "linear"},
    {"ends", "'natural' | 'clamped' | 'periodic'", "", "natural",
     "Second derivative zero, first derivative zero, or periodic.", "clamped"},
    {"outside", "'hold' | 'repeat' | 'error'", "", "hold", "Before the first and after the last time.", "repeat"}};

constexpr FormatKey force[] = {
    {"type", "name", "", "required", "force, torque, gravity, or a joint type without rows.", "force"}, use};

constexpr FormatKey applied_force[] = {
    {"type", "'force'", "", "required", "A force on a point.", "force"},
    {"at", "frame", "", "required", "Where it acts.", "rod/tip"},
    {"value", "list of time function", "N", "required", "Components; may depend on the motion.", "[10 N * sin(t), 0]"},
    {"axes", "'global' | 'frame'", "", "global", "Axes of the components.", "frame"},
    use};

constexpr FormatKey applied_torque[] = {
    {"type", "'torque'", "", "required", "A torque on a body.", "torque"},
    {"on", "name", "", "required", "The body.", "rod"},
    {"value", "time function", "N*m", "required", "Counter-clockwise; may depend on the motion.", "2 N*m"},
    use};

constexpr FormatKey gravity[] = {
    {"type", "'gravity'", "", "required", "Another gravity for some bodies.", "gravity"},
    {"on", "list of name", "", "required", "Bodies; patterns with * are allowed.", "[rod]"},
    {"value", "vector", "m/s^2", "required", "In place of the model's gravity.", "[0, 0]"},
    use};

constexpr FormatKey template_keys[] = {
    {"parameters", "entries of quantity | entries of 'required'", "", "", "Values that hold where `with` gives none.",
     "{at: 0, l: required}"},
    {"bodies", "entries of map body", "", "", "As at top level.", "{crank: {mass: 1, inertia: 0.1}}"},
    {"frames", "entries of frame value", "", "", "As at top level.", "{ground/A: [$at, 0]}"},
    {"joints", "entries of map joint", "", "", "As at top level.", "{A: {type: TYPE, between: [ground/A, crank]}}"},
    {"drivers", "entries of map driver", "", "", "As at top level.", "{motor: {joint: A, kind: angle, value: t}}"},
    {"forces", "entries of map force", "", "", "As at top level.", "{push: {type: torque, on: crank, value: 1}}"}};

constexpr FormatKey instance[] = {
    {"template", "name", "", "required", "What is copied.", "leg"},
    {"count", "integer", "", "", "Copies NAME1, NAME2 and so on; without it one copy NAME.", "3"},
    {"with", "entries of quantity", "", "", "Values of the template's parameters; $i is the copy's number.",
     "{at: 0.1*$i}"}};

constexpr FormatKey initial[] = {
    {"joints", "entries of quantity", "rad or m", "", "Coordinates that hold exactly at the start.", "{pin: 30 deg}"},
    {"speeds", "entries of quantity", "rad/s or m/s", "", "Speeds that hold exactly at the start.", "{pin: 60 rpm}"},
    {"assembly", "map assembly", "", "", "How the start is found.", "{tolerance: 1e-12}"}};

constexpr FormatKey assembly[] = {
    {"tolerance", "quantity", "m or rad", "1e-10", "Largest constraint residual.", "1e-12"},
    {"max_iterations", "integer", "", "50", "Of Newton's method.", "100"}};

constexpr FormatKey simulation[] = {
    {"start", "quantity", "s", "0", "When the run begins.", "0 s"},
    {"end", "quantity", "s", "1 s", "When it ends, after its start.", "2 s"},
    {"step", "quantity | map step", "s", "0.1 ms", "Fixed steps; a map may let the error choose.", "10 us"},
    {"accuracy", "quantity", "m", "", "In place of `step`: positions err by about this much per second.", "1 um"},
    {"integrator", "name | map integrator", "", "the preferred one", "`freeplay list integrators` shows them.",
     "{type: TYPE}"},
    {"output", "map output", "", "", "Rows and columns of the results.", "{interval: 1 ms}"},
    {"stop", "list of map stop", "", "", "Conditions that end the run, successfully.",
     "[{channel: body.rod.y, below: 0 m}]"}};

constexpr FormatKey step[] = {
    {"size", "quantity", "s", "0.1 ms", "Of fixed steps; where the error chooses, of the first.", "10 us"},
    {"adaptive", "boolean", "", "false", "The error chooses the steps, and they end where contacts begin and end.",
     "true"},
    {"tolerance", "quantity", "", "1e-6", "Error of one step relative to the model, or to the smallest clearance.",
     "1e-8"},
    {"min", "quantity", "s", "a thousandth of size", "Smallest step.", "1 ns"},
    {"max", "quantity", "s", "10 times size", "Largest step.", "1 ms"},
    {"per_contact", "quantity", "", "20", "Steps that an impact should take.", "40"}};

constexpr FormatKey integrator[] = {
    {"type", "name", "", "required", "The other keys are the parameters of the type.", "TYPE"}};

constexpr FormatKey output[] = {
    {"interval", "quantity", "s", "a thousandth of the run", "Between rows.", "1 ms"},
    {"channels", "list of text", "", "[\"*\"]", "Patterns of the columns; `freeplay list channels FILE` shows all.",
     "[\"joint.*.fx\", \"energy.*\"]"},
    {"columns", "entries of quantity", "", "", "Further columns output.NAME: formulas of channels and t.",
     "{slide: body.ram.x - frame.rod/tip.x}"},
    {"frames", "list of frame", "", "", "Frames whose pose and velocity are reported.", "[rod/tip]"},
    {"format", "'csv' | 'hdf5' | 'both'", "", "both", "Of the results.", "csv"},
    {"rows_in_contact", "integer", "", "0",
     "So many rows more in each impact, and those of its peaks; 0: none of either.", "10"},
    {"discard", "quantity", "s", "0", "Time from the start that statistics leave out.", "5 ms"}};

constexpr FormatKey stop[] = {
    {"channel", "text", "", "", "A column of the results; either this or `value`.", "body.rod.y"},
    {"value", "quantity", "", "", "A formula of columns and t, which is the column output.stop1, output.stop2, ...",
     "body.ram.x - body.rod.x"},
    {"above", "quantity", "of the channel", "", "Ends the run when the channel is above; either this or `below`.",
     "1 m"},
    {"below", "quantity", "of the channel", "", "Ends the run when the channel is below.", "0 m"},
    {"after", "quantity", "s", "", "Not before this time.", "1 ms"}};

constexpr FormatKey study[] = {
    {"name", "text", "", "the name of the file", "Of the study.", "clearances"},
    {"description", "text", "", "", "For people.", "'Play against speed'"},
    {"models", "list of text | entries of text", "", "this model", "Files of models, in a file that has a study alone.",
     "{old: first.yaml, new: second.yaml}"},
    {"set", "entries of value", "", "", "Targets and their values at every point.", "{simulation.accuracy: 1 um}"},
    {"axes", "entries of axis", "", "one point for each model", "Targets and their values, point by point.",
     "{l: {linspace: [0.1, 0.2, 11]}}"},
    {"combine", "'grid' | 'zip' | 'star'", "", "grid",
     "All combinations, all axes side by side, or one axis at a time.", "zip"},
    {"zip", "list of list of text", "", "", "Lists of axes that go side by side in a grid.", "[[l, m]]"},
    {"sample", "map study sample", "", "required with random axes", "How they are drawn.",
     "{method: random, points: 1000, seed: 7}"},
    {"do", "'run' | map study analysis", "", "run", "What a point is.", "{analyze: error}"},
    {"warm_start", "map study warm start", "", "", "Points that begin where the one before has ended.",
     "{along: speed}"},
    {"reducers", "entries of map study reducer", "", "", "What is kept of each point.",
     "{force: {channel: joint.pin.fx, reduce: absmax}}"},
    {"stop", "map study stop", "", "", "When there are samples enough.", "{reducer: force, of: mean, relative: 0.01}"},
    {"plots", "entries of map study plot", "", "", "Pictures of the table.",
     "{spread: {kind: histogram, value: force}}"}};

constexpr FormatKey study_axis[] = {
    {"target", "text", "", "the name of the axis", "A parameter, a path in the model, or an option of a run.",
     "joints.pin.clearance.radial_clearance"},
    {"each", "text", "", "", "A pattern: an axis for every path that it fits.",
     "'joints.*.clearance.radial_clearance'"},
    {"where_present", "boolean", "", "false", "Models without the target leave it out.", "true"},
    {"linspace", "list of quantity", "", "", "First, last and number of values.", "[0, 10, 11]"},
    {"logspace", "list of quantity", "", "", "The same with equal ratios.", "[1, 100, 5]"},
    {"list", "list of value", "", "", "Values: quantities, words, lists or maps.", "[1 mm, 2 mm, 5 mm]"},
    {"cases", "entries of entries of value", "", "", "Named cases, each with values of several targets.",
     "{slow: {speed: 1, load: 5 N}}"},
    {"table", "text", "", "", "A file of text with commas: targets in its first line, then values.", "points.csv"},
    {"normal", "list of quantity", "", "", "Mean and standard deviation.", "[10 mm, 0.1 mm]"},
    {"uniform", "list of quantity", "", "", "Low and high end.", "[9 mm, 11 mm]"},
    {"triangular", "list of quantity", "", "", "Low end, mode and high end.", "[9 mm, 10 mm, 12 mm]"},
    {"fit", "text | list of text", "", "", "Radial clearance of an ISO 286 fit, or of each of several.", "H7/g6"},
    {"diameter", "quantity", "m", "required with fit", "Nominal size, at most 500 mm.", "10 mm"},
    {"law", "'normal' | 'uniform'", "", "normal", "Over the zones of hole and shaft.", "uniform"},
    {"truncate", "list of quantity", "", "", "Ends of random values.", "[9.8 mm, 10.2 mm]"}};

constexpr FormatKey study_sample[] = {
    {"method", "'random' | 'latin-hypercube' | 'sobol'", "", "required", "How numbers are drawn.", "sobol"},
    {"points", "integer", "", "required", "Samples, at least 1.", "1000"},
    {"seed", "integer", "", "required", "The same seed gives the same numbers.", "7"}};

constexpr FormatKey study_warm_start[] = {
    {"along", "text", "", "required", "The axis.", "speed"},
    {"direction", "'up' | 'down' | 'both'", "", "up", "In which order its values follow.", "both"},
    {"pieces", "integer", "", "1", "Chains that the axis is cut into.", "8"}};

constexpr FormatKey study_stop[] = {
    {"reducer", "text", "", "required", "Whose column is estimated.", "force"},
    {"of", "text", "", "required", "mean, or a percentile: p50 to p99.", "mean"},
    {"confidence", "quantity", "1", "0.95", "Of the interval.", "0.99"},
    {"half_width", "quantity", "by reducer", "", "The interval is to be so narrow.", "0.1 N"},
    {"relative", "quantity", "1", "", "The same as a share of the estimate.", "0.01"},
    {"min_points", "integer", "", "200", "Samples before the first look.", "500"},
    {"block", "integer", "", "100", "Samples between looks.", "50"}};

constexpr FormatKey study_plot[] = {
    {"kind", "'line' | 'heat' | 'bifurcation' | 'histogram' | 'tornado'", "", "required", "What it shows.", "line"},
    {"x", "text", "", "", "An axis.", "speed"},
    {"y", "text", "", "", "A reducer; of heat the second axis.", "force"},
    {"value", "text", "", "", "A reducer.", "force"},
    {"by", "text", "", "", "A family: model, an axis or direction.", "model"},
    {"percentiles", "list of quantity", "", "[5, 50, 95, 99]", "Marks of a histogram.", "[50, 99]"}};

constexpr FormatKey study_reducer[] = {
    {"channel", "text", "", "", "Of a column of results.csv, whether it is written or not.", "joint.pin.fx"},
    {"value", "text", "", "", "Of a formula, in which [NAME] is a channel.", "'[joint.pin.fx]/$F'"},
    {"summary", "text", "", "", "A number of summary.json.", "joints.pin.max_force"},
    {"over", "'max' | 'min' | 'sum' | 'mean'", "", "", "Of all numbers that the path with `*` fits.", "max"},
    {"events", "text", "", "", "Of the events of joints: a name or a pattern.", "pin"},
    {"field", "text", "", "required unless count", "A column of events.csv.", "speed"},
    {"kind", "text", "", "contact_begin", "The kind of event.", "contact_end"},
    {"joint", "text", "", "", "Joints with play, a name or a pattern, of which `set` gives columns.", "'*'"},
    {"set", "'clearance'", "", "required with joint", "The numbers of joints with play in summary.json.", "clearance"},
    {"column", "text", "", "", "Of a column of the analysis that `do` names.", "position"},
    {"of", "text", "", "", "A formula, in which [NAME] is a reducer above.", "'[force]/$F'"},
    {"reduce",
     "'min' | 'max' | 'absmax' | 'first' | 'final' | 'peak-to-peak' | 'mean' | 'rms' | 'std' | 'percentile' | 'median' "
     "| 'time-fraction' | 'count' | 'poincare'",
     "", "required but for summary, set and of", "What of the values.", "absmax"},
    {"p", "quantity", "1", "required for percentile", "From 0 to 100.", "99"},
    {"above", "quantity", "by value", "", "For time-fraction and count; of events those above it.", "0"},
    {"below", "quantity", "by value", "", "The same below.", "0"},
    {"from", "quantity", "s", "output.discard", "Not before this time.", "5 ms"},
    {"until", "quantity", "s", "the end", "Not after this time.", "10 ms"},
    {"every", "quantity", "s", "", "For poincare: the period.", "20 ms"},
    {"phase", "quantity", "s", "0", "For poincare: the first instant after the start of the run.", "5 ms"},
    {"when", "map study passage", "", "", "For poincare: when a channel passes a value.",
     "{channel: joint.pin.angle, crosses: 0}"}};

constexpr FormatKey study_analysis[] = {
    {"analyze", "'ik' | 'workspace' | 'singularity' | 'error' | 'inverse-dynamics'", "", "required",
     "The kind; the other keys are options of `freeplay analyze`.", "error"},
    {"frame", "frame", "", "that of `analysis`", "The platform.", "platform"},
    {"pose", "text | list of text", "", "", "Values of one pose, or several poses.", "[0.05, 0, 0]"},
    {"grid", "entries of text | list of text", "", "", "Poses on a grid, FROM:TO:COUNT by axis.", "{x: '0:0.1:11'}"},
    {"time", "text", "", "", "Instants on the path, FROM:TO:COUNT.", "0:1:121"},
    {"input", "entries of text | list of text", "", "", "Coordinates of driven joints.", "{pin: 30 deg}"},
    {"elbow", "text", "", "that of `analysis`", "Working modes of the legs.", "'1,-1,1'"},
    {"sensitivity", "boolean", "", "false", "For error: sensitivity to the play of each joint.", "true"},
    {"samples", "integer", "", "", "For error: samples of random play.", "1000"},
    {"seed", "integer", "", "0", "Of the samples.", "7"},
    {"distribution", "text", "", "uniform", "Of the samples.", "normal"},
    {"branches", "boolean", "", "false", "For ik: all working modes.", "true"},
    {"preload", "text", "", "0", "For inverse-dynamics: inner tension of redundant drivers.", "5 N"}};

constexpr FormatKey study_passage[] = {
    {"channel", "text", "", "required", "A column of the results.", "joint.pin.angle"},
    {"crosses", "quantity", "by channel", "required", "The value that it passes.", "0"},
    {"direction", "'up' | 'down' | 'both'", "", "up", "In which direction.", "down"}};

constexpr FormatMap maps[] = {
    {"model", "", "The whole file.", model},
    {"urdf", "urdf", "How a URDF file is read.", urdf},
    {"body", "bodies.NAME", "A rigid body. Positions are in its body frame.", body},
    {"ground", "bodies.ground", "What does not move.", ground_keys},
    {"pose", "bodies.NAME.pose", "Guess of a body's start.", pose},
    {"velocity", "bodies.NAME.velocity", "Guess of a body's start.", velocity},
    {"frame", "bodies.NAME.frames.NAME", "A point with axes on a body. A vector alone is its position.", frame},
    {"joint", "joints.NAME", "A joint; its other keys are the parameters of its type.", joint},
    {"gear", "joints.NAME", "A gear, or a rack and pinion: it ties two joints.", gear},
    {"driver", "drivers.NAME", "What moves one joint, or several along a path.", driver},
    {"inverse_kinematics", "drivers.NAME.inverse_kinematics", "A path that a frame follows.", inverse_kinematics},
    {"path", "drivers.NAME.inverse_kinematics.path", "Functions of time, or a file of poses.", path},
    {"table", "drivers.NAME.table", "Values over time.", table},
    {"column", "joints.NAME.KEY", "A parameter that is a list, from a file.", column},
    {"column points", "joints.NAME.KEY", "A parameter that is a table of points, from a file.", column_points},
    {"points", "forces.NAME.spring", "A formula of a type, such as of a spring, as points of its first variable.",
     points},
    {"arcs", "joints.NAME.curve", "A curve in the plane of arcs of circles and their common tangents.", arcs},
    {"force", "forces.NAME", "A force element; its other keys depend on its type.", force},
    {"force force", "forces.NAME", "A force that acts on a point.", applied_force},
    {"force torque", "forces.NAME", "A torque that acts on a body.", applied_torque},
    {"force gravity", "forces.NAME", "Gravity of some bodies.", gravity},
    {"template", "templates.NAME", "A piece of mechanism.", template_keys},
    {"instance", "instances.NAME", "One or more copies of a template.", instance},
    {"initial", "initial", "The start.", initial},
    {"assembly", "initial.assembly", "How the start is found.", assembly},
    {"simulation", "simulation", "The run.", simulation},
    {"step", "simulation.step", "Step size.", step},
    {"integrator", "simulation.integrator", "Integrator and its parameters.", integrator},
    {"output", "simulation.output", "Results.", output},
    {"stop", "simulation.stop", "A condition that ends the run.", stop},
    {"analysis", "analysis", "Analyses of the ideal mechanism.", analysis_keys::analysis},
    {"pose_grid", "analysis.grid", "Poses of the platform.", analysis_keys::pose_grid},
    {"error", "analysis.error", "Play and input errors.", analysis_keys::error},
    {"grid", "where a grid may stand", "Values of one quantity. A list or a single value will do as well.",
     analysis_keys::grid},
    {"study", "study", "Many runs of one model or several, see docs/studies.md.", study},
    {"study axis", "study.axes.NAME", "What changes from point to point. Values alone will do as well.", study_axis},
    {"study sample", "study.sample", "How random axes are drawn.", study_sample},
    {"study warm start", "study.warm_start", "Chains of points.", study_warm_start},
    {"study stop", "study.stop", "Sampling until an interval is narrow enough.", study_stop},
    {"study plot", "study.plots.NAME", "A picture.", study_plot},
    {"study reducer", "study.reducers.NAME", "What is kept of each point.", study_reducer},
    {"study analysis", "study.do", "Points that are analyses.", study_analysis},
    {"study passage", "study.reducers.NAME.when", "An instant of a Poincare section.", study_passage}};

}  // namespace

const FormatKey* FormatMap::find(std::string_view key) const {
  const auto found = std::ranges::find(keys, key, &FormatKey::name);
  return found == keys.end() ? nullptr : &*found;
}

std::span<const FormatMap> format_maps() { return maps; }

const FormatMap& format_map(std::string_view name) {
  const auto found = std::ranges::find(maps, name, &FormatMap::name);
  if (found != std::end(maps)) return *found;
  throw Error(Error::Category::internal, "internal", "the model format has no map '" + std::string(name) + "'");
}

}  // namespace freeplay
