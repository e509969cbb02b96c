"""Pages of results as a browser shows them."""
import base64
import json
import math
import os
import re
import signal
import subprocess
import tempfile
import time
import unittest

from browser import Browser, needs_browser
from page_reader import Page, numbers
from program import PROGRAM, ROOT, ProgramTest, mechanism

LEFT, RIGHT, HOME, END = "\ue012", "\ue014", "\ue011", "\ue010"
PICTURE = """const c = document.getElementById('scene'), d = c.getContext('2d', {willReadFrequently: true}).getImageData(0, 0, c.width, c.height).data;
let h = 0, n = 0;
for (let i = 0; i < d.length; i += 4) { const v = d[i] * 65536 + d[i + 1] * 256 + d[i + 2]; h = (h * 31 + v) | 0; if (v !== d[0] * 65536 + d[1] * 256 + d[2]) ++n; }
return [h, n];"""


def pointed(document, pointer):
    for part in pointer.split("/")[1:]:
        document = document[part.replace("~1", "/").replace("~0", "~")]
    return document


@needs_browser
class ReportInBrowser(ProgramTest):
    def setUp(self):
        super().setUp()
        self.browser = Browser()
        self.addCleanup(self.browser.close)

    def open(self, *models, options=(), more=()):
        """Runs models and opens their page, which may complain of nothing and ask for nothing."""
        for name in models:
            self.freeplay("run", mechanism(name), "--quiet", "--out", name.replace("/", "-"), *options)
        self.results = [name.replace("/", "-") for name in models]
        self.freeplay("report", *self.results, "--out", "page.html", "--force", *more)
        self.page = Page(self.read("page.html"))
        self.browser.open(self.path("page.html"))
        requests = self.browser.requests()
        self.assertTrue(any("page.html" in url for url in requests))
        self.assertEqual([], [url for url in requests if re.match("(https?|ftp|wss?):", url)])

    def tearDown(self):
        bad = [entry["message"] for entry in self.browser.log("browser") if entry["level"] in ("SEVERE", "WARNING") and "willReadFrequently" not in entry["message"]]
        self.assertEqual([], bad)

    def script(self, text, *arguments):
        return self.browser.script(text, *arguments)

    def picture(self):
        time.sleep(0.1)
        return self.script(PICTURE)

    def test_every_number_is_that_of_the_results(self):
        self.open("3-rrr", "4-rrr", options=("--end", "0.15 s", "--twin"))
        summaries = [json.loads(self.read(result, "summary.json")) for result in self.results]
        shown = self.script("return [...document.querySelectorAll('[data-path]')].map(e => [+e.dataset.run, e.dataset.path, e.dataset.value, e.textContent])")
        self.assertGreater(len(shown), 200)
        self.assertEqual({0, 1}, {run for run, *_ in shown})
        scales = {"p": 1e-12, "n": 1e-9, "µ": 1e-6, "m": 1e-3, "k": 1e3, "M": 1e6, "G": 1e9}
        for run, path, value, text in shown:
            self.assertEqual(pointed(summaries[run], path), float(value), path)
            found = re.fullmatch(r"~?(\u2212?[\d.]+(?:e\u2212?\d+)?)(?:\u00a0(.*))?", text)
            self.assertTrue(found, text)
            number, unit = float(found[1].replace("\u2212", "-")), found[2] or ""
            if unit == "%":
                number /= 100
            elif unit == "deg":
                number *= 3.14159265358979 / 180
            elif len(unit) > 1 and unit[0] in scales and not re.match("(m/s|mol|min)", unit):
                number *= scales[unit[0]]
            self.assertAlmostEqual(number, float(value), delta=0.051 * abs(float(value)) + 1e-300, msg="%s reads %s" % (path, text))

    def cells(self, section):
        """Texts of the rows of its tables by their first cell."""
        rows = self.script("return [...document.querySelectorAll('#' + arguments[0] + ' tr')].map(r => [...r.children].map(c => c.textContent))", section)
        return {cells[0]: cells[1:] for cells in rows}

    def test_facts_say_how_far_a_run_may_be_trusted(self):
        self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "14 ms", "--accuracy", "1 um", "--verify", "--out", "r")
        self.freeplay("report", "r", "--out", "page.html")
        self.browser.open(self.path("page.html"))
        facts, summary = self.cells("facts"), json.loads(self.read("r", "summary.json"))
        self.assertEqual(["1\u00a0µm"], facts["Accuracy"])
        self.assertEqual([summary["time"]["smallest_step"], summary["time"]["largest_step"]],
                         self.script("return [...document.querySelectorAll('#facts [data-path^=\"/time/\"][data-path$=step]')].map(e => +e.dataset.value)"))
        self.assertIn(summary["verification"]["method"], facts["Second run"][0])
        self.assertIn("Sums are of the whole run", self.script("return document.getElementById('energy').innerText"))
        self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "14 ms", "--repeat", "2", "--out", "s")
        self.freeplay("report", "s", "--out", "page.html", "--force")
        self.browser.open(self.path("page.html"))
        self.assertRegex(self.script("return document.getElementById('clearance').innerText"), r"\([\d.]+\u00a0kN to [\d.]+\u00a0kN in 2 runs\)")

    def test_a_page_has_the_forces_of_a_model_and_no_empty_tables(self):
        self.write("spring.yaml", "freeplay: 1\nname: spring\nbodies: {b: {mass: 1, inertia: 1}}\njoints: {g: {type: prismatic, between: [ground, b]}}\n"
                   "forces: {s: {type: spring-damper, between: [ground, b], stiffness: 100 N/m, damping: 1 N*s/m, free_length: 0.2 m}}\n"
                   "initial: {joints: {g: 0.3 m}}\nsimulation: {end: 1 s, step: 1 ms}\n")
        self.freeplay("run", "spring.yaml", "--quiet", "--out", "r")
        self.freeplay("report", "r", "--out", "page.html")
        self.browser.open(self.path("page.html"))
        self.assertEqual([], self.script("return [...document.querySelectorAll('table')].filter(t => t.tHead && t.tHead.innerText.trim() && !t.tBodies.length).map(t => t.innerText)"))
        work = json.loads(self.read("r", "summary.json"))["forces"]["s"]["work"]
        self.assertEqual([work], self.script("return [...document.querySelectorAll('#energy [data-path=\"/forces/s/work\"]')].map(e => +e.dataset.value)"))
        self.assertFalse(self.script("return !!document.getElementById('advice')"))

    def test_a_sealed_result_has_no_verdict(self):
        with subprocess.Popen([PROGRAM, "run", mechanism("slider-crank"), "--quiet", "--end", "100 s", "--out", "r"], cwd=self.folder, stderr=subprocess.DEVNULL) as process:
            time.sleep(1.5)
            process.send_signal(signal.SIGKILL)
        self.freeplay("seal", "r")
        self.freeplay("report", "r", "--out", "page.html")
        self.browser.open(self.path("page.html"))
        self.assertEqual("! no verdict", self.script("return document.querySelector('.chip').textContent"))

    def side(self):
        return {cells[0]: cells[1:] for cells in self.script("return [...document.querySelectorAll('#side tr')].map(r => [...r.children].map(c => c.textContent))")}

    def test_runs_side_by_side_need_not_have_the_same(self):
        self.write("fall.yaml", "freeplay: 1\nname: fall\nbodies: {b: {mass: 1, inertia: 1}}\njoints: {p: {type: revolute, between: [ground, b]}}\n"
                   "simulation: {end: 10 ms, step: 1 ms}\n")
        self.freeplay("run", "fall.yaml", "--quiet", "--out", "fall")
        for name in ("slider-crank", "spatial/stewart"):
            self.freeplay("run", mechanism(name), "--quiet", "--end", "14 ms", "--out", os.path.basename(name))
        stewart = json.loads(self.read("stewart", "summary.json"))["drivers"]
        for order in (("fall", "slider-crank", "stewart"), ("stewart", "slider-crank", "fall")):
            self.freeplay("report", *order, "--out", "page.html", "--force")
            self.browser.open(self.path("page.html"))
            text = self.script("return document.body.innerText")
            for wrong in ("[object", "NaN", "undefined", "Infinity"):
                self.assertNotIn(wrong, text)
            side, at = self.side(), order.index("stewart")
            for name in stewart:
                self.assertRegex(side[name + ", largest effort"][at], r"^[\d.]+\u00a0k?N( \u00b1|$)")
                self.assertEqual(["\u2013"] * 2, [cell for k, cell in enumerate(side[name + ", rms effort"]) if k != at])
            self.assertRegex(side["motor, largest effort"][1], r"^[\d.]+\u00a0[mk]?N\u00b7m( \u00b1|$)")
            self.assertEqual("\u2013", side["largest penetration"][order.index("fall")])

    def test_the_cursor_shows_the_row_of_its_frame(self):
        self.open("slider-crank")
        header, *rows = (line.split(",") for line in self.read("slider-crank", "results.csv").splitlines())
        run = self.page.runs[0]
        names = ["body.slider.x", "joint.wrist.fn", "driver.motor.torque"]
        self.script("freeplay.select(arguments[0])", names)
        self.assertGreaterEqual(self.script("return document.querySelectorAll('#graphs .plot canvas').length"), 3)
        for row in numbers(run["animation"]["rows"], "i")[::150]:
            at = float(rows[row][0])
            self.assertEqual(at, self.script("return freeplay.seek(arguments[0])", at * 1.00001))
            for name in names:
                got = self.script("return +document.querySelector('#now [data-channel=\"' + arguments[0] + '\"]').dataset.value", name)
                channel = next(c for c in run["channels"] if c["name"] == name)
                slack = 1.3e-7 * (channel["max"] - channel["min"])
                self.assertAlmostEqual(float(rows[row][header.index(name)]), got, delta=slack)
                self.assertEqual(got, self.script("return freeplay.value(0, arguments[0])", name))

    def test_it_plays_scrubs_and_obeys_keys(self):
        self.open("slider-crank", "pendulum")
        times = numbers(self.page.runs[0]["animation"]["times"], "d")
        first, last = self.script("return freeplay.seek(-1)"), self.script("return freeplay.seek(1e9)")
        self.assertEqual((times[0], times[-1]), (first, last))
        before, drawn = self.script("freeplay.seek(0); freeplay.play(); return [freeplay.time(), freeplay.drawn()]")
        time.sleep(1)
        after, more = self.script("freeplay.pause(); return [freeplay.time(), freeplay.drawn()]")
        self.assertGreater(after, before)
        self.assertGreater(more, drawn + 5)
        self.script("freeplay.seek(arguments[0])", times[100])
        for key, shift, frame in ((RIGHT, False, 101), (LEFT, False, 100), (RIGHT, True, 110), (HOME, False, 0), (END, False, len(times) - 1)):
            self.browser.key(key, shift=shift)
            self.assertEqual(times[frame], self.script("return freeplay.time()"))
        self.script("const e = document.getElementById('scrub'); e.value = 50; e.dispatchEvent(new Event('input'))")
        self.assertEqual(times[50], self.script("return freeplay.time()"))
        self.browser.key(" ")
        time.sleep(0.3)
        self.assertNotEqual(times[50], self.script("return freeplay.time()"))
        self.browser.key(" ")
        speed = self.script("return +document.getElementById('speed').value")
        self.browser.key("+")
        self.assertGreater(self.script("return +document.getElementById('speed').value"), speed)
        factor = self.script("return +document.getElementById('exaggerate').value")
        self.browser.key("E")
        self.assertGreater(self.script("return +document.getElementById('exaggerate').value"), factor)
        self.browser.key("e")
        self.assertEqual(factor, self.script("return +document.getElementById('exaggerate').value"))
        for opened in (True, False):
            self.browser.key("?")
            self.assertEqual(opened, self.script("return document.getElementById('keys').open"))
        light = self.script("return getComputedStyle(document.body).backgroundColor")
        self.browser.key("t")
        self.assertNotEqual(light, self.script("return getComputedStyle(document.body).backgroundColor"))

    def test_the_picture_follows_time_and_play(self):
        self.open("slider-crank")
        seen = set()
        for act in ("freeplay.seek(0)", "freeplay.seek(0.006)", "const e = document.getElementById('exaggerate'); e.value = 200; e.dispatchEvent(new Event('input'))",
                    "document.getElementById('forces').click()", "document.getElementById('labels').click()",
                    "const e = document.getElementById('trace'); e.value = 'coupler'; e.dispatchEvent(new Event('change'))"):
            self.script(act)
            drawn, points = self.picture()
            self.assertGreater(points, 500)
            self.assertNotIn(drawn, seen, act)
            seen.add(drawn)
        self.assertEqual("wrist", self.script("return document.querySelector('canvas.orbit').dataset.joint"))
        self.script("document.querySelector('#impacts tr.pick').click()")
        impact = self.page.runs[0]["events"]["rows"][0][0]
        step = 0.024 / 599
        self.assertAlmostEqual(impact, self.script("return freeplay.time()"), delta=step)

    def test_plots_zoom_together(self):
        self.open("slider-crank")
        self.script("freeplay.zoom(0.006, 0.012)")
        self.assertEqual([0.006, 0.012], self.script("return freeplay.range()"))
        labels = "return [...document.querySelectorAll('.plot')].map(p => [...p.querySelectorAll('.dygraph-axis-label-x')].map(e => e.textContent).join())"
        shown = self.script(labels)
        self.assertGreater(len(shown), 2)
        self.assertEqual(1, len(set(shown[:2])))
        self.script("document.getElementById('graphs').scrollIntoView()")
        self.browser.drag("#graphs .plot", (0.5, 0.5), (0.75, 0.5))
        time.sleep(0.2)
        begin, end = self.script("return freeplay.range()")
        self.assertTrue(0.006 < begin < end < 0.012, (begin, end))
        self.assertEqual(1, len(set(self.script(labels)[:2])))
        self.browser.key("z")
        self.assertEqual([0, 0.024], self.script("return freeplay.range()"))

    def test_dark_print_names_and_small_screens(self):
        self.open("slider-crank")
        paper = "return getComputedStyle(document.body).backgroundColor"
        light = self.script(paper)
        self.browser.command("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
        time.sleep(0.3)
        self.assertNotEqual(light, self.script(paper))
        self.browser.open(self.path("page.html"))
        self.assertNotEqual(light, self.script(paper))
        self.browser.command("Emulation.setEmulatedMedia", media="print", features=[])
        self.assertEqual(light, self.script(paper))
        self.assertEqual(0, self.script("return document.getElementById('play').getClientRects().length"))
        self.assertGreater(self.script("return document.querySelector('#model pre').getClientRects().length"), 0)
        self.browser.command("Emulation.setEmulatedMedia", media="", features=[])
        unnamed = "return [...document.querySelectorAll('canvas')].filter(c => !c.getAttribute('aria-label') && !c.closest('[aria-label]')).length"
        self.assertEqual(0, self.script(unnamed))
        unnamed = "return [...document.querySelectorAll('button, input, select')].filter(e => !e.textContent.trim() && !e.getAttribute('aria-label') && !e.closest('label') && e.getClientRects().length).length"
        self.assertEqual(0, self.script(unnamed))
        for width in (360, 800, 1280):
            self.browser.command("Emulation.setDeviceMetricsOverride", width=width, height=800, deviceScaleFactor=1, mobile=False)
            self.assertLessEqual(self.script("return document.documentElement.scrollWidth"), width)

    def test_every_picture_is_on_paper(self):
        self.open("slider-crank")
        self.script("document.documentElement.dataset.theme = 'dark'")
        time.sleep(0.3)
        pictures = self.script("return document.querySelectorAll('#scene, .orbit, .polar, .plot, .spectrum').length")
        self.assertGreater(pictures, 4)
        paper = base64.b64decode(self.browser.command("Page.printToPDF", printBackground=True)["data"])
        # Each has a mask besides; an empty canvas is left out.
        self.assertGreaterEqual(len(re.findall(rb"/Subtype\s*/Image", paper)), 2 * pictures)

    def test_tables_of_eight_runs_fit(self):
        for k in range(8):
            self.freeplay("run", mechanism("slider-crank"), "--quiet", "--end", "2 ms", "--set", "c=%d um" % (500 + k), "--out", "r%d" % k)
        self.freeplay("report", *("r%d" % k for k in range(8)), "--out", "page.html")
        self.browser.open(self.path("page.html"))
        for section in ("side", "facts", "plots", "clearance"):
            self.assertLessEqual(self.script("const e = document.querySelector('#' + arguments[0] + ' .wide'); return e.scrollWidth - e.clientWidth", section), 0, section)
        self.assertEqual([8] * 2, self.script("return [...document.querySelectorAll('#side tr')].slice(0, 2).map(e => e.querySelectorAll('.number').length)"))

    def test_the_command_is_copied(self):
        self.open("slider-crank", options=("--end", "1 ms"))
        self.script("document.querySelector('#model button').scrollIntoView({block: 'center'})")
        self.browser.drag("#model button", (0.5, 0.5), (0.5, 0.5))
        time.sleep(0.3)
        self.assertEqual("Copied", self.script("return document.querySelector('#model button').textContent"))

    def test_gaps_of_values_that_are_no_numbers(self):
        self.write("r.csv", "time,a\n0,1\n1,inf\n2,3\n3,nan\n4,5\n")
        self.freeplay("report", "r.csv", "--out", "page.html")
        self.browser.open(self.path("page.html"))
        shown = self.script("freeplay.select(['a']); return [0, 1, 2, 3, 4].map(t => { freeplay.seek(t); return document.querySelector('#now span').textContent; })")
        self.assertEqual(["1", "\u2013", "3", "\u2013", "5"], shown)
        self.write("r.csv", "time,a,b,c\n0,1,,1\n1,inf,nan,2\n2,3,,3\n")
        self.freeplay("report", "r.csv", "--out", "page.html")
        self.browser.open(self.path("page.html"))
        heads = self.script("freeplay.select(['a', 'b', 'c']); return [...document.querySelectorAll('#graphs figcaption')].map(e => e.textContent)")
        self.assertIn("(1 of 3 rows without a number)", heads[0])
        self.assertIn("(3 of 3 rows without a number)", heads[1])
        self.assertNotIn("without", heads[2])

    def labels(self, plot):
        return self.script("return [...document.querySelectorAll(arguments[0] + ' .dygraph-axis-label-y')].map(e => e.textContent)", plot)

    def test_labels_tell_values_apart(self):
        self.write("r.csv", "time,a\n" + "".join("%r,%r\n" % (100 + 1e-6 * k, 1.000001 + 1e-8 * k) for k in range(100)))
        self.freeplay("report", "r.csv", "--out", "page.html")
        self.browser.open(self.path("page.html"))
        self.script("freeplay.select(['a'])")
        shown = self.labels(".plot")
        self.assertEqual(sorted(set(shown)), shown[::-1] if shown[0] > shown[-1] else shown)
        self.assertGreater(len(shown), 2)
        self.assertTrue(all(1.0000009 < float(label) < 1.0000021 for label in shown), shown)
        times = self.script("return [...document.querySelectorAll('.plot .dygraph-axis-label-x')].map(e => e.textContent)")
        self.assertEqual(len(times), len(set(times)))
        self.open("slider-crank")
        self.assertIn("N·m", self.script("return document.querySelector('#spectra figcaption').textContent"))
        decades = [float(label) for label in self.labels(".spectrum")]
        self.assertGreater(len(decades), 3)
        self.assertTrue(all(abs(math.log10(value) % 1) < 1e-9 for value in decades), decades)

    def test_space_is_turned_by_mouse_and_keys(self):
        self.open("spatial/stewart")
        self.script("document.getElementById('mechanism').scrollIntoView()")
        seen = {self.picture()[0]}
        self.browser.drag("#scene", (0.3, 0.4), (0.5, 0.5))
        seen.add(self.picture()[0])
        self.script("document.getElementById('scene').focus()")
        at = self.script("return freeplay.time()")
        self.browser.key(RIGHT)
        seen.add(self.picture()[0])
        self.assertEqual(3, len(seen))
        self.assertEqual(at, self.script("return freeplay.time()"))
        begun = self.script("freeplay.play(); return freeplay.drawn()")
        time.sleep(1)
        self.assertGreater(self.script("freeplay.pause(); return freeplay.drawn()"), begun + 5)

    def test_results_that_are_not_whole(self):
        self.open("slider-crank", options=("--format", "csv", "--end", "6 ms"))
        lines = self.read("slider-crank", "results.csv").splitlines()
        name = lines[0].split(",").index("joint.wrist.fn")
        emptied = [",".join("" if i == name else cell for i, cell in enumerate(line.split(","))) for line in lines[1:]]
        self.write("slider-crank/results.csv", "\n".join([lines[0], *emptied]) + "\n")
        self.write("slider-crank/summary.json", "{")
        self.freeplay("report", "slider-crank", "--out", "page.html")
        self.browser.open(self.path("page.html"))
        self.assertIn("summary.json is damaged", self.script("return document.getElementById('verdicts').textContent"))
        self.assertEqual("\u2013", self.script("freeplay.select(['joint.wrist.fn']); return document.querySelector('#now span').textContent"))
        self.write("alone.csv", self.read("slider-crank", "results.csv"))
        self.freeplay("report", "alone.csv", "--out", "page.html")
        self.browser.open(self.path("page.html"))
        self.assertGreater(self.script("return document.querySelectorAll('.plot canvas').length"), 1)

    def test_the_picture_in_the_documentation_is_this_page(self):
        self.open("4-rrr")
        self.browser.command("Emulation.setDeviceMetricsOverride", width=1280, height=1000, deviceScaleFactor=1, mobile=False)
        self.script("freeplay.seek(0.3836); document.getElementById('forces').click(); document.getElementById('mechanism').scrollIntoView()")
        time.sleep(0.5)
        top = self.script("return document.getElementById('mechanism').getBoundingClientRect().y + scrollY")
        made, documented = self.browser.screenshot(0, top - 12, 1280, 760), os.path.join(ROOT, "docs", "images", "report.png")
        with open(documented, "rb") as file:
            pictures = [base64.b64encode(data).decode() for data in (made, file.read())]
        # Other machines have other fonts: text is some percent of the picture.
        differ = self.browser.ask("POST", "/execute/async", {"script": """const done = arguments[2], pixels = [];
for (const [k, data] of [arguments[0], arguments[1]].entries()) {
  const image = new Image();
  image.onload = () => {
    const canvas = document.createElement('canvas'), c = canvas.getContext('2d');
    canvas.width = image.width; canvas.height = image.height;
    c.drawImage(image, 0, 0);
    pixels[k] = c.getImageData(0, 0, canvas.width, canvas.height).data;
    if (!pixels[0] || !pixels[1]) return;
    let n = pixels[0].length === pixels[1].length ? 0 : Infinity;
    for (let i = 0; i < pixels[0].length; i += 4) if (Math.abs(pixels[0][i + 1] - pixels[1][i + 1]) > 48) ++n;
    done(n / (pixels[0].length / 4));
  };
  image.src = 'data:image/png;base64,' + data;
}""", "args": pictures})
        if differ is None or differ > 0.05:
            now = os.path.join(tempfile.gettempdir(), "report.png")
            with open(now, "wb") as file:
                file.write(made)
            self.fail("%s of %s differ from the page as it is now, which is in %s: look at it, and put it there" % (
                "all" if differ is None else "%.1f %%" % (100 * differ), documented, now))

    def test_film_is_recorded(self):
        self.open("slider-crank", options=("--end", "2 ms"))
        self.script("""window.film = null;
HTMLAnchorElement.prototype.click = function () { window.film = [this.download, this.href]; };
document.getElementById('speed').value = '0.005'; document.getElementById('speed').dispatchEvent(new Event('change'));
document.getElementById('record').click();""")
        until = time.time() + 20
        while not (film := self.script("return window.film")) and time.time() < until:
            time.sleep(0.2)
        self.assertEqual("slider-crank.webm", film[0])
        self.assertTrue(film[1].startswith("blob:"))


if __name__ == "__main__":
    unittest.main()
