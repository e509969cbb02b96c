"""Inertias, axes and rotations that are none in space, or that belong to the plane, are refused where they stand."""
import json
import unittest

from model_cases import ModelTest


class SpatialMistakes(ModelTest):
    BODY = "space: spatial\nbodies: {rod: {mass: 1, inertia: %s}}\n"

    def test_impossible_inertias_are_refused_with_their_numbers(self):
        errors = self.refusal(self.BODY % "[1, 1, 3]", id="out-of-range", line=3)
        self.assertIn("1, 1, 3", errors[0]["message"])
        self.refusal(self.BODY % "[1, 1, 1, 2, 0, 0]", id="out-of-range", line=3)
        self.refusal(self.BODY % "[[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]", id="out-of-range", line=3)
        self.refusal(self.BODY % "0.1", id="wrong-type", line=3)
        self.refusal(self.BODY % "[1, 2]", id="wrong-type", line=3)

    def test_axes_and_types_are_judged_by_the_space(self):
        joint = self.BODY % "[1, 1, 1]" + "joints: {A: {type: %s, between: [ground, rod]%s}}\n"
        self.refusal(joint % ("revolute", ", axis: [0, 0, 0]"), id="out-of-range", line=4)
        self.refusal(joint % ("revolute", ", axis: [0, 1]"), id="wrong-length", line=4)
        self.refusal(joint % ("spherical", ", axis: [0, 0, 1]"), id="unknown-key", line=4)
        flat = "bodies: {rod: {mass: 1, inertia: 1}}\njoints: {A: {type: %s, between: [ground, rod]%s}}\n"
        self.refusal(flat % ("spherical", ""), id="type-space", line=3)
        self.refusal(flat % ("revolute", ", axis: [0, 0, 1]"), id="unknown-key", line=3)

    def warnings(self, text):
        verdict = json.loads(self.freeplay("validate", self.model(text), "--json")[0])
        return [(one["id"], one["line"], one["message"]) for one in verdict["messages"]]

    def test_directions_of_other_lengths_are_normalised_with_a_note(self):
        joint = self.BODY % "[1, 1, 1]" + "joints: {A: {type: revolute, between: [ground, rod], axis: %s}}\n"
        self.assertEqual([("not-unit", 4, "the axis has length 2: made one of length 1")],
                         self.warnings(joint % "[0, 2, 0]"))
        for unit in ("[0, 1, 0]", "[0.6, 0.8, 0]", "[0.70710678, 0.70710678, 0]"):
            self.assertEqual([], self.warnings(joint % unit))
        turned = "space: spatial\nbodies: {rod: {mass: 1, inertia: [1, 1, 1], pose: {quaternion: %s}}}\n"
        self.assertEqual([("not-unit", 3, "the quaternion has length 5: made one of length 1")],
                         self.warnings(turned % "[3, 0, 0, 4]"))
        self.assertEqual([], self.warnings(turned % "[0.6, 0, 0, 0.8]"))

    def test_vectors_and_inertias_of_the_plane_are_refused_where_they_stand(self):
        for text, line in (("space: spatial\ngravity: [0, -9.81]\n", 3),
                           ("space: spatial\nbodies:\n  rod: {mass: 1, inertia: [1, 1, 1], com: [0, 0]}\n", 4),
                           ("bodies:\n  rod: {mass: 1, inertia: 1, com: [0, 0, 0]}\n", 3)):
            self.refusal(text, id="wrong-length", line=line)
        self.refusal("bodies:\n  rod: {mass: 1, inertia: [1, 1, 1]}\n", id="wrong-type", line=3)
        errors = self.refusal(self.BODY % "[1, 1, -0.5]", id="out-of-range", line=3)
        self.assertIn("(-0.5, 1, 1)", errors[0]["message"])
        self.refusal(self.BODY % "[0, 0, 0]", id="singular-mass", line=3)

    def test_rotations_need_the_keys_of_the_space(self):
        self.refusal("space: spatial\nbodies: {rod: {mass: 1, inertia: [1, 1, 1], pose: {angle: 1}}}\n",
                     id="unknown-key", line=3)
        self.refusal("space: spatial\nbodies: {rod: {mass: 1, inertia: [1, 1, 1], pose: {quaternion: [0, 0, 0, 0]}}}\n",
                     id="out-of-range", line=3)
        self.refusal("bodies: {rod: {mass: 1, inertia: 1, pose: {rpy: [0, 0, 1]}}}\n", id="unknown-key", line=2)


if __name__ == "__main__":
    unittest.main()
