# SPDX-License-Identifier: Apache-2.0
"""Runs the programs of Heliopolis and keeps a log of every command."""
import json
import os
import pathlib
import re
import subprocess
import time


class Failed(Exception):
    """A program ended with an error; the text is its complaint."""


class Programs:
    def __init__(self, binaries, work):
        self.binaries, self.work = pathlib.Path(binaries), pathlib.Path(work)
        self.log = []      # one entry a command
        self.known = {}    # options by program and subcommand

    def options(self, program, command=None):
        """The long options that a program's --help names."""
        key = (program, command)
        if key not in self.known:
            words = [str(self.binaries / program), *([command] if command else []), "--help"]
            text = subprocess.run(words, capture_output=True, text=True).stdout
            self.known[key] = set(re.findall(r"(?<![\w-])--[a-z][a-z0-9-]*", text))
        return self.known[key]

    def missing(self, program, arguments, command=None):
        """Those of the arguments' options, or of their values if the help lists choices, that this build lacks."""
        have = self.options(program, command)
        return [word for word in arguments if str(word).startswith("--") and str(word) not in have]

    def run(self, program, arguments, stdin=None, stdout=None):
        """Runs one program to its end. `program`: a name in the binaries' folder, or a path. Returns its log entry, with
        what it printed as "text". stdin, stdout: files."""
        path = self.binaries / program if (self.binaries / program).exists() else pathlib.Path(program)
        words = [str(path), *(str(word) for word in arguments)]
        errors = self.work / "last-errors.txt"
        output = pathlib.Path(stdout) if stdout else self.work / "last-output.txt"
        start = time.monotonic()
        # By way of a shell's subshell: a program that is started from this one counts this one's memory as its own peak.
        shell = ["/bin/sh", "-c", '("$0" "$@"); exit $?']
        with open(stdin or os.devnull, "rb") as source, open(output, "wb") as out, open(errors, "wb") as err:
            child = subprocess.Popen([*shell, *words], stdin=source, stdout=out, stderr=err)
            _, status, usage = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
        entry = {"command": " ".join(self._short(word) for word in words),
                 "seconds": round(time.monotonic() - start, 3),
                 "processor_seconds": round(usage.ru_utime + usage.ru_stime, 3),
                 "code": child.returncode}
        self.log.append(entry)
        complaint = errors.read_text(errors="replace").strip()
        if child.returncode:
            raise Failed(f"{entry['command']}: {complaint or 'ended with ' + str(child.returncode)}")
        return {**entry, "text": "" if stdout else output.read_text(errors="replace"), "complaint": complaint}

    def bake(self, pack, inputs, arguments):
        """Bakes a pack. Returns statistics with the seconds of the process."""
        stats = pathlib.Path(str(pack) + ".stats.json")
        entry = self.run("heliopolis-bake", [*inputs, *arguments, "-o", pack, "--stats", stats])
        return {**json.loads(stats.read_text()), "process_seconds": entry["seconds"],
                "processor_seconds": entry["processor_seconds"],
                "command": entry["command"], "text": entry["text"]}

    def render(self, pack, arguments):
        entry = self.run("heliopolis-render", [pack, *arguments])
        found = re.search(r"Residual (\S+) after (\d+) sweeps", entry["text"])
        return {"command": entry["command"], "residual": float(found[1]) if found else None,
                "sweeps": int(found[2]) if found else None}

    def bench(self, pack, repeats):
        """Medians of heliopolis-bench in ms, with least, largest and every repetition's parts: {case: {...}}."""
        path = self.work / "bench.json"
        entry = self.run("heliopolis-bench", [pack, "--repeats", repeats, "--json", path, "--size", "64x64",
                                              "--copy", 16])
        report = json.loads(path.read_text())
        cases = {}
        for run in report["benchmarks"]:
            if run["run_type"] != "iteration":
                continue
            case = cases.setdefault(run["name"].split("/")[0], {})
            for name, value in run.items():
                if name == "real_time" or (isinstance(value, float) and name != "cpu_time"):
                    case.setdefault(name, []).append(value)
        for case in cases.values():
            for name, values in list(case.items()):
                ordered = sorted(values)
                half = len(ordered) // 2
                middle = ordered[half] if len(ordered) % 2 else 0.5 * (ordered[half - 1] + ordered[half])
                case[name] = {"median": middle, "min": ordered[0], "max": ordered[-1]}
        return {"command": entry["command"], "device": report["context"].get("device"),
                "driver": report["context"].get("driver"), "ms": cases}

    def _short(self, word):
        for folder, name in ((self.work, ""), (self.binaries, "")):
            word = word.replace(f"{folder.resolve()}/", name).replace(f"{folder}/", name)
        return word
