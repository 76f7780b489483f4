#!/usr/bin/env python3
"""Hashes every output of a build, so that two versions of flaunay can be compared.

    scripts/fingerprint.py [--build DIR] [--python PYTHON] [--quick] [--emulator PROGRAM] [-o fingerprint.json]
    scripts/fingerprint.py --compare BEFORE.json AFTER.json

The first form runs the command, a C program (tests/fingerprint/library.c, which it compiles and links to the
build's shared library) and, with --python, a program in Python (tests/fingerprint/module.py) on fixed inputs. It
writes a JSON object with one short text for each output: its hash, or itself if it is short. DIR is the build's
folder, build/release if not given; it may be of another version, also of one whose default mode is "hybrid",
which is taken for "blocks". PYTHON is an interpreter that has that version's module installed, as
build/python/bin/python after scripts/python-test.sh. --quick leaves out the larger and the rarer inputs; only
quick fingerprints can be compared with quick ones. --emulator is for a build for another platform, whose command
PROGRAM runs; then C and messages about devices are left out. With "none", the command is run without one in the
same way.

The second form prints the keys that differ, with both values, and exits with 1 if there are any.

Keys are paths such as cli/blocks/ukraine/triangles. Times, speeds, names of folders and of the device are left
out, and so is whatever else differs between two runs of one build. Fingerprints of different machines can differ,
as devices choose different sizes; compare those of one machine. The first run on a build compiles kernels and
takes longer than the next.
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent
FIXTURES = REPOSITORY / "tests/data"
PROGRAMS = REPOSITORY / "tests/fingerprint"

DEVICE_MODES = ["blocks", "flattened", "recursive-device"]
MODES = DEVICE_MODES + ["recursive", "partition", "dwyer"]
OPTIONS_OF_MODE = {"partition": ["--partition-levels", "3", "--threads", "2"]}
TUNINGS = ["gpu", "gpu:32", "small", "small-blocks"]
ARRAYS = ["triangles", "neighbors", "hull", "duplicates"]
# Per space the options of the command, and what there is in place of a hull.
SPACES = {
    "torus": (["--period", "1.5,2"], ["offsets"]),
    "sheared": (["--period", "1.5,2,0.625"], ["offsets"]),
    "cylinder": (["--period", "inf,2"], ["offsets"]),
    "weighted": (["--weighted"], ["hull", "hidden"]),
    "sphere": (["--sphere"], []),
}
PLACES = {"host": [], "device": ["--device=#0"], "chunks": ["--chunk-points=100", "--memory=512M"]}
MESHES = [".off", ".ply", ".obj", ".msh", ".vtu", ".ele", ".svg", ".npy"]
BINARY = [".npy", ".bin", ".ply", ".vtu"]
POINT_FORMATS = [".npy", ".node", ".xy", ".txt", ".csv", ".bin"]
# Mode recursive-device launches many kernels per region, and is slow.
MOST_POINTS_OF_RECURSIVE_DEVICE = 100
LONGEST_TEXT = 600  # longer ones are hashed


def short_hash(data):
    return hashlib.sha256(data).hexdigest()[:16]


class Fingerprint:
    def __init__(self, build, quick, folder, emulator):
        self.build, self.quick, self.folder = build.resolve(), quick, folder
        self.has_devices = emulator is None
        programs = [self.build / f"flaunay{ending}" for ending in (".exe", ".js", "")]
        self.command = [*(emulator or []), next(path for path in programs if path.exists())]
        self.values = {}
        self.sets = {}  # names and paths of points
        self.device = ""  # its name, which texts must not have
        self.default_mode = "hybrid" if "hybrid" in self.help_of("triangulate") else "blocks"

    def help_of(self, command):
        return subprocess.run([*self.command, command, "--help"], capture_output=True, text=True).stdout

    # ---- Texts and hashes

    def normalised(self, text):
        for path, name in (self.folder, "WORK"), (self.build, "BUILD"), (REPOSITORY, "REPOSITORY"):
            text = text.replace(str(path), name)
        if self.device:
            text = text.replace(self.device, "DEVICE")
        text = re.sub(r"\b[\d.]+ s\b", "T s", text)
        text = re.sub(r"(preparing the device|compiling kernels|solving) T s, ", "", text)  # only if they take long
        text = re.sub(r"\b\d+ points per second", "S points per second", text)
        # Some devices report their free memory, which varies.
        text = re.sub(r"\d+ would fit on", "N would fit on", text)
        text = re.sub(r"\d+ MiB of memory by the free memory", "M MiB of memory by the free memory", text)
        text = re.sub(r"\d+ bytes of memory, \d+ in one piece", "B bytes of memory, B in one piece", text)
        text = re.sub(r"\bhybrid\b", "blocks", text)
        text = re.sub(r"\bHYBRID\b", "BLOCKS", text)
        return text.strip()

    def add_text(self, key, text):
        text = self.normalised(text)
        self.values[key] = text if len(text) <= LONGEST_TEXT else short_hash(text.encode())

    def hash_of_file(self, path):
        if not path.exists():
            return "no such file"
        if path.suffix in BINARY:
            return short_hash(path.read_bytes())
        text = path.read_text(errors="surrogateescape")
        return short_hash(self.normalised(text).encode(errors="surrogateescape"))

    def add_file(self, key, path):
        self.values[key] = self.hash_of_file(path)

    def add_statistics(self, key, path):
        """Everything that does not depend on time. The counts of each level have separate keys."""
        if not path.exists():
            return
        statistics = json.loads(path.read_text())
        for name in "flaunay", "device", "input", "seconds", "points_per_second":
            statistics.pop(name, None)
        statistics["phases"] = [phase["name"] for phase in statistics.get("phases", [])]
        # Angles, of which the last digits are those of each system's arc cosine.
        refinement = statistics.get("refinement") or {}
        refinement |= {name: round(value, 9) for name, value in refinement.items() if isinstance(value, float)}
        for name in "levels", "kernels":
            rows = statistics.pop(name, None) or []
            for row in rows:
                row.pop("seconds", None)
            if name == "kernels":
                rows = {row["name"]: row["launches"] for row in rows}
            if rows:
                self.add_text(f"{key}/{name}", json.dumps(rows, sort_keys=True))
        work = statistics.pop("work", None)
        if work is not None:
            self.add_text(f"{key}/work", json.dumps(work, sort_keys=True))
        self.add_text(f"{key}/statistics", json.dumps(statistics))

    # ---- Runs of the command

    def run(self, key, *arguments, environment=None, standard_input=""):
        """The exit code and everything that is printed becomes one value."""
        arguments = [self.default_mode if argument == "blocks" else str(argument) for argument in arguments]
        done = subprocess.run(
            [*self.command, *arguments],
            input=standard_input,
            capture_output=True,
            text=True,
            errors="replace",
            env={**os.environ, "TERM": "dumb", **(environment or {})},
            cwd=self.folder,
        )
        self.add_text(f"{key}/printed", f"exit code {done.returncode}\n{done.stdout}{done.stderr}")
        return done.returncode

    def new_folder(self, key):
        folder = self.folder / key
        folder.mkdir(parents=True, exist_ok=True)
        return folder

    def outputs_in(self, folder):
        return [f"--{name}={folder / name}.npy" for name in ARRAYS] + [f"--stats={folder}/stats.json"]

    def triangulate(self, key, points, *options, mesh=None, arrays=ARRAYS, **how):
        folder = self.new_folder(key)
        outputs = [f"--{name}={folder / name}.npy" for name in arrays] + [f"--stats={folder}/stats.json"]
        if mesh is not None:
            outputs.append(f"--output={folder}/mesh{mesh}")
        self.run(key, "triangulate", points, *options, *outputs, **how)
        for name in arrays:
            self.add_file(f"{key}/{name}", folder / f"{name}.npy")
        self.add_statistics(key, folder / "stats.json")
        for path in sorted(folder.glob("mesh.*")):
            self.add_file(f"{key}/{path.name}", path)

    def partition(self, key, points, levels, *options):
        folder = self.new_folder(key)
        regions = folder / "regions"
        picture = f"--picture={folder}/picture.svg"
        self.run(key, "partition", points, f"--levels={levels}", "-o", regions, picture, *options)
        paths = sorted(regions.glob("*"))
        self.add_text(f"{key}/files", " ".join(path.name for path in paths))
        for suffix in sorted({path.suffix for path in paths}):
            hashes = [self.hash_of_file(path) for path in paths if path.suffix == suffix]
            self.values[f"{key}/regions/{suffix[1:]}"] = short_hash(" ".join(hashes).encode())
        self.add_file(f"{key}/picture", folder / "picture.svg")
        outputs = self.outputs_in(folder)
        self.run(f"{key}/unsolved", "assemble", points, regions, *outputs)
        self.run(f"{key}/again", "partition", points, f"--levels={levels}", "-o", regions)
        self.run(f"{key}/assemble", "assemble", points, regions, "--solve", "--threads=2", *outputs)
        for name in ARRAYS:
            self.add_file(f"{key}/assemble/{name}", folder / f"{name}.npy")
        self.add_statistics(f"{key}/assemble", folder / "stats.json")

    # ---- The inputs

    def generate(self, distribution, count):
        name = f"{distribution}-{count}"
        path = self.folder / f"{name}.xy"
        if self.run(f"cli/generate/{name}", "generate", distribution, count, "--seed=1", "-o", path) == 0:
            self.add_file(f"cli/generate/{name}/points", path)
            self.sets[name] = path

    def make_sets(self, in_parallel):
        listed = self.help_of("generate").split("Distributions:")[1]
        distributions = re.findall(r"^  ([\w-]+)  ", listed, re.MULTILINE)
        counts = [60, 700] if not self.quick else [60]
        some = ["uniform", "collinear", "mostly-equal", "half-duplicates"]
        chosen = [(distribution, count) for distribution in distributions for count in counts]
        chosen += [(distribution, count) for distribution in some for count in range(4 if not self.quick else 3)]
        if not self.quick:
            chosen += [(distribution, 20000) for distribution in ("uniform", "kuzmin", "grid", "small-integers")]
        in_parallel([(self.generate, pair) for pair in chosen])
        for path in sorted(FIXTURES.glob("*.xy")) + sorted(FIXTURES.glob("*.node")):
            if not self.quick or path.stat().st_size < 50000:
                self.sets[path.stem] = path
        for name, text in {
            "square": "0 0\n1 0\n1 1\n0 1\n",
            "all-equal": "2 3\n" * 40,
            "vertical": "".join(f"1 {k * 7 % 31}\n" for k in range(31)),
            "zeros": "0 0\n-0 0\n0 -0\n1 1\n-1 1\n",
        }.items():
            self.sets[name] = self.folder / f"{name}.xy"
            self.sets[name].write_text(text)

    def is_small(self, name):
        return len(self.sets[name].read_text().splitlines()) <= MOST_POINTS_OF_RECURSIVE_DEVICE

    # ---- What is run

    def jobs(self):
        sets = self.sets
        for mode in MODES:
            for name in sorted(sets):
                if mode == "recursive-device" and not self.is_small(name):
                    continue
                options = ["--mode", mode, *OPTIONS_OF_MODE.get(mode, [])]
                yield self.triangulate, (f"cli/{mode}/{name}", sets[name], *options)
        some = ["ukraine", "robustness2", "uniform-60", "collinear-60", "grid-60", "small-integers-60", "zeros"]
        if not self.quick:
            some += ["issue44", "circle-700", "kuzmin-700", "half-duplicates-700", "one-ulp-700"]
        small = [name for name in some if self.is_small(name)]
        for mode in DEVICE_MODES:
            for tuning in TUNINGS if not self.quick else ["small-blocks"]:
                for name in some if mode != "recursive-device" else small[:2]:
                    arguments = f"cli/{mode}/{tuning}/{name}", sets[name], "--mode", mode
                    yield self.triangulate, arguments, {"environment": {"FLAUNAY_TUNING": tuning}}
        for mode in MODES:
            options = ["--mode", mode, *OPTIONS_OF_MODE.get(mode, [])]
            names = small[:2] if mode == "recursive-device" else some if not self.quick else some[:3]
            variants = {name: [f"--hull-variant={name}"] for name in ("quickhull", "balanced", "monotone-chain")}
            # The table of a profile is sorted by time.
            variants |= {"alternate": ["--cut=alternate"], "count": ["--count"], "profile": ["--profile", "--quiet"]}
            if mode in ("blocks", "dwyer"):  # they refuse most of these, with messages
                names = names[:1]
            for variant, more in variants.items():
                for name in names:
                    yield self.triangulate, (f"cli/{mode}/{variant}/{name}", sets[name], *options, *more)
        for mesh in MESHES:
            of_dwyer = ["ukraine", "robustness2", "uniform-0", "uniform-1", "collinear-60", "small-integers-60"]
            for mode, name in [("dwyer", name) for name in of_dwyer] + [("blocks", "ukraine")]:
                key = f"cli/meshes/{mode}/{name}/{mesh[1:]}"
                yield self.triangulate, (key, sets[name], "--mode", mode), {"mesh": mesh}
        for name in some:
            for levels in [0, 3] if not self.quick else [2]:
                yield self.partition, (f"cli/partition/{levels}/{name}", sets[name], levels)
        for variant in "--cut=alternate", "--hull-variant=quickhull", "--hull-variant=balanced":
            yield self.partition, (f"cli/partition/3/{variant[2:]}", sets["ukraine"], 3, variant)
        for path in sorted(FIXTURES.glob("*.poly")):
            for angle in [20, 30] if not self.quick else [30]:
                key = f"cli/refined/{path.stem}/{angle}"
                yield self.triangulate, (key, path, f"--min-angle={angle}"), {"mesh": ".ele"}
        for name in small:
            yield self.triangulate, (f"cli/refined/{name}", sets[name], "--min-angle=30"), {"mesh": ".ele"}
        yield from self.spaces()
        yield from self.formats()
        yield self.verifications, ()
        yield from self.wrong_requests()
        for command in "", "triangulate", "partition", "assemble", "generate", "verify", "devices":
            yield self.run, (f"cli/help/{command or 'flaunay'}", *([command] if command else []), "--help")
        yield self.run, ("cli/version", "--version")
        yield self.run, ("cli/no-command",)

    def spaces(self):
        chosen = ["ukraine", "uniform-60", "grid-60", "small-integers-60", "zeros"]
        if not self.quick:
            chosen += ["uniform-700", "circle-700", "half-duplicates-700", "all-equal", "vertical"]
        places = {name: options for name, options in PLACES.items() if name != "device" or self.has_devices}
        for name in chosen:
            # A third number in each row, and numbers that are degrees.
            rows = [row.split() for row in self.sets[name].read_text().splitlines()]
            rows = [row for row in rows if len(row) == 2]
            weighted, globe = self.folder / f"weighted-{name}.txt", self.folder / f"globe-{name}.xy"
            weighted.write_text("".join(f"{x} {y} {k * 7 % 5}\n" for k, (x, y) in enumerate(rows)))
            globe.write_text("".join(f"{float(x) % 360!r} {float(y) % 180 - 90!r}\n" for x, y in rows))
            given = {"weighted": weighted, "sphere": globe}
            for place, placing in places.items():
                yield self.triangulate, (f"cli/plane/{place}/{name}", self.sets[name], *placing)
                for space, (options, arrays) in SPACES.items():
                    key = f"cli/{space}/{place}/{name}"
                    wanted = ["triangles", "neighbors", "duplicates", *arrays]
                    path = given.get(space, self.sets[name])
                    yield self.triangulate, (key, path, *options, *placing), {"arrays": wanted}
                    yield self.verification_in, (key, path, *options, "offsets" in arrays)
            for space, mesh in ("torus", ".vtu"), ("torus", ".obj"), ("sphere", ".geojson"), ("sphere", ".ply"):
                options, arrays = SPACES[space]
                key, path = f"cli/{space}/meshes/{name}/{mesh[1:]}", given.get(space, self.sets[name])
                yield self.triangulate, (key, path, *options), {"mesh": mesh, "arrays": arrays}

    def verification_in(self, key, points, *options):
        """Of a mesh that is right, and of the mesh with its first index changed."""
        *options, has_offsets = options
        folder = self.new_folder(f"{key}/verify")
        mesh = folder / "t.npy"
        offsets = ["--offsets", folder / "o.npy"] if has_offsets else []
        if self.run(f"{key}/verify/made", "triangulate", points, *options, "--triangles", mesh, *offsets) != 0:
            return
        self.run(f"{key}/verify/right", "verify", points, mesh, *options, *offsets)
        numbers = bytearray(mesh.read_bytes())
        if len(numbers) > 128:
            numbers[128] ^= 1
        mesh.write_bytes(numbers)
        self.run(f"{key}/verify/wrong", "verify", points, mesh, *options, *offsets)

    def formats(self):
        for suffix in POINT_FORMATS:
            path = self.folder / f"points{suffix}"
            if self.run(f"cli/formats/{suffix[1:]}", "generate", "normal", 200, "--seed=7", "-o", path) == 0:
                self.add_file(f"cli/formats/{suffix[1:]}/points", path)
                yield self.triangulate, (f"cli/formats/{suffix[1:]}/read", path, "--mode=dwyer")
        text = (FIXTURES / "ukraine.xy").read_text()
        yield self.triangulate, ("cli/formats/standard-input", "-", "--mode=dwyer"), {"standard_input": text}
        yield self.run, ("cli/formats/standard-output", "generate", "uniform", 5, "-o", "-")

    def verifications(self):
        points, mesh = self.sets["robustness2"], self.folder / "verified.off"
        folder = self.new_folder("cli/verify")
        neighbors = ["--neighbors", folder / "neighbors.npy"]
        self.run("cli/verify/made", "triangulate", points, "--mode=dwyer", "-o", mesh, *neighbors)
        self.run("cli/verify/right", "verify", points, mesh)
        self.run("cli/verify/neighbors", "verify", points, mesh, *neighbors)
        self.run("cli/verify/other-points", "verify", self.sets["ukraine"], mesh)
        lines = mesh.read_text().splitlines()
        counts, corners = lines[1].split(), lines[-1].split()
        vertices, faces = int(counts[0]), int(counts[1])
        fewer = [lines[0], f"{vertices} {faces - 1} 0", *lines[2:-1]]
        turned = [*lines[:-1], " ".join([corners[0], corners[2], corners[1], corners[3]])]
        other = [*lines[:-1], " ".join([*corners[:3], str((int(corners[3]) + 1) % vertices)])]
        beyond = [*lines[:-1], " ".join([*corners[:3], str(vertices)])]
        twice = [lines[0], f"{vertices} {faces + 1} 0", *lines[2:], lines[-1]]
        changes = {"fewer": fewer, "turned": turned, "other": other, "beyond": beyond, "twice": twice}
        for name, changed in changes.items():
            path = folder / f"{name}.off"
            path.write_text("\n".join(changed) + "\n")
            self.run(f"cli/verify/{name}", "verify", points, path)

    def wrong_requests(self):
        folder = self.new_folder("cli/wrong")
        files = {
            "nan.xy": "0 0\nnan 1\n",
            "infinite.xy": "0 0\ninf 1\n",
            "word.xy": "0 0\n1 x\n",
            "empty.xy": "",
            "one-column.xy": "1\n2\n",
            "three-columns.xy": "1 2 3\n",
            "magnitudes.xy": "1e-300 0\n1e300 0\n0 1\n",
            "overflow.xy": "1e999 0\n",
            "short.node": "5 2 0 0\n1 0 0\n",
            "header.node": "x\n",
            "three.node": "1 3 0 0\n1 0 0 0\n",
            "odd.bin": "12345",
            "bad.npy": "no array",
            "no-ending": "0 0\n",
            "other.ending": "0 0\n",
            "good.xy": "0 0\n1 0\n0 1\n",
            "comments.xy": "# x\n0 0 # y\n\n1 1\n",
            "header.csv": "x,y\n0,0\n1,0\n0,1\n",
            "bad.csv": "0,0\n1;0\n",
        }
        for name, text in files.items():
            (folder / name).write_text(text)
            yield self.run, (f"cli/wrong/{name}/dwyer", "triangulate", folder / name, "--mode", "dwyer")
        for name in "nan.xy", "magnitudes.xy", "empty.xy":
            yield self.run, (f"cli/wrong/{name}/blocks", "triangulate", folder / name, "--mode", "blocks")
        good = folder / "good.xy"
        requests = {
            "no-input": ["triangulate"],
            "no-file": ["triangulate", folder / "nothing.xy"],
            "folder": ["triangulate", folder],
            "command": ["sideways"],
            "distribution": ["generate", "sideways", 5, "-o", "-"],
            "count": ["generate", "uniform", -5, "-o", "-"],
            "too-many": ["generate", "uniform", 30000000000000000000, "-o", folder / "many.npy"],
            "no-output": ["generate", "uniform", 5],
            "points-ending": ["generate", "uniform", 5, "-o", folder / "a.off"],
            "partition-levels": ["partition", good, "--levels=31", "-o", folder / "regions"],
            "partition-output": ["partition", good, "--levels=1"],
            "partition-picture": ["partition", good, "--levels=1", "-o", folder / "r", "--picture", "p.png"],
            "assemble-folder": ["assemble", good, folder / "nothing"],
            "assemble-threads": ["assemble", good, folder, "--threads=2"],
            "verify-triangles": ["verify", good, folder / "nothing.npy"],
            "verify-bad": ["verify", good, folder / "bad.npy"],
        }
        options = {
            "option": ["--sideways"],
            "more": [good],
            "mode": ["--mode=sideways"],
            "cut": ["--cut=sideways"],
            "hull": ["--hull-variant=sideways"],
            "levels": ["--mode=partition", "--partition-levels=31"],
            "levels-blocks": ["--partition-levels=3"],
            "threads": ["--mode=partition", "--threads=0"],
            "threads-flattened": ["--mode=flattened", "--threads=2"],
            "device-dwyer": ["--mode=dwyer", "--device=#0"],
            "profile-recursive": ["--mode=recursive", "--profile"],
            "mesh": ["-o", folder / "mesh.xyz"],
            "no-path": ["-o", ""],
            "triangles": ["--triangles", folder / "triangles.txt"],
            "stats": ["--stats", folder / "stats.txt"],
            "unwritable": ["--triangles", folder / "no-folder/t.npy"],
            "same-paths": ["--triangles", folder / "a.npy", "--hull", folder / "a.npy"],
        }
        variables = [("FLAUNAY_TUNING", "sideways"), ("FLAUNAY_TUNING", "gpu:0")]
        if self.has_devices:
            options |= {"device": ["--device=no such device"], "number": ["--device=#99"]}
            variables.append(("FLAUNAY_DEVICE", "none such"))
        requests |= {key: ["triangulate", good, *arguments] for key, arguments in options.items()}
        for key, arguments in requests.items():
            yield self.run, (f"cli/wrong/{key}", *arguments)
        for name, value in variables:
            yield self.run, (f"cli/wrong/{name}={value}", "triangulate", good), {"environment": {name: value}}

    # ---- C and Python

    def add_lines(self, prefix, done):
        for line in done.stdout.splitlines():
            key, _, value = line.partition(" ")
            self.add_text(self.normalised(f"{prefix}/{key}"), value)
        self.add_text(f"{prefix}/ended", f"exit code {done.returncode} {done.stderr}")

    def c_program(self):
        cache = (self.build / "CMakeCache.txt").read_text()
        source = re.search(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.*)$", cache, re.MULTILINE).group(1)
        library = min(self.build.rglob("libflaunay.so"), key=lambda path: len(path.parts)).parent
        program = self.folder / "library"
        subprocess.run(
            [os.environ.get("CC", "cc"), "-std=c11", "-O1", "-w", "-DCL_TARGET_OPENCL_VERSION=120",
             f"-I{source}/src/include", PROGRAMS / "library.c", "-o", program, f"-L{library}", "-lflaunay",
             f"-Wl,-rpath,{library}", "-lOpenCL", "-lm"],
            check=True,
        )
        self.add_lines("c", subprocess.run([program], capture_output=True, text=True))

    def python_program(self, python):
        environment = {**os.environ, "FLAUNAY_FINGERPRINT_MODE": self.default_mode}
        program = [python, PROGRAMS / "module.py"]
        done = subprocess.run(program, capture_output=True, text=True, env=environment, cwd=self.folder)
        self.add_lines("python", done)


def take(arguments):
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        emulator = None if arguments.emulator is None else arguments.emulator.replace("none", "").split()
        fingerprint = Fingerprint(arguments.build, arguments.quick, pathlib.Path(folder).resolve(), emulator)

        def in_parallel(jobs):
            for done in [pool.submit(call, *given, **(how[0] if how else {})) for call, given, *how in jobs]:
                done.result()

        one = pathlib.Path(folder) / "one.xy"
        one.write_text("0 0\n")
        fingerprint.run("cli/one-point", "triangulate", one, "--stats", f"{folder}/one.json")
        fingerprint.device = json.loads((pathlib.Path(folder) / "one.json").read_text())["device"]
        fingerprint.make_sets(in_parallel)
        programs = [(fingerprint.c_program, ())] if arguments.emulator is None else []
        if arguments.python is not None:
            programs.append((fingerprint.python_program, (os.path.abspath(arguments.python),)))
        in_parallel(programs + list(fingerprint.jobs()))
    arguments.output.write_text(json.dumps(fingerprint.values, indent=0, sort_keys=True) + "\n")
    print(f"{len(fingerprint.values)} outputs: {arguments.output}")
    return 0


def compare(before, after):
    before, after = (json.loads(path.read_text()) for path in (before, after))
    differing = [key for key in sorted({*before, *after}) if before.get(key) != after.get(key)]
    for key in differing:
        print(f"{key}\n  - {before.get(key, '(none)')}\n  + {after.get(key, '(none)')}")
    print(f"{len(differing)} of {len({*before, *after})} outputs differ")
    return 1 if differing else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=REPOSITORY / "build/release")
    parser.add_argument("--python", help="an interpreter with the module flaunay; else Python is left out")
    parser.add_argument("--quick", action="store_true", help="fewer and smaller inputs")
    parser.add_argument("--emulator", help="runs the programs of a build for another platform, such as wine")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("fingerprint.json"))
    parser.add_argument("--compare", nargs=2, type=pathlib.Path, metavar=("BEFORE", "AFTER"))
    arguments = parser.parse_args()
    return compare(*arguments.compare) if arguments.compare else take(arguments)


if __name__ == "__main__":
    sys.exit(main())
