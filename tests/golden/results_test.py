"""Files of a result, read by other programs and exported."""
import hashlib
import importlib.util
import json
import math
import os
import resource
import shutil
import signal
import struct
import subprocess
import time
import unittest

from program import PROGRAM, ProgramTest, mechanism

MODEL = mechanism("slider-crank")


def needs(module):
    return unittest.skipUnless(importlib.util.find_spec(module), "no " + module)


def table(text):
    lines = text.splitlines()
    rows = [line.split(",") for line in lines[1:]]
    return {name: [row[i] for row in rows] for i, name in enumerate(lines[0].split(","))}


def numbers(cells):
    return [float(cell) if cell else math.nan for cell in cells]


def bits(values):
    return struct.pack("<%dd" % len(values), *values)


class Results(ProgramTest):
    def run_model(self, *options, out="r", end="5 ms"):
        self.freeplay("run", MODEL, "--quiet", "--end", end, "--out", out, *options)
        return out

    def test_a_result_has_one_owner_at_a_time(self):
        command = [PROGRAM, "run", MODEL, "--quiet", "--end", "100 s", "--out", "r"]
        with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.DEVNULL) as first:
            try:
                while not os.path.exists(self.path("r", "results.h5")):
                    time.sleep(0.02)
                log = self.read("r", "run.log")
                for force in ([], ["--force"]):
                    _, stderr = self.freeplay("run", MODEL, "--end", "1 ms", "--out", "r", *force, code=6)
                    self.assertIn("'r' is in use: process %d writes into it" % first.pid, stderr)
                    self.assertIn("[result-in-use]", stderr)
                self.assertTrue(self.read("r", "run.log").startswith(log))
            finally:
                first.send_signal(signal.SIGINT)
        self.assertEqual(130, first.returncode)
        self.run_model(end="1 ms")

    def test_text_alone_is_exported_as_hdf5(self):
        self.run_model(end="1 ms")
        shutil.copy(self.path("r", "results.csv"), self.path("plain.csv"))
        self.freeplay("export", "plain.csv", "--to", "hdf5", "--out", "plain.h5")
        self.assertEqual(self.read("plain.csv"), self.freeplay("export", "plain.h5", "--to", "csv")[0])

    def test_a_file_that_does_not_fit_on_the_disk_is_no_file(self):
        self.run_model(end="1 ms")
        self.freeplay("export", "r", "--to", "mat", "--out", "one.mat")
        # The file holds the command that made it: names of one length make files of one length.
        size = os.path.getsize(self.path("one.mat"))
        for limit in (1000, size // 2, size - 8):
            done = subprocess.run([PROGRAM, "export", "r", "--to", "mat", "--out", "cut.mat"], cwd=self.folder, capture_output=True,
                                  text=True, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
            self.assertEqual(6, done.returncode, limit)
            self.assertIn("[cannot-write]", done.stderr)
            self.assertFalse(os.path.exists(self.path("cut.mat")))

    def test_hdf5_is_read_as_such_whatever_its_ending(self):
        self.freeplay("run", MODEL, "--quiet", "--end", "10 ms", "--out", "r")
        for name in ("a.hdf5", "b.HDF", "c.dat", "d"):
            shutil.copy(self.path("r", "results.h5"), self.path(name))
            self.freeplay("compare", "r", name)
            self.assertEqual(self.read("r", "results.csv"), self.freeplay("export", name, "--to", "csv")[0])

    def test_a_killed_result_is_sealed(self):
        command = [PROGRAM, "run", MODEL, "--quiet", "--end", "100 s", "--out", "r"]
        with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.DEVNULL) as run:
            until = time.time() + 30
            while not os.path.exists(self.path("r", "results.csv")) or self.read("r", "results.csv").count("\n") < 50:
                self.assertLess(time.time(), until)
                time.sleep(0.05)
            time.sleep(1.5)
            _, stderr = self.freeplay("seal", "r", code=6)
            self.assertIn("[result-in-use]", stderr)
            run.kill()
        shutil.copytree(self.path("r"), self.path("damaged"))
        with open(self.path("damaged", "results.h5"), "r+b") as file:
            file.write(b"damaged")
        _, stderr = self.freeplay("seal", "damaged", code=6)
        self.assertIn("damaged/results.h5' cannot be read", stderr)
        _, stderr = self.freeplay("export", "damaged/results.h5", "--to", "csv", "--out", "copy.csv", code=6)
        self.assertIn("take a whole copy of it, or run the model again", stderr)
        self.assertNotIn("summary.json", os.listdir(self.path("damaged")))
        os.remove(self.path("damaged", "results.h5"))
        self.freeplay("seal", "damaged")
        with open(self.path("r", "results.csv"), "a", encoding="utf-8") as file:
            file.write("0.1,half a li")
        out, _ = self.freeplay("seal", "r")
        self.assertRegex(out, r"^r: sealed, [0-9]+ rows to t = \S+ s\n$")
        summary = json.loads(self.read("r", "summary.json"))
        self.assertEqual(("interrupted", "killed", int(out.split()[2])),
                         (summary["status"], summary["stop_reason"], summary["counts"]["rows"]))
        self.assertTrue(self.read("r", "results.csv").endswith("\n"))
        files = {name: os.stat(self.path("r", name)).st_mtime_ns for name in os.listdir(self.path("r"))}
        self.assertEqual("r: nothing to do\n", self.freeplay("seal", "r")[0])
        self.assertEqual(files, {name: os.stat(self.path("r", name)).st_mtime_ns for name in os.listdir(self.path("r"))})
        rows = table(self.freeplay("export", os.path.join("r", "results.h5"), "--to", "csv")[0])
        self.assertEqual(summary["counts"]["rows"], len(rows["time"]))
        os.mkdir(self.path("empty"))
        _, stderr = self.freeplay("seal", "empty", code=6)
        self.assertIn("[unreadable-result]", stderr)

    @needs("h5py")
    def test_a_file_of_another_schema_is_refused(self):
        import h5py
        self.run_model("--format", "hdf5")
        shutil.copy(self.path("r", "results.h5"), self.path("alone.h5"))
        with h5py.File(self.path("alone.h5"), "r+") as file:
            record = json.loads(file.attrs["provenance"])
            self.assertEqual(1, record["schema"])
            file.attrs["provenance"] = json.dumps(dict(record, schema=2, freeplay="9.9"))
        for command in (("plot", "alone.h5", "time"), ("report", "alone.h5"), ("export", "alone.h5", "--to", "csv"), ("compare", "alone.h5", "r")):
            _, err = self.freeplay(*command, code=6)
            self.assertIn("result 'alone.h5' cannot be read: its schema is 2, and this program reads schema 1", err)
            self.assertIn("it was written by freeplay 9.9", err)

    @needs("h5py")
    def test_a_sealed_file_opens_plainly(self):
        import h5py
        command = [PROGRAM, "run", MODEL, "--quiet", "--end", "100 s", "--out", "r", "--format", "hdf5"]
        with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.DEVNULL) as run:
            file = self.path("r", "results.h5")
            while not os.path.exists(file) or self.freeplay("export", "r", "--to", "csv")[0].count("\n") < 20:  # read as it goes on
                self.assertIsNone(run.poll())
                time.sleep(0.05)
            run.kill()
        with self.assertRaises(OSError):
            h5py.File(self.path("r", "results.h5"), "r")
        self.freeplay("seal", "r")
        with h5py.File(self.path("r", "results.h5"), "r") as file:
            self.assertEqual(self.read("r", "summary.json"), file["summary"][...].tobytes().decode())
            self.assertGreater(len(file["time"]), 0)
            for name in ("body.slider.x", "events/speed", "bearing/joint"):
                self.assertIn(name, file)

    def test_the_format_says_which_files_there_are(self):
        for word, files in (("csv", {"results.csv"}), ("hdf5", {"results.h5"}), ("both", {"results.csv", "results.h5"})):
            self.run_model("--format", word, out=word, end="1 ms")
            self.assertEqual(files, {"results.csv", "results.h5"} & set(os.listdir(self.path(word))))
            summary = json.loads(self.read(word, "summary.json"))
            self.assertEqual(sorted(os.listdir(self.path(word))), summary["files"])
        _, stderr = self.freeplay("run", MODEL, "--format", "xml", "--out", "x", code=2)
        self.assertIn("it must be csv, hdf5 or both", stderr)
        hashes = [json.loads(self.read(word, "summary.json"))["hashes"] for word in ("csv", "hdf5", "both")]
        self.assertEqual(hashes[0], hashes[1])
        columns = [numbers(cells) for cells in table(self.read("csv", "results.csv")).values()]
        rows = b"".join(bits(row) for row in zip(*columns))
        self.assertEqual(hashlib.sha256(rows).hexdigest(), hashes[0]["rows"])
        events = self.read("csv", "events.csv").encode()
        self.assertEqual(hashlib.sha256(events).hexdigest(), hashes[0]["events"])

    @needs("h5py")
    def test_every_column_is_a_dataset_with_the_same_bits(self):
        import h5py
        self.run_model()
        columns = table(self.read("r", "results.csv"))
        with h5py.File(self.path("r", "results.h5"), "r") as file:
            self.assertEqual([name.replace("/", ":") for name in columns],
                             [name for name in file["/"] if name in {c.replace("/", ":") for c in columns}])
            for name, cells in columns.items():
                dataset = file[name.replace("/", ":")]
                self.assertEqual(bits(numbers(cells)), bits(dataset[:].tolist()), name)
                for attribute in ("units", "long_name", "source"):
                    self.assertTrue(dataset.attrs[attribute].decode().strip(), name)
            self.assertEqual(self.read("r", "summary.json").encode(), file["summary"][:].tobytes())
            self.assertEqual(self.read("r", "model.yaml"), file.attrs["model"].decode())

    def test_of_tens_of_thousands_of_columns_text_alone_is_written_unless_hdf5_is_asked_for(self):
        chain = mechanism("validation/a02-chain")
        _, err = self.freeplay("run", chain, "--set", "windows=800", "--end", "1 ms", "--out", "many")
        self.assertRegex(err, "note: [0-9]+ columns go to results.csv alone: .*choose some --channels, or ask for it by --format both")
        self.assertFalse(os.path.exists(self.path("many", "results.h5")))
        self.assertIn("columns go to results.csv alone", self.read("many", "run.log"))
        self.freeplay("run", "--resume", "many", "--end", "2 ms")
        self.assertFalse(os.path.exists(self.path("many", "results.h5")))
        _, err = self.freeplay("run", chain, "--set", "windows=800", "--end", "1 ms", "--channels", "body.*", "--out", "some")
        self.assertNotIn("results.csv alone", err)
        self.assertTrue(os.path.exists(self.path("some", "results.h5")))

    def test_a_result_may_have_thousands_of_columns(self):
        # Their headers are more than HDF5 keeps in memory by itself.
        self.freeplay("run", mechanism("benchmark/chain"), "--quiet", "--set", "links=200", "--end", "20 us", "--step", "10 us",
                      "--out", "r")
        self.assertGreater(len(self.read("r", "results.csv").split("\n", 1)[0].split(",")), 3000)
        self.freeplay("compare", "r/results.csv", "r/results.h5")

    @needs("xarray")
    @needs("netCDF4")
    def test_xarray_opens_rows_and_events(self):
        import xarray
        self.run_model()
        columns = table(self.read("r", "results.csv"))
        with xarray.open_dataset(self.path("r", "results.h5")) as data:
            self.assertLessEqual({name.replace("/", ":") for name in columns}, set(data.variables))
            self.assertEqual("float64", str(data["time"].dtype))
            self.assertEqual("completed", json.loads(data["summary"].item())["status"])
        with xarray.open_dataset(self.path("r", "results.h5"), group="events") as events:
            self.assertEqual(len(table(self.read("r", "events.csv"))["time"]), events.sizes["event"])

    @unittest.skipUnless(shutil.which("ncdump"), "no ncdump")
    def test_ncdump_knows_all_dimensions(self):
        self.run_model()
        done = subprocess.run(["ncdump", "-h", self.path("r", "results.h5")], capture_output=True, text=True)
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn("time = UNLIMITED", done.stdout)
        self.assertNotIn("phony_dim", done.stdout)

    def test_export_of_everything_is_the_file_itself(self):
        self.run_model()
        for source in ("r", "r/results.csv", "r/results.h5"):
            self.assertEqual(self.read("r", "results.csv"), self.freeplay("export", source, "--to", "csv")[0])
            self.assertEqual(self.read("r", "events.csv"),
                             self.freeplay("export", source, "--to", "csv", "--table", "events")[0])

    @needs("h5py")
    def test_every_dataset_says_its_unit_what_it_is_and_from_where(self):
        import h5py
        self.run_model()
        seen = []

        def look(name, thing):
            if isinstance(thing, h5py.Dataset):
                seen.append(name)
                self.assertEqual({"units", "long_name", "source"}, {"units", "long_name", "source"} & set(thing.attrs), name)
        with h5py.File(self.path("r", "results.h5"), "r") as file:
            file.visititems(look)
        self.assertGreater(len(seen), 30)
        self.assertIn("summary_length", seen)

    def test_export_picks_channels_and_rows(self):
        self.run_model()
        whole = table(self.read("r", "results.csv"))
        picked = table(self.freeplay("export", "r", "--to", "csv", "--channels", "energy.*", "--from", "1 ms",
                                     "--until", "3 ms", "--every", "7")[0])
        self.assertEqual(["time"] + [name for name in whole if name.startswith("energy.")], list(picked))
        rows = [i for i, t in enumerate(numbers(whole["time"])) if 1e-3 - 1e-12 <= t <= 3e-3 + 1e-12][::7]
        self.assertGreater(len(rows), 5)
        for name, cells in picked.items():
            self.assertEqual([whole[name][i] for i in rows], cells)

    def test_export_lists_impacts(self):
        self.run_model()
        events = table(self.read("r", "events.csv"))
        ended = [i for i, kind in enumerate(events["kind"]) if kind == "contact_end"]
        impacts = table(self.freeplay("export", "r", "--to", "csv", "--table", "impacts")[0])
        self.assertGreater(len(ended), 0)
        self.assertEqual([events["max_fn"][i] for i in ended], impacts["max_fn"])
        self.assertEqual([events["joint"][i] for i in ended], impacts["joint"])

    def test_export_to_json_has_null_where_there_is_nothing(self):
        self.run_model()
        printed = json.loads(self.freeplay("export", "r", "--to", "json", "--table", "events")[0])
        events = table(self.read("r", "events.csv"))
        self.assertEqual(list(events), printed["columns"])
        self.assertEqual(len(events["time"]), len(printed["rows"]))
        column = list(events).index("duration")
        self.assertIn(None, [row[column] for row in printed["rows"]])
        self.assertEqual(self.read("r", "model.yaml"), printed["provenance"]["model"]["text"])

    @needs("h5py")
    @needs("scipy")
    def test_exported_files_read_back_bit_by_bit(self):
        import h5py
        import scipy.io
        self.run_model()
        columns = table(self.read("r", "results.csv"))
        self.freeplay("export", "r", "--to", "hdf5", "--out", "x.h5")
        self.freeplay("export", "r", "--to", "mat", "--out", "x.mat")
        mat = scipy.io.loadmat(self.path("x.mat"))
        channels = [str(cell[0]) for cell in mat["channels"].ravel()]
        self.assertEqual(list(columns)[1:], channels)
        self.assertEqual(bits(numbers(columns["time"])), bits(mat["time"].ravel().tolist()))
        with h5py.File(self.path("x.h5"), "r") as file:
            for k, name in enumerate(channels):
                self.assertEqual(bits(numbers(columns[name])), bits(file[name.replace("/", ":")][:].tolist()))
                self.assertEqual(bits(numbers(columns[name])), bits(mat["data"][:, k].tolist()))
            self.assertEqual("gzip", file["energy.work"].compression)
        self.assertLess(os.path.getsize(self.path("x.h5")), os.path.getsize(self.path("r", "results.h5")))

    def test_export_replaces_nothing_without_force(self):
        self.run_model(end="1 ms")
        self.freeplay("export", "r", "--to", "csv", "--out", "x.csv")
        self.assertEqual(self.read("r", "results.csv"), self.read("x.csv"))
        record = json.loads(self.read("x.csv.provenance.json"))
        self.assertEqual(self.read("r", "model.yaml"), record["model"]["text"])
        self.assertEqual(hashlib.sha256(self.read("x.csv").encode()).hexdigest(), record["data_sha256"])
        _, stderr = self.freeplay("export", "r", "--to", "csv", "--out", "x.csv", code=6)
        self.assertIn("x.csv", stderr)
        self.freeplay("export", "r", "--to", "csv", "--out", "x.csv", "--force")

    def test_a_result_its_table_its_picture_and_its_page_are_made_again(self):
        self.run_model(end="1 ms")
        self.freeplay("export", "r", "--to", "csv", "--out", "x.csv")
        self.freeplay("plot", "r", "body.slider.x", "--out", "x.svg")
        self.freeplay("report", "r", "--out", "x.html")
        for name in ("r", "x.csv", "x.svg", "x.html"):  # reproduce_test has the rest, which takes too long with sanitizers
            self.assertIn("same bytes", self.freeplay("reproduce", name)[0])

    def test_export_says_what_is_wrong(self):
        self.run_model(end="1 ms")
        for words, code, message in (
                (("r", "--to", "csv", "--channels", "energy.wrk"), 2, "did you mean 'energy.work'?"),
                (("r", "--to", "xml"), 2, "xml"), (("r", "--to", "hdf5"), 2, "--out"), (("r",), 2, "--to"),
                (("nowhere", "--to", "csv"), 6, "unreadable-result"),
                (("r", "--to", "csv", "--every", "0"), 2, "--every"),
                (("r", "--to", "csv", "--table", "result"), 2, "did you mean 'results'?"),
                (("r", "--to", "csv", "--from", "2 ms", "--until", "1 ms"), 2, "--from")):
            with self.subTest(words=words):
                self.assertIn(message, self.freeplay("export", *words, code=code)[1])

    def test_options_that_say_nothing_of_a_table_are_refused(self):
        self.run_model(end="1 ms")
        for words, goes_with in ((("bearing", "--from", "1 us"), "results, events, impacts, spectra, poincare, lyapunov"),
                                 (("bearing", "--channels", "work"), "results, spectra, poincare, lyapunov"),
                                 (("events", "--channels", "speed"), "results, spectra, poincare, lyapunov"),
                                 (("spectra", "--every", "2"), "results, events, impacts"),
                                 (("results", "--period", "1 ms"), "poincare, lyapunov"), (("lyapunov", "--phase", "0"), "poincare")):
            with self.subTest(words):
                _, err = self.freeplay("export", "r", "--to", "csv", "--table", *words, code=2)
                self.assertIn("%s says nothing of the table %s: it goes with %s [bad-value]" % (words[1], words[0], goes_with), err)

    def test_compare_takes_either_file(self):
        self.run_model(end="1 ms")
        self.freeplay("compare", "r/results.csv", "r/results.h5", "--tolerance", "0", "--absolute", "0")
        self.freeplay("compare", "r", "r/results.csv", "--tolerance", "0", "--absolute", "0")
        for ending in ("mat", "json", "hdf5"):
            name = "t." + ending.replace("hdf5", "h5")
            self.freeplay("export", "r", "--to", ending, "--out", name)
            out, _ = self.freeplay("compare", "r", name, "--tolerance", "0", "--absolute", "0")
            self.assertRegex(out, r"# \d+ channels in \d+ rows: 0 differ")
            self.assertEqual(self.read("r", "results.csv"), self.freeplay("export", name, "--to", "csv")[0])
        _, err = self.freeplay("compare", "r", "r/summary.json", code=6)
        self.assertIn("r/summary.json' cannot be read: it holds no table of rows", err)


if __name__ == "__main__":
    unittest.main()
