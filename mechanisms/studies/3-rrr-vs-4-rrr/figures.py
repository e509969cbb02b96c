"""Figures of the study: line styles and greys rather than colours, so that they can be read in print."""
import math
import os

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402  the backend comes first

STYLE = {"3-rrr": dict(color="#d55e00", linestyle="-"), "4-rrr": dict(color="#0072b2", linestyle="--")}
MARK = {"3-rrr": "o", "4-rrr": "s"}
NAMES = {"c": "radial clearance [mm]", "T": "time for one turn [s]", "mu": "friction coefficient"}
SCALES = {"c": 1e3, "T": 1.0, "mu": 1.0}
POINTS = 1500  # of a line, at most


def save(figure, folder, name):
    figure.tight_layout()
    # Neither date nor random ids: the same numbers make the same bytes.
    figure.savefig(os.path.join(folder, name + ".svg"), metadata={"Date": None})
    plt.close(figure)


def thinned(*columns):
    step = max(1, len(columns[0]) // POINTS)
    return [column[::step] for column in columns]


def maps(plan, static, folder):
    quantities = [("position", "exact, position [um]", 1e6), ("ls_position", "least squares, position [um]", 1e6),
                  ("dangle", "exact, orientation [mrad]", 1e3)]
    figure, axes = plt.subplots(2, 3, figsize=(12, 8), sharex=True, sharey=True)
    count = plan["map"]["count"]
    for row, mechanism in zip(axes, static):
        cells = static[mechanism]["map"]
        x = [1e3 * cells[i * count]["x"] for i in range(count)]
        y = [1e3 * cells[i]["y"] for i in range(count)]
        for ax, (name, title, scale) in zip(row, quantities):
            # Rows are x, columns y: transposed for the picture. What cannot be reached is empty and stays hatched.
            z = [[scale * cells[i * count + j][name] for i in range(count)] for j in range(count)]
            ax.set_facecolor("0.9")
            ax.add_patch(plt.Rectangle((x[0], y[0]), x[-1] - x[0], y[-1] - y[0], hatch="///", fill=False, color="0.7",
                                       zorder=0))
            levels = {"mrad": [1.5, 2, 2.5, 3, 4, 6, 10]}.get(title[-5:-1], [200, 250, 300, 350, 400, 500, 700, 1000])
            ax.contourf(x, y, z, levels=levels, cmap="Greys", extend="both", vmin=0.7 * levels[0],
                        vmax=1.3 * levels[-1])
            lines = ax.contour(x, y, z, levels=levels, colors="black", linewidths=0.7)
            ax.clabel(lines, fontsize=7)
            circle = [2 * math.pi * k / 100 for k in range(101)]
            ax.plot([50 * math.cos(a) for a in circle], [50 * math.sin(a) for a in circle], color="#d55e00",
                    linewidth=1.5)
            ax.set_title("%s, %s" % (mechanism, title), fontsize=9)
            ax.set_aspect("equal")
    for ax in axes[-1]:
        ax.set_xlabel("x [mm]")
    for row in axes:
        row[0].set_ylabel("y [mm]")
    save(figure, folder, "maps")


def bounds(static, folder):
    figure, axes = plt.subplots(1, 2, figsize=(10, 3.6))
    for mechanism, own in static.items():
        rows = own["bounds"]
        turn = [360.0 * k / (len(rows) - 1) for k in range(len(rows))]
        for ax, name, scale in ((axes[0], "position", 1e6), (axes[1], "dangle", 1e3)):
            ax.plot(turn, [scale * row[name] for row in rows], label=mechanism + ", exact", **STYLE[mechanism])
            if mechanism == "4-rrr":
                ax.plot(turn, [scale * row["ls_" + name] for row in rows], color="0.4", linestyle=":",
                        label=mechanism + ", least squares")
    axes[0].set_ylabel("worst position error [um]")
    axes[1].set_ylabel("worst orientation error [mrad]")
    for ax in axes:
        ax.set_xlabel("place on the circle [deg]")
        ax.set_ylim(bottom=0)
        ax.legend(fontsize=8)
    save(figure, folder, "bounds")


def series_of(plan, runs, mechanism, name):
    return [(value, runs[mechanism, name, value]) for value in plan["series"][name]]


def last_turn(run, *names):
    time, *columns = run.columns("time", *names)
    end = time[-1]
    first = next(i for i, t in enumerate(time) if t >= end - run.period)
    return [[(t - time[first]) / run.period * 360.0 for t in time[first:]], *(column[first:] for column in columns)]


def errors(plan, static, runs, folder):
    figure, axes = plt.subplots(2, 1, figsize=(10, 5.5), sharex=True)
    for ax, mechanism in zip(axes, static):
        run = runs[mechanism, "c", plan["base"]["c"]]
        turn, ex, ey = thinned(*last_turn(run, "driver.circle.ex", "driver.circle.ey"))
        ax.plot(turn, [1e6 * math.hypot(x, y) for x, y in zip(ex, ey)], linewidth=0.8, label="simulated",
                **{**STYLE[mechanism], "linestyle": "-"})
        rows = static[mechanism]["bounds"]
        ax.plot([360.0 * k / (len(rows) - 1) for k in range(len(rows))], [1e6 * row["position"] for row in rows],
                color="black", linestyle="--", label="static bound")
        ax.set_title(mechanism, fontsize=9)
        ax.set_ylabel("position error [um]")
        ax.set_ylim(bottom=0)
        ax.legend(fontsize=8, loc="lower right")
    axes[-1].set_xlabel("place on the circle, third turn [deg]")
    save(figure, folder, "errors")


def orbits(plan, static, runs, folder):
    figure, axes = plt.subplots(2, 4, figsize=(11, 5.8), sharex=True, sharey=True)
    for row, mechanism in zip(axes, static):
        run = runs[mechanism, "c", plan["base"]["c"]]
        for ax, joint in zip(row, ("leg1.B", "leg1.C", "leg2.B", "leg2.C")):
            _, ex, ey = last_turn(run, "joint.%s.ex" % joint, "joint.%s.ey" % joint)
            ex, ey = thinned(ex, ey)
            ax.add_patch(plt.Circle((0, 0), 1e6 * plan["base"]["c"], fill=False, color="0.5", linestyle="--"))
            ax.plot([1e6 * x for x in ex], [1e6 * y for y in ey], linewidth=0.6, color=STYLE[mechanism]["color"])
            ax.set_title("%s, %s" % (mechanism, joint), fontsize=9)
            ax.set_aspect("equal")
    for ax in axes[-1]:
        ax.set_xlabel("ex [um]")
    for row in axes:
        row[0].set_ylabel("ey [um]")
    save(figure, folder, "orbits")


def loads(plan, static, runs, folder):
    figure, axes = plt.subplots(2, 2, figsize=(11, 6), sharex=True, sharey="row")
    for column, mechanism in enumerate(static):
        run, ideal = runs[mechanism, "c", plan["base"]["c"]], runs[mechanism, "ideal", plan["base"]["T"]]
        for ax, names, title in ((axes[0][column], ("driver.leg1.A.torque",), "torque of leg1.A [N m]"),
                                 (axes[1][column], ("joint.leg1.B.fx", "joint.leg1.B.fy"), "force in leg1.B [N]")):
            size = (lambda row: row[0]) if len(names) == 1 else (lambda row: math.hypot(*row))
            for one, style in ((run, dict(color=STYLE[mechanism]["color"], linewidth=0.7)),
                               (ideal, dict(color="black", linestyle="--", linewidth=1.2))):
                turn, *columns = thinned(*last_turn(one, *names))
                ax.plot(turn, [size(row) for row in zip(*columns)], label="ideal" if one is ideal else "clearance",
                        **style)
            ax.set_title("%s: %s" % (mechanism, title), fontsize=9)
            ax.legend(fontsize=8)
        axes[1][column].set_xlabel("place on the circle, third turn [deg]")
    save(figure, folder, "loads")


def trends(plan, static, runs, folder):
    rows = [("largest position error [um]", lambda run: 1e6 * run.path()["max_position"]),
            ("rms joint force, worst joint [N]", lambda run: run.over_joints("rms_force")),
            ("largest joint force [N]", lambda run: run.over_joints("max_force")),
            ("out of contact, worst joint [%]", lambda run: 100 * (1 - run.over_joints("contact_fraction", min)))]
    figure, axes = plt.subplots(len(rows), 3, figsize=(11, 11), sharey="row")
    for row, (title, value) in zip(axes, rows):
        for ax, name in zip(row, plan["series"]):
            for mechanism in static:
                points = series_of(plan, runs, mechanism, name)
                ax.plot([SCALES[name] * at for at, _ in points], [value(run) for _, run in points], label=mechanism,
                        marker=MARK[mechanism], **STYLE[mechanism])
            if name == "T":
                ax.set_xscale("log")
                ax.set_xticks(plan["series"][name], ["%g" % at for at in plan["series"][name]])
                ax.minorticks_off()
        row[0].set_ylabel(title, fontsize=9)
        row[0].set_ylim(bottom=0)  # of the whole row
    for ax, name in zip(axes[-1], plan["series"]):
        ax.set_xlabel(NAMES[name])
    axes[0][0].legend(fontsize=8)
    save(figure, folder, "trends")


def draw(plan, static, runs, folder):
    matplotlib.rcParams.update({"svg.hashsalt": "freeplay", "font.size": 9, "svg.fonttype": "none",
                                "path.simplify_threshold": 0.3})
    maps(plan, static, folder)
    bounds(static, folder)
    errors(plan, static, runs, folder)
    orbits(plan, static, runs, folder)
    loads(plan, static, runs, folder)
    trends(plan, static, runs, folder)
