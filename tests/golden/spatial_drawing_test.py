"""freeplay show --format svg of mechanisms in space: four views, each point where it belongs."""
import glob
import math
import os
import re
import unittest
import xml.etree.ElementTree as xml

from program import ROOT, ProgramTest, drawing

SVG = "{http://www.w3.org/2000/svg}"
VIEWS = ("top", "isometric", "front", "side")
FOLDER = os.path.join(ROOT, "mechanisms", "spatial")

# Two balls apart by (1, 2, 3) m: the one on a body of the first, the other on the ground.
BALLS = """freeplay: 1
space: spatial
gravity: %s
bodies: {rod: {mass: 1, inertia: [1, 1, 1], com: [0.5, 1, 1.5], frames: {end: [1, 2, 3]}}}
joints:
  A: {type: spherical, between: [ground, rod]}
  B: {type: spherical, between: [ground/far, rod/end]}
frames: {ground/far: [1, 2, 3]}
"""


class SpatialDrawing(ProgramTest):
    def draw(self, text):
        self.write("m.yaml", text)
        return self.freeplay("show", "m.yaml", "--format", "svg")[0]

    def views(self, text):
        groups = {group.get("id"): group for group in xml.fromstring(text).iter(SVG + "g")}
        self.assertEqual(VIEWS, tuple(groups))
        return groups

    @staticmethod
    def balls(group):
        return [(float(c.get("cx")), float(c.get("cy"))) for c in group.iter(SVG + "circle") if c.get("fill") == "#bbbbbb"]

    @staticmethod
    def scale(group):
        """Pixels per metre by the bar."""
        bars = [re.fullmatch(r"M([-0-9.]+) [-0-9.]+ v6 H([-0-9.]+) v-6", path.get("d")) for path in group.iter(SVG + "path")]
        (bar,) = [one for one in bars if one]
        (length,) = [found for found in (re.fullmatch(r"([0-9.]+) (m|mm|um)", text.text) for text in group.iter(SVG + "text")) if found]
        return (float(bar[2]) - float(bar[1])) / (float(length[1]) * {"m": 1, "mm": 1e-3, "um": 1e-6}[length[2]])

    def assert_apart(self, group, across, down):
        """The second ball from the first [px], whichever is drawn first."""
        a, b = self.balls(group)
        found = (b[0] - a[0], b[1] - a[1])
        self.assertLess(min(math.dist(found, (s * across, s * down)) for s in (1, -1)), 0.3)

    def test_each_view_shows_a_point_where_it_belongs(self):
        views = self.views(self.draw(BALLS % "[0, 0, -9.81]"))
        scale = self.scale(views["front"])
        self.assert_apart(views["front"], scale, -3 * scale)
        self.assert_apart(views["top"], scale, -2 * scale)
        self.assert_apart(views["side"], 2 * scale, -3 * scale)
        # Seen from x = -y = z: right (1, 1, 0), up (-1, 1, 2).
        a, b = self.balls(views["isometric"])
        across, down = abs(b[0] - a[0]), abs(b[1] - a[1])
        self.assertLess(abs(across / down - (1 + 2) / math.sqrt(2) / ((-1 + 2 + 6) / math.sqrt(6))), 0.01)

    def test_views_to_one_scale_stand_in_line(self):
        views = self.views(self.draw(BALLS % "[0, 0, -9.81]"))
        for one, other, part in (("front", "top", 0), ("front", "side", 1)):
            places = [sorted(ball[part] for ball in self.balls(views[name])) for name in (one, other)]
            for p, q in zip(*places):
                self.assertLess(abs(p - q), 0.2)

    def test_up_is_against_gravity(self):
        # y is up: front shows x and y, top x and -z, side -z and y.
        views = self.views(self.draw(BALLS % "[0, -9.81, 0]"))
        scale = self.scale(views["front"])
        self.assert_apart(views["front"], scale, -2 * scale)
        self.assert_apart(views["top"], scale, 3 * scale)
        self.assert_apart(views["side"], -3 * scale, -2 * scale)

    def test_every_view_says_what_it_is_and_names_the_axes(self):
        views = self.views(self.draw(BALLS % "[0, 0, -9.81]"))
        titles = {"top": "top, seen along -z", "front": "front, seen along +y", "side": "side, seen along -x",
                  "isometric": "isometric"}
        for name, group in views.items():
            texts = [text.text for text in group.iter(SVG + "text")]
            for word in (titles[name], "x", "y", "z", "rod", "A", "B"):
                self.assertIn(word, texts)

    def test_names_stay_within_their_view(self):
        for path in glob.glob(os.path.join(FOLDER, "*.yaml")):
            out, _ = self.freeplay("show", path, "--format", "svg")
            for group in self.views(out).values():
                box = re.match(r"M([-0-9.]+) ([-0-9.]+) H([-0-9.]+) V([-0-9.]+)", group.find(SVG + "path").get("d"))
                left, top, right, bottom = map(float, box.groups())
                for text in group.iter(SVG + "text"):
                    self.assertTrue(left <= float(text.get("x")) <= right, text.text)
                    self.assertTrue(top <= float(text.get("y")) <= bottom, text.text)

    def test_symbols_show_what_a_joint_leaves_free(self):
        model = """freeplay: 1
space: spatial
bodies: {a: {mass: 1, inertia: [1, 1, 1], frames: {end: [1, 0, 0]}}}
joints: {J: {type: %s, between: [ground, a]%s}}
"""
        symbols = {}
        for name, more in (("revolute", ""), ("prismatic", ""), ("cylindrical", ""), ("universal", ""), ("planar", ""),
                           ("spherical", ""), ("fixed", "")):
            front = self.views(self.draw(model % (name, more)))["front"]
            # Shapes of the joint: all that is black around.
            symbols[name] = tuple(sorted((one.tag[len(SVG):], one.get("fill")) for one in front
                                         if one.get("stroke") == "black" and one.get("r") != "4.0"))
        self.assertEqual(len(symbols), len(set(symbols.values())), symbols)
        # About y the bar is seen from its end: a ring whose two ends agree; about z from the side.
        from_end = self.views(self.draw(model % ("revolute", ", axis: [0, 1, 0]")))["front"]
        size = lambda group: [max(float(x) for x in re.findall(r"[ML]([-0-9.]+) ", path.get("d")))
                              - min(float(x) for x in re.findall(r"[ML]([-0-9.]+) ", path.get("d")))
                              for path in group.iter(SVG + "path") if path.get("stroke-width") == "1.3"]
        along = self.views(self.draw(model % ("revolute", ", axis: [1, 0, 0]")))["front"]
        self.assertLess(abs(size(from_end)[0] - 10), 0.3)
        self.assertLess(abs(size(along)[0] - 18), 0.3)

    def test_the_nearer_body_is_drawn_later_and_stronger(self):
        # Two rods on pins: the one at y = 0 is nearer in the front view, the one at z = 1 in the top view.
        views = self.views(self.draw("""freeplay: 1
space: spatial
bodies:
  near: {mass: 1, inertia: [1, 1, 1], com: [0.5, 0, 0], frames: {end: [1, 0, 0]}}
  far: {mass: 1, inertia: [1, 1, 1], com: [0.5, 0, 0], frames: {end: [1, 0, 0]}, pose: {position: [0, 1, 1]}}
joints:
  A: {type: revolute, between: [ground, near], axis: [0, 1, 0]}
  B: {type: revolute, between: [ground/away, far], axis: [0, 1, 0]}
frames: {ground/away: [0, 1, 1]}
"""))
        for name, order in (("front", ["#cc6677", "#4477aa"]), ("top", ["#4477aa", "#cc6677"])):
            bodies = [path for path in views[name].iter(SVG + "path") if path.get("stroke-width") == "7"]
            self.assertEqual(order, [path.get("stroke") for path in bodies])
            self.assertLess(float(bodies[0].get("stroke-opacity")), float(bodies[1].get("stroke-opacity")))

    def test_every_spatial_mechanism_is_drawn_the_same_each_time(self):
        for path in glob.glob(os.path.join(FOLDER, "*.yaml")):
            once, again = (self.freeplay("show", path, "--format", "svg")[0] for _ in range(2))
            self.assertEqual(once, again)
            self.assertNotIn("nan", once)
            self.views(once)

    def test_the_drawing_in_the_page_is_the_program_s(self):
        with open(os.path.join(ROOT, "docs", "images", "spatial-four-bar.svg"), encoding="utf-8") as file:
            self.assertEqual(file.read(), drawing(self.freeplay("show", os.path.join(FOLDER, "four-bar.yaml"), "--format", "svg")[0]))

    def test_play_is_a_red_ring_and_a_lone_body_a_block_of_its_moments(self):
        out, _ = self.freeplay("show", os.path.join(FOLDER, "stewart.yaml"), "--format", "svg")
        for group in self.views(out).values():
            self.assertEqual(6, sum(circle.get("stroke") == "#cc3311" and circle.get("r") == "10.0" for circle in group.iter(SVG + "circle")))
        # Moments of a block of 2 m x 4 m x 6 m and 3 kg.
        views = self.views(self.draw("freeplay: 1\nspace: spatial\nbodies: {b: {mass: 3, inertia: [13, 10, 5]}}\n"))
        scale = self.scale(views["front"])
        for name, wide, high in (("front", 2, 6), ("top", 2, 4), ("side", 4, 6)):
            (body,) = [path for path in views[name].iter(SVG + "path") if path.get("stroke-width") == "7"]
            numbers = [float(x) for x in re.findall(r"-?[0-9.]+", body.get("d"))]
            for part, expected in ((numbers[0::2], wide), (numbers[1::2], high)):
                self.assertLess(abs(max(part) - min(part) - expected * scale), 0.3)


if __name__ == "__main__":
    unittest.main()
