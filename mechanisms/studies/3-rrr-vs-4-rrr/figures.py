"""Pictures of the mechanisms at rest and of single runs; those across runs are the `plots` of series.yaml. Lines differ in
their styles, so that they can be read in print."""
import os
import re
import subprocess

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402  the backend comes first

STYLE = {"3-rrr": dict(color="#d55e00", linestyle="-"), "4-rrr": dict(color="#0072b2", linestyle="--")}


def bounds(static, folder):
    matplotlib.rcParams.update({"svg.hashsalt": "freeplay", "font.size": 9, "svg.fonttype": "none"})
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
    figure.tight_layout()
    # Neither date nor random ids: the same numbers make the same bytes.
    figure.savefig(os.path.join(folder, "bounds.svg"), metadata={"Date": None})
    plt.close(figure)


class Pictures:
    """What the program draws, without the record of provenance, which holds the paths of this machine."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def draw(self, name, *words):
        path = os.path.join(self.folder, name + ".svg")
        where = ["--svg", path, "--out", os.devnull] if words[0] == "analyze" else ["--out", path]
        done = subprocess.run([self.program, *words, *where], capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit("freeplay %s exits %d: %s" % (" ".join(words), done.returncode, done.stderr.strip()))
        with open(path, encoding="utf-8") as file:
            text = re.sub(r"\n<metadata>.*?</metadata>", "", file.read(), flags=re.S)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def of_runs(self, runs, base):
        """The last turn at the base values."""
        loose = {m: run for (m, name, value), run in runs.items() if name == "c" and value == base["c"]}
        first, second = loose
        end = loose[first].end()
        window = ["--from", "%r s" % (end - base["T"]), "--until", "%r s" % end]
        self.draw("errors", "plot", loose[first].folder, "driver.circle.ex", "driver.circle.ey", *window,
                  "--against", loose[second].folder)
        for m, run in loose.items():
            self.draw("loads-" + m, "plot", run.folder, "driver.leg1.A.torque", "joint.leg1.B.fx", *window,
                      "--against", runs[m, "ideal", base["T"]].folder)
            self.draw("orbit-" + m, "plot", run.folder, "--orbit", "leg1.B", *window, "--width", "480")
