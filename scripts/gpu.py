#!/usr/bin/env python3
"""Tests and measures flaunay on a GPU, also CuPy if it is installed, and writes the results to
bench/results/<device>.json. Before anything else it measures what predictions of times assume of a device; predictions
stand beside the measurements at the end, and a row for the table of tuning values. Needs neither root nor a network.
See docs/performance.md, "On a GPU".

Exit code: 0, or 1 if a test failed, a result was wrong or a measurement ended with an error.
"""
import argparse
import concurrent.futures
import glob
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

# What is measured. The record contains these settings, too.
MODES = "blocks,flattened,dwyer"
DISTRIBUTIONS = ["uniform", "normal", "kuzmin", "line"]
# Values of src/tuning/tuning.cpp that are tried, one name after the other. round_points=0 merges up the trees instead
# of rounds. With block_group=1 a warp has one lane that merges, and nothing diverges; merge_items says up to how many
# merges have a warp each.
TUNED = {"local_vertices": [0, 256, 512], "round_points": [0, 256, 512, 1024], "merge_items": [16384, 65536, 262144], "leaf_spread": [1, 2, 3], "seam_points": [4, 8], "block_group": [1, 4, 32],
         "block_points": [512, 1024, 2048], "halve_group": [64, 128, 256], "tile_group": [0, 128, 256],
         "blocks_in_parallel": [0, 1], "map_group": [64, 128, 256], "sort_items": [8, 16, 32]}
PARTS = ["conformance", "device", "tests", "verify", "peers", "modes", "embedding", "batches", "cupy", "tuning",
         "predictions"]
# What is less than this share faster may be noise.
WORTH_A_CHANGE = 0.02
TEST_SECONDS = 1800
FULL = {"peer_sizes": [1000000, 10000000], "mode_sizes": "1024,16384,131072,1048576,4194304", "verify_size": 200000,
        "runs": 5, "launch_sizes": "1000000,16000000", "tuned_size": 1000000, "tuned": TUNED, "filter": "*",
        "points": 1000, "tests": None, "flags": []}
QUICK = {"peer_sizes": [20000], "mode_sizes": "1024,4096", "verify_size": 5000, "runs": 1,
         "launch_sizes": "20000", "tuned_size": 20000, "tuned": {"block_group": [1, 32]}, "filter": "Small*",
         "points": 64, "tests": ["test_host"], "flags": ["--quick"]}

SOURCE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(SOURCE, "bench", "predictions"))
import predict  # pylint: disable=wrong-import-position

# Every machine has its own version of these libraries, so they are not packed.
C_LIBRARY = re.compile(r"/(libc|libm|libdl|librt|libpthread|ld-linux[^/]*)\.so")


def fail(message):
    print(f"gpu.py: {message}", file=sys.stderr)
    sys.exit(2)


def say(text):
    print(f"\n== {text}", flush=True)


def arguments_of(command_line):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="small sizes and few tests: does all of it work?")
    parser.add_argument("--device", help="as for flaunay triangulate; by default the first GPU")
    parser.add_argument("--icd", metavar="DRIVER", action="append", default=[],
                        help="an OpenCL driver (a library, or an .icd file that names one) for the loader to use, for "
                        "this run alone and in place of those installed; more than once for several")
    parser.add_argument("--modes", default=MODES, help="the modes to measure, by default %(default)s")
    parser.add_argument("--runs", type=int, help="counted runs of each")
    parser.add_argument("--parts", default=",".join(PARTS), help="what to do, for a machine that is lent for minutes; by "
                        "default %(default)s")
    parser.add_argument("--output", metavar="DIR", default=os.path.join(SOURCE, "bench", "results"),
                        help="where the record goes, by default bench/results")
    parser.add_argument("--prebuilt", metavar="DIR", help="programs of --pack, or a build folder, in place of building")
    parser.add_argument("--pack", metavar="DIR", help="builds, and copies the programs with the libraries they need to "
                        "DIR, for --prebuilt elsewhere")
    parser.add_argument("--cupy", nargs="+", help=argparse.SUPPRESS)  # this script, run by itself
    return parser.parse_args(command_line)


# ---- The programs


def programs_in(folder):
    tests = sorted(path for path in glob.glob(os.path.join(folder, "tests", "test_*"))
                   if os.path.isfile(path) and os.access(path, os.X_OK) and not path.endswith(".cmake"))
    return [os.path.join(folder, "flaunay"), os.path.join(folder, "flaunay-bench")], tests


def build():
    say("Building")
    folder = os.path.join(SOURCE, "build", "release")
    for command in (["cmake", "-S", SOURCE, "--preset", "release"], ["cmake", "--build", folder]):
        if subprocess.run(command, cwd=SOURCE, check=False).returncode != 0:
            fail("it does not build; scripts/install-deps.sh says what is missing")
    return folder


def pack(folder, target):
    commands, tests = programs_in(folder)
    for part in ("tests", "lib"):
        os.makedirs(os.path.join(target, part), exist_ok=True)
    for programs, part in ((commands, ""), (tests, "tests")):
        for program in programs:
            copy = shutil.copy(program, os.path.join(target, part))
            subprocess.run(["strip", copy], check=True)
            listed = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
            for library in re.findall(r"=> (/\S+)", listed):
                if not C_LIBRARY.search(library):
                    shutil.copy(os.path.realpath(library), os.path.join(target, "lib", os.path.basename(library)))
    print(f"gpu.py: packed in {target}")


def add_missing_libraries(folder, libraries):
    """Links libraries that this machine lacks, or has too old, to those of the pack; the others are its own, for the
    driver's sake. One may bring the need for another."""
    packed = os.path.join(folder, "lib")
    if not os.path.isdir(packed):
        return
    commands, tests = programs_in(folder)
    while True:
        missing = set()
        for program in commands + tests:
            result = subprocess.run(["ldd", program], capture_output=True, text=True, check=False,
                                    env=dict(os.environ, LD_LIBRARY_PATH=libraries))
            for line in (result.stdout + result.stderr).splitlines():
                found = re.match(r"\s*(\S+) => not found$|.*: (?:\S*/)?([^ /]+): version .* not found", line)
                if found:
                    missing.add(found[1] or found[2])
        new = [name for name in missing if os.path.exists(os.path.join(packed, name))
               and not os.path.exists(os.path.join(libraries, name))]
        if not new:
            break
        for name in new:
            os.symlink(os.path.join(packed, name), os.path.join(libraries, name))
    if missing:
        fail(f"libraries are missing, and not in {packed}: {' '.join(sorted(missing))}")


def use_drivers(drivers, folder):
    os.makedirs(folder)
    for k, driver in enumerate(drivers):
        if "/" in driver and not os.path.exists(driver):
            fail(f"there is no driver {driver}")
        path = os.path.join(folder, f"{k}.icd")
        if driver.endswith(".icd"):
            shutil.copy(driver, path)
        else:
            with open(path, "w", encoding="utf-8") as file:
                file.write(driver + "\n")
    os.environ["OCL_ICD_VENDORS"] = folder


# ---- CuPy


def measure_cupy(paths, runs, folder):
    """Times CuPy's Delaunay triangulation (cupyx.scipy.spatial.Delaunay, which is gDel2D), in a process of its own.

    Two times, each from one device synchronisation to another, after a run that is not counted:
      device  from points in device memory to triangles and neighbours there
      host    from points in host memory to triangles and neighbours there: what flaunay-bench's times include
    """
    import cupy
    import numpy
    from cupyx.scipy.spatial import Delaunay

    def seconds_of(action):
        cupy.cuda.Device().synchronize()
        begin = time.perf_counter()
        result = action()
        cupy.cuda.Device().synchronize()
        return time.perf_counter() - begin, result

    def on_device(points):
        mesh = Delaunay(points)
        return mesh.simplices, mesh.neighbors

    def measure(points):
        row = {}
        on_the_device = cupy.asarray(points)
        triangles = None
        for name, action in (("device", lambda: on_device(on_the_device)),
                             ("host", lambda: tuple(map(cupy.asnumpy, on_device(cupy.asarray(points)))))):
            triangles = seconds_of(action)[1][0]
            times = [seconds_of(action)[0] for _ in range(runs)]
            row.update({f"{name}_seconds_median": statistics.median(times), f"{name}_seconds_min": min(times),
                        f"{name}_seconds_max": max(times)})
        return dict(row, triangles=len(triangles)), triangles

    rows = []
    for path in paths:
        name = os.path.splitext(os.path.basename(path))[0]
        points = numpy.load(path).astype(numpy.float64)
        row = {"input": name, "n": len(points)}
        try:
            times, triangles = measure(points)
            row.update(times)
            numpy.save(os.path.join(folder, f"cupy-{name}.npy"), triangles.astype(numpy.int32))
        except Exception as error:  # of CuPy, CUDA or the algorithm: all end this input alone
            row["error"] = f"{type(error).__name__}: {error}"
        print(f"{name}: {row}", file=sys.stderr)
        rows.append(row)
        # Otherwise CuPy would keep the memory of one input, which the next one may need.
        cupy.get_default_memory_pool().free_all_blocks()
    device = cupy.cuda.runtime.getDeviceProperties(cupy.cuda.Device().id)["name"]
    return {"measured": True, "cupy": cupy.__version__, "cuda": cupy.cuda.runtime.runtimeGetVersion(),
            "device": device.decode() if isinstance(device, bytes) else str(device), "runs": runs, "results": rows}


# ---- Everything on the device


class Session:
    """Runs the programs of a folder and collects their results."""

    def __init__(self, folder, work, plan, modes):
        self.folder, self.work, self.plan, self.modes = folder, work, plan, modes
        self.libraries = os.path.join(work, "lib")
        self.failures, self.record = [], {}

    def run(self, *command, **options):
        path = ":".join(filter(None, [self.libraries, os.environ.get("LD_LIBRARY_PATH")]))
        return subprocess.run(list(map(str, command)), check=False, env=dict(os.environ, LD_LIBRARY_PATH=path),
                              **options)

    def flaunay(self, *arguments, **options):
        return self.run(os.path.join(self.folder, "flaunay"), *arguments, **options)

    def points(self, name, distribution, n):
        path = os.path.join(self.work, f"{name}.npy")
        # The seed is flaunay-bench's.
        if self.flaunay("generate", distribution, n, "--seed", 1, "-o", path).returncode != 0:
            fail(f"points of {distribution} cannot be generated")
        return path

    def run_test(self, name):
        """What the record says of a test program, and its output."""
        begin, code, output = time.monotonic(), 127, "not built"
        if os.path.exists(os.path.join(self.folder, "tests", name)):
            try:
                result = self.run(os.path.join(self.folder, "tests", name), "--gtest_brief=1",
                                  f"--gtest_filter={self.plan['filter']}", stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, errors="replace", timeout=TEST_SECONDS)
                code, output = result.returncode, result.stdout
            except subprocess.TimeoutExpired as expired:
                code, output = 124, (expired.stdout or b"").decode(errors="replace") + f"took over {TEST_SECONDS} s"
        counts = [re.findall(pattern, output, re.MULTILINE) for pattern in
                  (r"^\[  PASSED  \] (\d+) test", r"^\[  FAILED  \] (\d+) tests?, listed below:")]
        passed, failed = (int(count[-1]) if count else 0 for count in counts)
        if not any(counts) and code == 0:
            code = 1  # without a summary the program has ended early
        print(f"{name:<28} {passed:>5} passed {failed:>5} failed   exit code {code}   "
              f"{time.monotonic() - begin:.0f} s", flush=True)
        return {"program": name, "passed": passed, "failed": failed, "exit_code": code}, output

    def conform(self):
        """What has passed according to the record of an earlier run is not run again."""
        say("Every call and every kernel, against the host")
        path = os.path.join(self.plan["output"], "conformance.json")
        if self.flaunay("devices", "--test", "--record", path, "--points", self.plan["points"]).returncode != 0:
            self.failures.append("conformance")
        with open(path, encoding="utf-8") as file:
            self.record["conformance"] = json.load(file)

    def test(self):
        say("Tests")
        names = self.plan["tests"] or [os.path.basename(path) for path in programs_in(self.folder)[1]]
        # Most of a test's time is the host's, and a GPU serves several processes.
        with concurrent.futures.ThreadPoolExecutor(max(1, (os.cpu_count() or 1) // 2)) as pool:
            results = list(pool.map(self.run_test, names))
        self.record["tests"] = [row for row, _ in results]
        for row, output in results:
            if row["exit_code"] != 0:
                self.failures.append(row["program"])
                print(f"\n{row['program']}\n" + "\n".join(output.splitlines()[-40:]), file=sys.stderr)

    def verify(self):
        n = self.plan["verify_size"]
        say(f"Results of {n} points, verified")
        self.record["verified"] = []
        triangles, neighbors = (os.path.join(self.work, f"{name}.npy") for name in ("t", "n"))
        for distribution in DISTRIBUTIONS:
            points = self.points(f"verify-{distribution}", distribution, n)
            for mode in self.modes.split(","):
                made = self.flaunay("triangulate", points, "--mode", mode, "--quiet", "--triangles", triangles,
                                    "--neighbors", neighbors).returncode == 0
                checked = made and self.flaunay("verify", points, triangles, "--neighbors", neighbors,
                                                stdout=subprocess.PIPE, text=True)
                valid = bool(checked) and checked.returncode == 0
                print(f"{distribution}, {mode}: {checked.stdout.strip() if valid else 'WRONG'}", flush=True)
                self.record["verified"].append({"distribution": distribution, "mode": mode, "n": n, "valid": valid})
                if not valid:
                    self.failures.append(f"verify {distribution} {mode}")

    def bench(self, title, name, *arguments, key=None):
        """Runs a subcommand of flaunay-bench, and returns its record. key: of the record in ours, if not the name."""
        key = key or name
        say(title)
        path = os.path.join(self.work, f"{key}.json")
        result = self.run(os.path.join(self.folder, "flaunay-bench"), name, *arguments, "--runs", self.plan["runs"],
                          "--json", path)
        if result.returncode != 0:
            self.failures.append(f"flaunay-bench {key}")
        try:
            with open(path, encoding="utf-8") as file:
                self.record[key] = json.load(file)
        except (OSError, ValueError):
            self.record[key] = {"error": f"exit code {result.returncode}"}
        return self.record[key]

    def measure_device(self):
        """What predictions assume."""
        self.bench("What predictions of times assume", "device", key="probed")

    def time_with(self, tuning):
        """Seconds of a call with these tuning values, and of its solver; None if it failed."""
        record = self.bench(f"Tuning {tuning}", "launches", "--sizes", self.plan["tuned_size"], "--distributions",
                            "uniform", "--tuning", tuning, key=f"tuning {tuning}")
        del self.record[f"tuning {tuning}"]
        if "error" in record:
            return None
        solver = sum(row["seconds"] for row in record["launches"] if row["kernel"] == "solve_blocks")
        return {"tuning": tuning, "seconds": record["results"][0]["seconds_median"], "solve_seconds": solver}

    def tune(self):
        """Tries tuning values, each name with what was best of the names before."""
        given = os.environ.get("FLAUNAY_TUNING", "")
        best, rows = None, []
        for name, values in self.plan["tuned"].items():
            before = best["tuning"] if best else given
            for value in values:
                row = self.time_with(",".join(filter(None, [before, f"{name}={value}"])))
                if row is None:
                    continue
                rows.append(row)
                if best is None or row["seconds"] < (1 - WORTH_A_CHANGE) * best["seconds"]:
                    best = row
        self.record["tuning_tried"], self.record["tuning_best"] = rows, best
        say("Tuning values, and a row for kNamedDevices in src/tuning/tuning.cpp")
        for row in rows:
            times = [f"{1e3 * row[key]:9.3f} ms" for key in ("seconds", "solve_seconds")]
            print(f"{times[0]}, solve_blocks {times[1]}   {row['tuning']}")
        if best:
            device, size = self.record.get("probed", {}).get("device"), self.plan["tuned_size"]
            print(f'{{"{device}", "{best["tuning"]}", "scripts/gpu.py at {size} points."}},')

    def predict(self):
        """Predictions of the device's launches beside their times."""
        record = self.bench("Launches", "launches", "--sizes", self.plan["launch_sizes"])
        if "error" in record or "error" in self.record.get("probed", {"error": "not measured"}):
            return
        name = predict.machine_of(record)
        machine = predict.with_device_record(predict.read_machine(name), self.record["probed"])
        machine["name"] = f"{record['device']} (as {name}, with what was measured here)"
        static = os.path.join(SOURCE, "bench", "results", "static.json")
        model = predict.Model(machine, predict.registers_of(static, machine["architecture"]))
        say("Predicted beside measured")
        self.record["predictions"] = {"machine": name, "results": []}
        for summary in record["results"]:
            rows, totals = predict.predict_call(model, summary, predict.launches_of(record, summary))
            predict.print_call(machine, summary, rows, totals, True)
            self.record["predictions"]["results"].append(
                {"mode": summary["mode"], "distribution": summary["distribution"], "n": summary["n"], **totals,
                 "measured_seconds": summary["seconds_median"], "kernels": rows})

    def chosen(self):
        return ["--distributions", ",".join(DISTRIBUTIONS), "--modes", self.modes]

    def measure_peers(self):
        """Beside CGAL, if the benchmarks have it, and beside no other."""
        sizes = self.plan["peer_sizes"]
        about = self.run(os.path.join(self.folder, "flaunay-bench"), "peers", "--help", stdout=subprocess.PIPE, text=True)
        others = ["--peers", "cgal", "--peers-most", sizes[0]] if "  cgal:" in about.stdout else ["--peers-most", 1]
        self.bench("Times beside others", "peers", "--sizes", ",".join(map(str, sizes)), *others, *self.chosen())

    def measure_modes(self):
        self.bench("Times by number of points", "modes", "--sizes", self.plan["mode_sizes"], *self.chosen())

    def measure_embedding(self):
        self.bench("From device memory to device memory, and queries", "embedding", *self.plan["flags"])

    def measure_batches(self):
        self.bench("Thousands of sets in one call", "batches", *self.plan["flags"])

    def measure_cupy(self):
        say("CuPy's Delaunay triangulation (gDel2D)")
        self.record["cupy_verified"] = []
        probing = "import cupy, cupyx.scipy.spatial; cupy.cuda.Device().synchronize()"
        probe = subprocess.run([sys.executable, "-c", probing], stderr=subprocess.PIPE, text=True, check=False)
        if probe.returncode != 0:
            reason = (probe.stderr.strip().splitlines() or [f"exit code {probe.returncode}"])[-1]
            print(f"not measured: {reason}")
            self.record["cupy"] = {"measured": False, "reason": reason}
            return
        inputs = []
        for distribution in DISTRIBUTIONS:
            inputs += [self.points(f"{distribution}-{size}", distribution, size) for size in self.plan["peer_sizes"]]
            inputs.append(self.points(f"verify-{distribution}", distribution, self.plan["verify_size"]))
        # A separate process, because errors in CUDA can end it.
        command = [sys.executable, __file__, *self.plan["flags"], "--runs", str(self.plan["runs"]), "--output", self.work,
                   "--cupy", *inputs]
        result = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
        if result.returncode != 0:
            self.failures.append("CuPy")
            self.record["cupy"] = {"measured": False, "reason": f"exit code {result.returncode}"}
            return
        self.record["cupy"] = json.loads(result.stdout)
        # CuPy's triangles are checked like flaunay's, for information; errors in them are not failures of flaunay.
        for distribution in DISTRIBUTIONS:
            triangles = os.path.join(self.work, f"cupy-verify-{distribution}.npy")
            if os.path.exists(triangles):
                checked = self.flaunay("verify", os.path.join(self.work, f"verify-{distribution}.npy"), triangles,
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
                verdict = checked.stdout.replace(self.work + "/", "").splitlines()[0]
                print(f"CuPy, {distribution}, {self.plan['verify_size']} points: {verdict}")
                self.record["cupy_verified"].append({"distribution": distribution, "n": self.plan["verify_size"],
                                                     "verify": verdict})


def write_record(session, command_line, arguments):
    of_bench = next((session.record[part] for part in ("peers", "modes", "probed", "embedding", "batches", "launches")
                     if "device" in session.record.get(part, {})), {})
    record = {key: of_bench.get(key) for key in ("device", "driver", "platform", "host", "commit", "date")}
    record["command"] = f"scripts/gpu.py {' '.join(command_line)}"
    record["tuning"] = os.environ.get("FLAUNAY_TUNING", "")
    record.update({"quick": arguments.quick, "failures": session.failures, **session.record})
    name = re.sub(r"[^a-z0-9]+", "-", (record["device"] or "").lower()).strip("-") or "unknown-device"
    path = os.path.join(arguments.output, f"{name}.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(record, file, indent=1)
        file.write("\n")
    return path


def main(command_line):
    arguments = arguments_of(command_line)
    plan = QUICK if arguments.quick else FULL
    plan = dict(plan, runs=arguments.runs or plan["runs"], output=arguments.output)
    os.makedirs(arguments.output, exist_ok=True)
    parts = arguments.parts.split(",")
    if set(parts) - set(PARTS):
        fail(f"--parts has {', '.join(sorted(set(parts) - set(PARTS)))}; there are {', '.join(PARTS)}")
    if arguments.cupy:
        print(json.dumps(measure_cupy(arguments.cupy, plan["runs"], arguments.output)))
        return 0
    if arguments.pack:
        pack(build(), arguments.pack)
        return 0
    folder = os.path.abspath(arguments.prebuilt or build())
    for program in programs_in(folder)[0]:
        if not os.access(program, os.X_OK):
            fail(f"there is no program {program}")
    os.environ.update({"FLAUNAY_TEST_DATA": os.path.join(SOURCE, "tests", "data"),
                       "FLAUNAY_EXECUTABLE": os.path.join(folder, "flaunay"),
                       "FLAUNAY_BENCH": os.path.join(folder, "flaunay-bench"),
                       "FLAUNAY_PLOT": os.path.join(SOURCE, "bench", "plot.py")})
    with tempfile.TemporaryDirectory() as work:
        session = Session(folder, work, plan, arguments.modes)
        os.makedirs(session.libraries)
        add_missing_libraries(folder, session.libraries)
        if arguments.icd:
            use_drivers(arguments.icd, os.path.join(work, "vendors"))
        if arguments.device:
            os.environ["FLAUNAY_DEVICE"] = arguments.device
        say("Devices")
        if session.flaunay("devices").returncode != 0:
            fail("no usable device; --icd names a driver")
        actions = [session.conform, session.measure_device, session.test, session.verify, session.measure_peers,
                   session.measure_modes, session.measure_embedding, session.measure_batches, session.measure_cupy,
                   session.tune, session.predict]
        for part, action in zip(PARTS, actions):
            if part in parts:
                action()
                # After each part, so that a run that is ended leaves a record of the others.
                path = write_record(session, command_line, arguments)
        say("Done")
        print(f"record: {path}")
        if session.failures:
            print("\n".join(f"FAILED: {failure}" for failure in session.failures))
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
