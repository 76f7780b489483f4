#!/usr/bin/env python3
"""Tests OpenCL devices by `flaunay devices --test`: every call and every kernel, byte for byte, against the host.

  devices.py            all runtimes that can be had for CPUs from PyPI, with the sizes for the device and with those of
                        GPUs; they are installed by pip in an environment of its own, build/device-runtimes. Each process
                        loads one driver; at the end one loads two, which share the chunks of a triangulation.
  devices.py rusticl    Mesa's rusticl on the CPU, which has no double precision
  devices.py poor       a device that lacks double precision, 64-bit atomics, local memory, large work-groups and buffers
                        (PoCL with tests/support/poor_device.c). Clang reads all programs that were compiled for it, as a
                        device of 32 bits with nothing of that would.
  devices.py limited    one that lacks all of that but double precision

Exit code: 0; 1 if a result differed or a run failed; 77 if what is to be compared is not installed: no runtime of PyPI,
which takes a network, or no rusticl. With FLAUNAY_TEST_ALL=1 in the environment, rusticl must be installed. See
docs/known-issues.md for the devices that were tried.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent
SKIPPED = 77
TIMEOUT_SECONDS = 1200
INSTALL_SECONDS = 120
# Kernels with barriers run with a GPU's sizes.
TUNINGS = ["", "gpu"]
# Points of each input.
POINTS, FEW_POINTS = "300", "64"
# A block that a work-group halves.
BLOCK_POINTS = "1000"
# Two drivers share chunks. There are enough of them for the one that has more to compile.
CHUNKED_POINTS = 200000
CHUNK_POINTS = 5000
# The one whose LLVM is not in conflict with the system's.
TOGETHER = "Intel's CPU runtime"
# What devices lack, as tests/support/poor_device.c has it, with the sizes of launches. Work-groups share blocks if they
# have 16 KB of local memory.
LIMITS = "no-int64-atomics group=64 buffer=134217728 address-bits=32"
POOR, LIMITED = (f"no-fp64 local=16384 {LIMITS}", "gpu"), (f"local=8192 {LIMITS}", "gpu:32,fetch_ahead=6144")
# As a device compiles that has what OpenCL 1.2 requires, and addresses of 32 bits. Warnings tell of literals of type
# double.
CLANG = ["clang-14", "-x", "cl", "-target", "spir-unknown-unknown", "-fsyntax-only", "-Werror", "-Xclang",
         "-finclude-default-header", "-Xclang",
         "-cl-ext=-all,+cl_khr_global_int32_base_atomics,+cl_khr_global_int32_extended_atomics,"
         "+cl_khr_local_int32_base_atomics,+cl_khr_local_int32_extended_atomics,+cl_khr_byte_addressable_store"]


class Runtime:
    """packages: of PyPI; library: a pattern below their environment, or a path. known: what a message of a runtime says
    which cannot work on this machine, by no fault of flaunay."""

    def __init__(self, name, library, packages=(), known=None):
        self.name, self.library, self.packages, self.known = name, library, packages, known


REFERENCE = Runtime("PoCL of the system", "/etc/OpenCL/vendors/pocl.icd")
RUSTICL = Runtime("Mesa's rusticl", "/etc/OpenCL/vendors/rusticl.icd")
RUNTIMES = [
    Runtime("PoCL 3.0", "lib/python3*/site-packages/pyopencl/.libs/libpocl*.so", ["pocl-binary-distribution==3.0"],
            # Its LLVM is older than the processor.
            known="unknown target CPU"),
    Runtime("Intel's CPU runtime", "lib/libintelocl.so",
            ["intel-opencl-rt==2026.2.0", "intel-cmplr-lib-rt==2026.2.0", "tbb==2023.2.0"]),
]


class Tester:
    def __init__(self, build, folder, kind):
        self.build, self.flaunay, self.folder = build, build / "flaunay", folder
        # Tests of several kinds may run at the same time.
        self.outputs = folder / kind
        self.failures = 0

    def install(self, runtime):
        """Installs the packages unless they are there. Returns why it could not."""
        done = self.folder / f"{self.key(runtime)}.installed"
        if done.exists() and done.read_text().split() == runtime.packages:
            return None
        python = self.folder / "bin/python"
        pip = [python, "-m", "pip", "--disable-pip-version-check", "--no-input", "--quiet"]
        download = [*pip, "install", "--retries=1", "--timeout=20", "--only-binary=:all:", *runtime.packages]
        try:
            for command in [download] if python.exists() else [[sys.executable, "-m", "venv", self.folder], download]:
                subprocess.run(command, capture_output=True, text=True, timeout=INSTALL_SECONDS, check=True)
        except subprocess.CalledProcessError as error:
            return (error.stderr.strip().splitlines() or ["pip failed"])[-1]
        except subprocess.TimeoutExpired:
            return f"it takes more than {INSTALL_SECONDS} s"
        done.write_text("\n".join(runtime.packages))
        return None

    @staticmethod
    def key(runtime):
        return re.sub(r"[^a-z0-9]+", "-", runtime.name.lower())

    def drivers(self, runtime):
        """A folder that names the runtime's driver alone."""
        folder = self.outputs / "drivers" / self.key(runtime)
        folder.mkdir(parents=True, exist_ok=True)
        library = pathlib.Path(runtime.library)
        if library.is_absolute():
            shutil.copy(library, folder / "driver.icd")
        else:
            found = sorted(self.folder.glob(runtime.library))[0]
            (folder / "driver.icd").write_text(f"{found}\n")
        return folder

    def environment(self, runtime, tuning):
        environment = {**os.environ, "OCL_ICD_VENDORS": str(self.drivers(runtime)), "FLAUNAY_DEVICE": "#0",
                       "FLAUNAY_TUNING": tuning, "FLAUNAY_CACHE_DIR": str(self.folder / "cache")}
        # Two versions of PoCL do not share a folder; that of the system has compiled most kernels already.
        if runtime is not REFERENCE:
            environment["POCL_CACHE_DIR"] = str(self.folder / "cache" / self.key(runtime))
        return environment

    def run(self, name, tuning, command, environment, known=None):
        """Returns the path of the output, or None."""
        self.outputs.mkdir(parents=True, exist_ok=True)
        path = self.outputs / re.sub(r"[^a-z0-9]+", "-", f"{name} {tuning or 'default'}".lower())
        begin = time.time()
        with path.open("wb") as output:
            ended = subprocess.run(command, stdout=output, stderr=subprocess.PIPE, text=True, env=environment,
                                   errors="replace", timeout=TIMEOUT_SECONDS)
        said = ended.stderr.strip()
        label = f"{name}, tuning {tuning or 'of the device'}"
        if ended.returncode == 0:
            print(f"{label}: {said}, ran for {time.time() - begin:.0f} s", flush=True)
            return path
        if known is not None and known in said:
            print(f"{label}: left out, it does not work on this processor ({known})", flush=True)
        else:
            self.failures += 1
            different = [line for line in path.read_text(errors="replace").splitlines() if "DIFFERENT" in line]
            print("\n".join([f"{label}: FAILED, exit code {ended.returncode}", *different[:20], said]), flush=True)
        return None

    def test(self, name, tuning, environment, points=POINTS, known=None):
        path = self.run(name, tuning, [self.flaunay, "devices", "--test", "--points", points], environment, known)
        if path is not None:
            print("  " + path.read_text().splitlines()[-1], flush=True)

    def chunks_of(self, name, devices, environment):
        """The bytes of a triangulation in chunks, with each device's points, or None."""
        points, files = self.outputs / "points.npy", [self.outputs / f"chunks-{part}.npy" for part in "tn"]
        statistics = self.outputs / "chunks.json"
        command = [self.flaunay, "generate", "kuzmin", str(CHUNKED_POINTS), "-o", points]
        subprocess.run(command, check=True, capture_output=True)
        command = [self.flaunay, "triangulate", points, "--quiet", "--device", devices, "--chunk-points", str(CHUNK_POINTS),
                   "--triangles", files[0], "--neighbors", files[1], "--stats", statistics]
        if self.run(f"{name}, in chunks", "", command, environment) is None:
            return None
        shares = {share["device"]: share["points"] for share in json.loads(statistics.read_text())["chunks"]["devices"]}
        return [path.read_bytes() for path in files], shares

    def work_together(self, runtime):
        """Two drivers in one process take chunks from one queue."""
        environment = self.environment(runtime, "")
        both = self.outputs / "drivers" / f"{self.key(REFERENCE)}-and-{self.key(runtime)}"
        both.mkdir(parents=True, exist_ok=True)
        for number, each in enumerate([REFERENCE, runtime]):
            shutil.copy(self.drivers(each) / "driver.icd", both / f"{number}.icd")
        environment["OCL_ICD_VENDORS"] = str(both)
        together = self.chunks_of(f"{REFERENCE.name} with {runtime.name}", "#0,#1", environment)
        alone = self.chunks_of("the host", "host", environment)
        if together is None or alone is None:
            return
        shares = together[1]
        if together[0] != alone[0] or len(shares) != 2 or 0 in shares.values():
            self.failures += 1
            print(f"  DIFFERENT, or not done by both: {shares}", flush=True)
        else:
            print(f"  the same bytes; points of each device: {shares}", flush=True)

    def on_rusticl(self):
        """Returns whether there is such a device."""
        environment = {**self.environment(RUSTICL, ""), "RUSTICL_ENABLE": "llvmpipe"}
        listed = subprocess.run([self.flaunay, "devices"], capture_output=True, text=True, env=environment, check=False)
        if "rusticl" not in listed.stdout:
            return False
        self.test(RUSTICL.name, "", environment, FEW_POINTS)
        # Alone, a work-item would need more turns of its loops than it has.
        points, triangles = self.outputs / "block.npy", self.outputs / "block-triangles.npy"
        subprocess.run([self.flaunay, "generate", "uniform", BLOCK_POINTS, "-o", points], check=True, capture_output=True)
        for command in ["triangulate", points, "--quiet", "-o", triangles], ["verify", points, triangles]:
            self.run(f"{RUSTICL.name}, {command[0]} a block", "", [self.flaunay, *command], environment)
        return True

    def on_poor_device(self, limits, tuning):
        texts = self.outputs / "texts"
        shutil.rmtree(texts, ignore_errors=True)
        texts.mkdir(parents=True)
        # Nothing that was compiled before: the text is what matters.
        environment = {**self.environment(REFERENCE, tuning), "FLAUNAY_CACHE_DIR": "",
                       "LD_PRELOAD": str(self.build / "tests/libpoor_device.so"),
                       "POOR_DEVICE": f"{limits} texts={texts}"}
        self.test(limits, tuning, environment, FEW_POINTS)
        if "no-fp64" in limits:
            self.read_texts(sorted(texts.iterdir()))

    def read_texts(self, paths):
        """What Clang says of programs that were handed to a device. Their first lines have the options."""
        for path in paths:
            options = path.open().readline().split()[1:]
            said = subprocess.run([*CLANG, *options, path], capture_output=True, text=True, check=False)
            if said.returncode != 0:
                self.failures += 1
                print(f"  FAILED: {path}\n{said.stderr[:2000]}")
        if not paths:
            self.failures += 1
        print(f"  {len(paths)} programs need no double precision, no more atomics, and no addresses of 64 bits", flush=True)


def test_installable(tester):
    installed = []
    for runtime in RUNTIMES:
        reason = tester.install(runtime)
        if reason is None:
            installed.append(runtime)
        else:
            print(f"{runtime.name}: left out, it cannot be installed ({reason})", flush=True)
    for runtime in installed:
        for tuning in TUNINGS:
            tester.test(runtime.name, tuning, tester.environment(runtime, tuning), known=runtime.known)
        if runtime.name == TOGETHER:
            tester.work_together(runtime)
    if not installed:
        print("devices: SKIPPED, no runtime can be installed: is there no network?")
    return bool(installed)


def test_rusticl(tester):
    if tester.on_rusticl():
        return True
    print("devices: SKIPPED, there is no rusticl: apt-get install mesa-opencl-icd")
    tester.failures += os.environ.get("FLAUNAY_TEST_ALL") == "1"
    return False


def test_poor(tester, case=POOR):
    tester.on_poor_device(*case)
    return True


def test_limited(tester):
    return test_poor(tester, LIMITED)


TESTS = {"installable": test_installable, "rusticl": test_rusticl, "poor": test_poor, "limited": test_limited}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("devices", nargs="?", choices=TESTS, default="installable", help="what is tested")
    parser.add_argument("--build", type=pathlib.Path, default=SOURCE / "build/release",
                        help="the build folder, which has the command")
    parser.add_argument("--runtimes", type=pathlib.Path, default=SOURCE / "build/device-runtimes",
                        help="where runtimes are installed")
    arguments = parser.parse_args()
    tester = Tester(arguments.build.resolve(), arguments.runtimes.resolve(), arguments.devices)
    was_there = TESTS[arguments.devices](tester)
    if tester.failures:
        return 1
    return 0 if was_there else SKIPPED


if __name__ == "__main__":
    sys.exit(main())
