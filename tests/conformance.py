#!/usr/bin/env python3
"""Tests this system's OpenCL device by `flaunay devices --test`, with the sizes of several kinds of devices, and that
every kernel is launched by one of them. usage: conformance.py FLAUNAY KERNELS WORK"""
import json
import os
import pathlib
import re
import subprocess
import sys

# A CPU's sizes; a GPU's, in groups of 32; fixed point, whose kernels have no counterpart on the host. Blocks of a few
# points are for the simulator (tests/oclgrind.sh).
TUNINGS = ["cpu", "gpu:32", "gpu,fixed_point=1"]
# What measures a device or tries its arithmetic, and has tests of its own (tests/call).
APART = {"call/probe", "call/rates", "call/self_test", "call/self_test_fixed"}


def kernels_in(folder):
    for path in sorted(folder.glob("*/*.cl")):
        program = path.relative_to(folder).with_suffix("").as_posix()
        if program not in APART:
            for name in re.findall(r"kernel void ([a-z_0-9]+)\(", path.read_text()):
                yield name


def main(command, kernels, work):
    work.mkdir(parents=True, exist_ok=True)
    failed, launched = False, set()
    for k, tuning in enumerate(TUNINGS):
        record = work / f"{k}.json"
        record.unlink(missing_ok=True)
        print(f"tuning {tuning}", flush=True)
        ended = subprocess.run([command, "devices", "--test", "--record", record], check=False,
                               env={**os.environ, "FLAUNAY_TUNING": tuning})
        failed = failed or ended.returncode != 0
        if record.exists():
            launched |= {name.split(": ")[1] for name in json.loads(record.read_text())["kernels"]}
    missing = sorted(set(kernels_in(kernels)) - launched)
    if missing:
        print(f"no call launches the kernels {', '.join(missing)}")
    return 1 if failed or missing else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])))
