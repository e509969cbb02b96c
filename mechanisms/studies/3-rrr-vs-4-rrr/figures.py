"""Figures that go across runs; those of single runs are drawn by the program. Lines differ in their styles, so that they can be
read in print."""
import os

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402  the backend comes first

STYLE = {"3-rrr": dict(color="#d55e00", linestyle="-"), "4-rrr": dict(color="#0072b2", linestyle="--")}
MARK = {"3-rrr": "o", "4-rrr": "s"}
NAMES = {"c": "radial clearance [mm]", "T": "time for one turn [s]", "mu": "friction coefficient"}
SCALES = {"c": 1e3, "T": 1.0, "mu": 1.0}


def save(figure, folder, name):
    figure.tight_layout()
    # Neither date nor random ids: the same numbers make the same bytes.
    figure.savefig(os.path.join(folder, name + ".svg"), metadata={"Date": None})
    plt.close(figure)


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
    bounds(static, folder)
    trends(plan, static, runs, folder)
