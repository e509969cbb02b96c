"""The page of the study: tables of what was found, and of each claim whether it holds."""
import math

COUPLER = 0.24  # m, l2 of both models
NAMES = {"c": "clearance", "T": "turn", "mu": "friction"}
WORDS = {"c": "{:.2f} mm", "T": "{:g} s", "mu": "{:g}"}
SCALES = {"c": 1e3, "T": 1.0, "mu": 1.0}


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def um(value):
    return "%.1f" % (1e6 * value)


def mrad(value):
    return "%.3f" % (1e3 * value)


def static_table(static):
    rows = []
    for mechanism, own in static.items():
        path, centre = own["bounds"], own["centre"]
        worst = max(path, key=lambda row: row["position"])
        rows.append([mechanism, um(centre["position"]), um(centre["ls_position"]), mrad(centre["dangle"]),
                     um(worst["position"]), um(max(row["ls_position"] for row in path)),
                     um(min(row["position"] for row in path)), mrad(max(row["dangle"] for row in path))])
    return table(["", "centre, exact [um]", "centre, least squares [um]", "centre, angle [mrad]",
                  "circle, largest exact [um]", "circle, largest least squares [um]", "circle, smallest exact [um]",
                  "circle, largest angle [mrad]"], rows)


def run_rows(plan, static, runs, name):
    rows = []
    for value in plan["series"][name]:
        for mechanism in static:
            run = runs[mechanism, name, value]
            path, ideal = run.path(), runs[mechanism, "ideal", run.period]
            rows.append([WORDS[name].format(SCALES[name] * value), mechanism, um(path["max_position"]),
                         um(path["rms_position"]), mrad(path["max_angle"]),
                         "%.1f" % run.over_joints("rms_force"), "%.0f" % run.over_joints("max_force"),
                         "%.2f" % (1e6 * run.over_joints("max_delta")),
                         "%.1f" % (100 * run.over_joints("contact_fraction", min)),
                         "%.2f" % run.torque_rms(), "%.2f" % ideal.torque_rms(), "%.1f" % run.torque_max()])
    return table([NAMES[name], "", "largest error [um]", "rms error [um]", "largest angle [mrad]",
                  "rms force, worst joint [N]", "largest force [N]", "largest penetration [um]",
                  "in contact, worst joint [%]", "rms torques [N m]", "the same, ideal [N m]", "largest torque [N m]"],
                 rows)


def envelope_rows(plan, static, runs):
    """Excess over the static bound, and over that of a clearance wider by the largest penetration."""
    rows, worst = [], -math.inf
    for (mechanism, name, value), run in runs.items():
        if name == "ideal":
            continue
        clearance = value if name == "c" else plan["base"]["c"]
        bounds, scale = static[mechanism]["bounds"], 1.0 / plan["base"]["c"]
        rigid = run.excess(bounds, scale * clearance)
        elastic = run.excess(bounds, scale * (clearance + run.over_joints("max_delta")))
        worst = max(worst, elastic)
        rows.append([mechanism, "%s %s" % (NAMES[name], WORDS[name].format(SCALES[name] * value)),
                     "%.2f" % (1e6 * rigid), "%.2f" % (1e6 * elastic)])
    return table(["", "run", "over the bound [um]", "over the bound with penetration [um]"], rows), worst


def pairs(plan, runs, name, quantity):
    """Points of a series at which the 4-RRR has the smaller value, of how many."""
    three, four = plan["mechanisms"]
    values = plan["series"][name]
    better = sum(quantity(runs[four, name, value]) < quantity(runs[three, name, value]) for value in values)
    return better, len(values)


def verdict(better, count):
    return "holds" if better == count else "does not hold" if better == 0 else "holds in part"


def static_claims(plan, static):
    three, four = (static[m] for m in plan["mechanisms"])
    both = [(a, b) for a, b in zip(three["map"], four["map"]) if a["position"] == a["position"] and
            b["position"] == b["position"]]
    claims = []
    for name, words in (("position", "smaller worst position error (exact)"),
                        ("ls_position", "smaller worst position error (least squares)"),
                        ("dangle", "smaller worst orientation error")):
        path = [b[name] < a[name] for a, b in zip(three["bounds"][1:], four["bounds"][1:])]
        cells = [b[name] < a[name] for a, b in both]
        claims.append(["at rest: %s on the circle" % words, verdict(sum(path), len(path)),
                       "%d of %d poses; largest there %s" % (sum(path), len(path), " against ".join(
                           (mrad if name == "dangle" else um)(max(row[name] for row in own["bounds"]))
                           for own in (four, three)))])
        claims.append(["at rest: %s where both reach" % words, verdict(sum(cells), len(cells)),
                       "%.0f %% of %d cells of the map" % (100.0 * sum(cells) / max(1, len(cells)), len(cells))])
    at = [own["centre"]["ls_position"] for own in (four, three)]
    claims.append(["at rest: smaller worst position error at the centre (least squares)",
                   verdict(int(at[0] < at[1]), 1), "%s um against %s um" % tuple(um(value) for value in at)])
    return claims


def dynamic_claims(plan, runs):
    claims = []
    for words, quantity in (("largest platform error", lambda run: run.path()["max_position"]),
                            ("rms platform error", lambda run: run.path()["rms_position"]),
                            ("largest platform angle error", lambda run: run.path()["max_angle"]),
                            ("rms joint force of the worst joint", lambda run: run.over_joints("rms_force")),
                            ("largest joint force", lambda run: run.over_joints("max_force")),
                            ("time out of contact of the worst joint", lambda run: -run.over_joints("contact_fraction", min)),
                            ("largest driver torque", lambda run: run.torque_max())):
        counts = [pairs(plan, runs, name, quantity) for name in plan["series"]]
        claims.append(["in motion: smaller %s" % words, verdict(sum(b for b, _ in counts), sum(n for _, n in counts)),
                       "; ".join("%s %d of %d" % (NAMES[name], *count) for name, count in zip(plan["series"], counts))])
    return claims


TEXT = """# 3-RRR against 4-RRR with loose joints

Zhang and Zhang 2016 ("A comparative study of planar 3-RRR and 4-RRR mechanisms with joint clearances") compare the two
mechanisms and find the redundant one, 4-RRR, better in kinematics and dynamics. This page asks the same question with
Freeplay. The paper's own figures were not available to us: what is compared here are the mechanisms, not the pictures.
`./dev study 3-rrr-vs-4-rrr` makes the page and its figures anew; what is varied stands in
`mechanisms/studies/3-rrr-vs-4-rrr/study.yaml`, the mechanisms are `mechanisms/3-rrr.yaml` and `mechanisms/4-rrr.yaml`.

The platform follows a circle of 50 mm radius. All joints between crank, coupler and platform are loose: six in the 3-RRR,
eight in the 4-RRR. Unless a series varies them: radial clearance {c:.2f} mm, {T:g} s for one turn, friction {mu:g}
(Ambrosio), Lankarani-Nikravesh contact with restitution 0.9. Runs last {turns} turns with `--accuracy {accuracy:g}`; the first fifth of
a turn is left out.

## What holds of "the 4-RRR is better"

{claims}

## At rest: how far the platform can move in the play

To first order, the drivers held still. *Exact* counts only errors that all legs can make together; *least squares* lets each
leg err as it likes, which is more than rigid links allow when there are more drivers than freedoms ([analysis](analysis.md)). The
clearance is {c:.2f} mm; all errors are proportional to it.

{static}

![map of the 3-RRR]({images}/map-3-rrr.svg)

![map of the 4-RRR]({images}/map-4-rrr.svg)

Largest exact position errors at platform angle 0; hatched: out of reach; the circle is the path.

![along the circle]({images}/bounds.svg)

## In motion

A mechanism with clearance is chaotic: a single largest value depends on rounding from some tenths of a second on. rms values
and fractions are good to some percent, largest forces to some ten percent: differences of that size say nothing.

### Clearance

{table_c}

### Speed

{table_T}

### Friction

{table_mu}

![trends]({images}/trends.svg)

"rms torques" is that of all drivers together; forces are those of loose joints.

The last turn at the base values, as `freeplay plot` draws it: the platform's error in x and y of the 3-RRR (blue) and the 4-RRR (dashed),

![platform error]({images}/errors.svg)

drive torque and bearing force of the first leg with play (blue) and without (dashed), 3-RRR first,

![loads of the 3-RRR]({images}/loads-3-rrr.svg)

![loads of the 4-RRR]({images}/loads-4-rrr.svg)

and the path of the journal in leg1.B, in the 3-RRR and in the 4-RRR.

![orbit in the 3-RRR]({images}/orbit-3-rrr.svg)

![orbit in the 4-RRR]({images}/orbit-4-rrr.svg)

## Does the motion stay within the bounds at rest?

The play bounds the platform also in motion, but for the elastic penetration of the contacts. Largest distance by which the
simulated position error leaves the exact bound of its place on the circle, and the bound of a clearance that is larger by the
largest penetration of the run (negative: it stays inside). The bounds are of first order in the clearance: what they neglect is at most about
d^2 / (2 l), d = 2 c, so {second:.2f} um at the largest clearance. The largest of the last column is {worst:.2f} um.

{envelope}
"""


def text(plan, static, runs, images):
    base = plan["base"]
    envelope, worst = envelope_rows(plan, static, runs)
    claims = static_claims(plan, static) + dynamic_claims(plan, runs)
    return TEXT.format(
        c=1e3 * base["c"], T=base["T"], mu=base["mu"], turns=plan["turns"], accuracy=plan["accuracy"], images=images,
        claims=table(["The 4-RRR has the", "", "found"], claims), static=static_table(static),
        table_c=run_rows(plan, static, runs, "c"), table_T=run_rows(plan, static, runs, "T"),
        table_mu=run_rows(plan, static, runs, "mu"), envelope=envelope, worst=1e6 * worst,
        second=1e6 * (2 * max(plan["series"]["c"])) ** 2 / (2 * COUPLER))
