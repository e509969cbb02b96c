"""Checkpoints of simulations: another one goes on from them to the same bits, with the rows, events and inputs before it."""
import pathlib
import subprocess
import sys
import unittest

import freeplay
from in_folder import SLIDER, InFolder, same_bits
from resume_test import ROD, summary_of


class Checkpoints(InFolder):
    def same_end(self, model, first, rest, at):
        """`first` leads to the checkpoint, `rest` from there to the end."""
        whole = model.simulation()
        first(whole), rest(whole)
        begun = model.simulation()
        first(begun)
        kept = begun.checkpoint()
        begun.advance()  # whatever becomes of it
        again = model.simulation(checkpoint=kept)
        self.assertEqual(at, again.time)
        rest(again)
        self.assertTrue(whole.done and again.done)
        a, b = whole.result(), again.result()
        self.assertTrue(same_bits(a.data, b.data))
        self.assertEqual(a.events.tolist().__repr__(), b.events.tolist().__repr__())
        a.save("a", force=True), b.save("b", force=True)
        self.assertEqual(summary_of("a"), summary_of("b"))
        for name in ("results.csv", "events.csv", *(["inputs.csv"] if model.inputs else [])):
            self.assertEqual(pathlib.Path("a", name).read_bytes(), pathlib.Path("b", name).read_bytes(), name)

    def test_impacts(self):
        for options in ({"end": "2 ms"}, {"end": "2 ms", "accuracy": "1 um"}):
            model = freeplay.load(SLIDER, **options)
            stop = model.simulation()
            stop.step(300)
            self.same_end(model, lambda sim: sim.step(300), lambda sim: sim.advance(), stop.time)

    def test_between_output_instants_and_with_an_effort_that_no_step_has_seen(self):
        def first(sim):
            sim.set("motor", 1.5)
            sim.advance("13.7 ms")
            sim.set("motor", -2.0)

        def rest(sim):
            self.assertEqual({"motor": -2.0}, sim.inputs)
            sim.advance("50 ms")
            sim.set("motor", 0.25)
            sim.advance()
        for options in ({}, {"accuracy": "1 um"}):
            self.same_end(freeplay.load(ROD, **options), first, rest, 0.0137)

    def test_at_the_start(self):
        self.same_end(freeplay.load(ROD), lambda sim: None, lambda sim: sim.advance(), 0.0)

    def test_in_another_process(self):
        pathlib.Path("rod.yaml").write_text(ROD)
        sim = freeplay.load("rod.yaml").simulation()
        sim.advance(rows=7)
        pathlib.Path("kept").write_bytes(sim.checkpoint())
        code = ("import freeplay, pathlib; sim = freeplay.load('rod.yaml').simulation(checkpoint=pathlib.Path('kept').read_bytes())\n"
                "sim.advance(); sim.result().save('there')")
        self.assertEqual(0, subprocess.run([sys.executable, "-c", code]).returncode)
        sim.advance()
        self.assertTrue(same_bits(sim.result().data, freeplay.open("there").data))

    def test_what_does_not_fit_is_refused(self):
        rod = freeplay.load(ROD)
        sim = rod.simulation()
        sim.advance(rows=3)
        kept = sim.checkpoint()
        for other in (freeplay.load(SLIDER), rod.replace(end="0.3 s"), rod.replace(step="2 ms"), rod.replace(channels=["joint.*"]),
                      freeplay.load(ROD.replace("1 kg,", "2 kg,"))):
            with self.assertRaises(freeplay.ModelError) as raised:
                other.simulation(checkpoint=kept)
            self.assertEqual("resume-mismatch", raised.exception.messages[-1].id)
        for damaged in (b"", b"x", kept[:-1], kept[:200] + b"\0" + kept[201:]):
            self.assertRaises(freeplay.ResultError, rod.simulation, checkpoint=damaged)
        self.assertRaises(TypeError, rod.simulation, checkpoint="kept")
        self.assertRaises(freeplay.UsageError, rod.simulation, checkpoint=kept, out="x")
        self.assertFalse(pathlib.Path("x").exists())
        sim.close()
        self.assertRaisesRegex(freeplay.UsageError, "over", sim.checkpoint)


if __name__ == "__main__":
    unittest.main()
