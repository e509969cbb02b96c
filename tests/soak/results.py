"""Results of runs that end in the middle: what is in their files, and whether they became what an undisturbed run writes."""
import json
import os

import h5py

# Of summary.json, what depends on the hour and on the way.
OF_THE_WAY = ("performance", ("model", "file"), ("provenance", "command"))


def read(*names):
    with open(os.path.join(*names), "rb") as file:
        return file.read()


def need(condition, *words):
    if not condition:
        raise AssertionError(" ".join(map(str, words)))


def numbers(file, name, count=None):
    data = file[name][()] if count is None else file[name][:count]
    return data.tobytes()


class Reference:
    """The result of a run that nothing disturbed."""

    def __init__(self, folder):
        self.folder = folder
        self.rows, self.events = read(folder, "results.csv"), read(folder, "events.csv")
        self.summary = self.without_way(json.loads(read(folder, "summary.json")))
        with h5py.File(os.path.join(folder, "results.h5"), "r") as file:
            self.names = self.datasets(file)
            self.times = file["time"][:]
            self.channels = {name: file[name][:] for name in file if isinstance(file[name], h5py.Dataset) and
                             file[name].shape == self.times.shape}

    @staticmethod
    def without_way(summary):
        for name in OF_THE_WAY:
            if isinstance(name, str):
                del summary[name]
            else:
                del summary[name[0]][name[1]]
        return summary

    @staticmethod
    def datasets(file):
        names = []
        file.visititems(lambda name, thing: names.append(name) if isinstance(thing, h5py.Dataset) else None)
        return sorted(names)

    def part(self, folder):
        """Rows in results.csv and in results.h5 of a result that was cut, each None where there is no file; what is in
        them is the beginning of this one."""
        found = []
        for name, whole in (("results.csv", self.rows), ("events.csv", self.events)):
            if not os.path.exists(os.path.join(folder, name)):
                found.append(None)
                continue
            lines = read(folder, name)
            lines = lines[:lines.rfind(b"\n") + 1]
            need(whole.startswith(lines), folder, name, "is no beginning of the whole one")
            found.append(max(lines.count(b"\n") - 1, 0))
        if not os.path.exists(os.path.join(folder, "results.h5")):
            return found[0], None
        with h5py.File(os.path.join(folder, "results.h5"), "r", swmr=True) as file:
            rows = len(file["time"])
            for name, column in self.channels.items():
                need(numbers(file, name, rows) == column[:rows].tobytes(), folder, "results.h5:", name, "differs in", rows, "rows")
        return found[0], rows

    def require_same(self, folder):
        """Byte for byte, results.h5 dataset by dataset."""
        for name, whole in (("results.csv", self.rows), ("events.csv", self.events)):
            need(read(folder, name) == whole, folder, name, "is another one")
        summary = self.without_way(json.loads(read(folder, "summary.json")))
        need(summary == self.summary, folder, "summary.json differs in",
             [name for name in self.summary if summary.get(name) != self.summary[name]])
        with h5py.File(os.path.join(folder, "results.h5"), "r") as file, \
                h5py.File(os.path.join(self.folder, "results.h5"), "r") as whole:
            need(self.datasets(file) == self.names, folder, "results.h5 has other datasets")
            for name in self.names:
                if not name.startswith("summary"):  # says how long it took
                    need(numbers(file, name) == numbers(whole, name), folder, "results.h5:", name, "is another one")
