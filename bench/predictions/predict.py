#!/usr/bin/env python3
"""Predicts times of a call on a machine from the launches that `flaunay-bench launches --json` has recorded.

    bench/predictions/predict.py LAUNCHES.json --machine h200
    bench/predictions/predict.py LAUNCHES.json --machine pocl-2-cores --device-record DEVICE.json --measured

It is a model, not a measurement. A launch takes the longest of

    chain    the longest chain of steps of one work-item, times what a step takes on one lane
    lanes    all steps, times what a step takes on one lane, shared by the lanes that hold work-items at once
    issue    all instructions, at the rate of all cores
    fp64     all operations of double precision, at the rate of all cores
    convert  all conversions from 64-bit integers to single precision, likewise
    cache    all bytes that the cache that holds a block must move, at its bandwidth
    memory   all bytes, at the memory's bandwidth

and the cost of a launch. A step on one lane takes its instructions, of which those of double precision may take longer,
its mispredicted branches, and its loads that wait for each other; where work-items of a warp go different ways, their
paths come one after the other. Waits of the host and transfers are added, but not what the host computes itself.
machines/ has the machines, with a source for each value, and kernels.json what a step of each kernel is made of, in
double precision and in fixed point: a record with the tuning fixed_point=1 takes the latter.
docs/performance-history.md shows predictions beside measurements.
"""
import argparse
import json
import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
# Assumed for a kernel that the static table lacks.
REGISTERS = 64
# "work_items_of_most_instructions" refers to the launches with this share of the instructions.
MOST = 0.9
# A work-item with at least this many elements has a chunk of its own, so a warp's accesses are far apart.
LEAST_ELEMENTS_OF_CHUNKS = 2


def fail(message):
    print(f"predict.py: {message}", file=sys.stderr)
    sys.exit(2)


def load(path):
    try:
        return json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        fail(f"{path} cannot be read: {error}")


def machine_names():
    return sorted(path.stem for path in (FOLDER / "machines").glob("*.json"))


def read_machine(name):
    """The machine's values without their sources."""
    if name not in machine_names():
        fail(f"there is no machine {name}; there are {', '.join(machine_names())}")
    values = load(FOLDER / "machines" / f"{name}.json")
    return {key: value["value"] if isinstance(value, dict) else value for key, value in values.items()}


def machine_of(record):
    """The machine whose file names the record's device, or else one of its type."""
    for name in machine_names():
        if any(part in record["device"] for part in read_machine(name)["matches"]):
            return name
    return "cpu-64-cores" if record.get("device_type") == "CPU" else "rtx-4090"


def with_device_record(machine, record):
    """The machine with what `flaunay-bench device` has measured in place of what its file says."""
    measured = {row["what"]: row["median"] for row in record["results"]}
    load_of = "load that waits for a load, of {} KiB".format
    found = {"launch_seconds": measured["launch"],
             "wait_seconds": max(0, measured["launch and wait"] - measured["launch"]),
             "near_seconds": measured.get(load_of(machine["near_kib"])),
             "far_seconds": measured.get(load_of(machine["far_kib"])),
             "bytes_per_second": measured["bytes read and written by a copy"],
             "cores": record.get("compute_units")}
    if machine["kind"] == "gpu":
        found["fp64_per_second"] = measured["operations of fp64, many work-items"]
        found["transfer_bytes_per_second"] = measured["bytes to the device"]
        found["clock_hz"] = 1e6 * record.get("clock_mhz", 0)
    return dict(machine, **{key: value for key, value in found.items() if value})


def with_cores(machine, cores):
    """The machine with some of its cores; bandwidth is shared by all, up to what one core can use."""
    share = cores / machine["cores"]
    bandwidth = machine["bytes_per_second"]
    if "bytes_per_second_of_a_core" in machine:
        bandwidth = min(bandwidth, cores * machine["bytes_per_second_of_a_core"])
    return dict(machine, cores=cores, fp64_per_second=share * machine["fp64_per_second"],
                conversions_per_second=share * machine["conversions_per_second"], bytes_per_second=bandwidth)


def steps_of(launch):
    return launch["steps"] or launch["work_items"] * launch["elements"]


def in_fixed_point(cost):
    """What a step takes without fp64: as counted, or as many instructions more as there were operations, on 64 bits."""
    more = {"instructions": cost["instructions"] + cost["fp64"], **cost.get("fixed_point", {})}
    return {**cost, **more, "fp64": 0}


def is_in_fixed_point(record):
    return "fixed_point=1" in record.get("tuning", "").split(",")


class Model:
    """What launches take on a machine. registers: by kernel. fixed_point: instead of double precision."""

    def __init__(self, machine, registers=None, fixed_point=False):
        self.machine, self.registers, self.fixed_point = machine, registers or {}, fixed_point
        self.kernels = load(FOLDER / "kernels.json")["kernels"]
        if fixed_point:
            self.kernels = {kernel: in_fixed_point(cost) for kernel, cost in self.kernels.items()}

    def cost(self, launch):
        return self.kernels.get(launch["kernel"], self.kernels["any other"])

    def work_items_of_most_instructions(self, launches):
        """The largest w such that launches of at least w work-items do most of the instructions, on any machine."""
        sizes = {}
        for launch in launches:
            instructions = steps_of(launch) * self.cost(launch)["instructions"]
            sizes[launch["work_items"]] = sizes.get(launch["work_items"], 0) + instructions
        done = 0
        for work_items in sorted(sizes, reverse=True):
            done += sizes[work_items]
            if done >= MOST * sum(sizes.values()):
                return work_items
        return 0

    def step_seconds(self, cost):
        m = self.machine
        cycles = (cost["instructions"] - cost["fp64"]) * m["cycles_per_instruction"] + cost["fp64"] * m["fp64_cycles"]
        cycles += cost.get("conversions", 0) * (m["conversion_cycles"] - m["cycles_per_instruction"])
        cycles += cost["mispredictions"] * m["misprediction_cycles"]
        seconds = cycles / m["clock_hz"]
        # Out-of-order cores overlap the loads of consecutive elements, unless a step needs the one before.
        if m["kind"] == "gpu" or cost["serial"]:
            seconds += cost["near"] * m["near_seconds"] + cost["far"] * m["far_seconds"]
        return seconds

    def paths(self, cost, launch):
        """How many times as long a divergent warp takes as its longest lane alone."""
        lanes = min(self.machine["warp"], launch["busy"], launch["work_items"])
        return lanes / max(1, lanes * self.machine["active_share"]) if cost["divergent"] else 1

    def resident(self, kernel):
        m = self.machine
        registers = self.registers.get(kernel, REGISTERS)
        return m["cores"] * min(m["resident_per_core"], m["registers_per_core"] / max(1, registers))

    def launch(self, launch):
        """Seconds, and what bounds them."""
        m = self.machine
        cost = self.cost(launch)
        if launch["work_items"] == 0:  # a fill or a copy
            times = {"memory": launch["bytes"] / m["bytes_per_second"]}
        else:
            chain = max(1, launch["longest_chain"] or launch["elements"])
            steps = steps_of(launch)
            paths = self.paths(cost, launch)
            scattered = m["kind"] == "gpu" and (cost["divergent"] or launch["elements"] >= LEAST_ELEMENTS_OF_CHUNKS)
            step = self.step_seconds(cost) * paths
            # A divergent warp executes only the lanes of one path at once.
            per_core = m["lanes_per_core"] / (m["cycles_per_instruction"] if m["kind"] == "cpu" else 1)
            active_share = m["active_share"] if cost["divergent"] else 1
            rate = m["cores"] * per_core * m["clock_hz"] * active_share
            times = {"chain": chain * step,
                     "lanes": steps * step / min(launch["work_items"], self.resident(launch["kernel"])),
                     "issue": steps * cost["instructions"] / rate,
                     "fp64": steps * cost["fp64"] / (m["fp64_per_second"] * active_share),
                     "convert": steps * cost.get("conversions", 0) / (m["conversions_per_second"] * active_share),
                     "cache": steps * cost.get("near_bytes", 0) / m.get("near_bytes_per_second", m["bytes_per_second"]),
                     "memory": steps * cost["scattered_bytes" if scattered else "bytes"] / m["bytes_per_second"]}
        times["launch"] = m["launch_seconds"]
        bound = max(times, key=times.get)
        return times[bound], bound


def predict_call(model, summary, launches):
    """One call: rows by kernel, the longest first, and the totals. Launches overlap the work of those before."""
    kernels = {}
    for launch in launches:
        seconds, bound = model.launch(launch)
        row = kernels.setdefault(launch["kernel"], {"kernel": launch["kernel"], "launches": 0, "predicted_seconds": 0,
                                                    "measured_seconds": 0, "bounds": {}})
        row["launches"] += 1
        row["predicted_seconds"] += seconds
        row["measured_seconds"] += launch["seconds"]
        row["bounds"][bound] = row["bounds"].get(bound, 0) + seconds
    rows = sorted(kernels.values(), key=lambda row: -row["predicted_seconds"])
    for row in rows:
        bounds = row.pop("bounds")
        row["bound"] = max(bounds, key=bounds.get)
    machine = model.machine
    on_device = sum(row["predicted_seconds"] for row in rows) + summary["host_waits"] * machine["wait_seconds"]
    rate = machine["transfer_bytes_per_second"]
    transfers = (summary["bytes_to_device"] + summary["bytes_to_host"]) / rate if rate else 0
    return rows, {"fixed_point": model.fixed_point, "device_seconds": on_device, "call_seconds": on_device + transfers,
                  "points_per_second": summary["n"] / on_device,
                  "work_items_of_most_instructions": model.work_items_of_most_instructions(launches)}


def launches_of(record, summary):
    return [launch for launch in record["launches"]
            if all(launch[key] == summary[key] for key in ("mode", "distribution", "n"))]


def registers_of(path, architecture, fixed_point=False):
    if not architecture or not pathlib.Path(path).exists():
        return {}
    return {row["kernel"]: row["registers"] for row in load(path)["results"]
            if row["architecture"] == architecture and row.get("fixed_point", False) == fixed_point}


def print_call(machine, summary, rows, totals, measured):
    def milliseconds(seconds):
        return f"{1e3 * seconds:.3g}"

    print(f"\nPREDICTED, not measured: {machine['name']}, mode {summary['mode']}, {summary['n']} points of "
          f"{summary['distribution']}{', in fixed point' * totals['fixed_point']}")
    lines = [["kernel", "launches", "predicted ms", "bound by", "measured ms"]]
    lines += [[row["kernel"], str(row["launches"]), milliseconds(row["predicted_seconds"]), row["bound"],
               milliseconds(row["measured_seconds"])] for row in rows]
    lines.append(["device to device", str(summary["kernel_launches"]), milliseconds(totals["device_seconds"]), "", ""])
    of_call = milliseconds(summary["seconds_median"])
    lines.append(["host to host", "", milliseconds(totals["call_seconds"]), "", of_call])
    texts = ["| " + " | ".join(line if measured else line[:-1]) + " |" for line in lines]
    print("\n".join([texts[0], "|---|--:|--:|---|" + "--:|" * measured, *texts[1:]]))
    print(f"\nLaunches of at least {totals['work_items_of_most_instructions']} work-items do {MOST:.0%} of the "
          "instructions.")


def main(command_line):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("launches", metavar="LAUNCHES.json", help="a record of flaunay-bench launches")
    parser.add_argument("--machine", metavar="NAME", action="append", default=[],
                        help=f"{', '.join(machine_names())}; more than once for several")
    parser.add_argument("--for-device", action="store_true", help="the machine file that fits the record's device")
    parser.add_argument("--cores", type=int, help="so many of the machine's cores")
    parser.add_argument("--device-record", metavar="FILE", help="a record of flaunay-bench device on that machine")
    parser.add_argument("--static", metavar="FILE", default=FOLDER.parent / "results" / "static.json",
                        help="the static table, for the kernels' registers")
    parser.add_argument("--measured", action="store_true", help="the record's times beside the predictions")
    parser.add_argument("--json", metavar="FILE", help="write the predictions here")
    arguments = parser.parse_args(command_line)
    record = load(arguments.launches)
    if record.get("subcommand") != "launches":
        fail(f"{arguments.launches} is no record of flaunay-bench launches")
    names, results = arguments.machine + [machine_of(record)] * arguments.for_device, []
    if not names:
        fail("--machine names a machine, or --for-device takes the record's")
    for name in names:
        machine = read_machine(name)
        if arguments.device_record:
            machine = with_device_record(machine, load(arguments.device_record))
        if arguments.cores:
            machine = with_cores(machine, arguments.cores)
        fixed_point = is_in_fixed_point(record)
        model = Model(machine, registers_of(arguments.static, machine["architecture"], fixed_point), fixed_point)
        for summary in record["results"]:
            rows, totals = predict_call(model, summary, launches_of(record, summary))
            print_call(machine, summary, rows, totals, arguments.measured)
            results.append({"machine": name, "cores": machine["cores"], "mode": summary["mode"],
                            "distribution": summary["distribution"], "n": summary["n"], **totals, "kernels": rows})
    if arguments.json:
        text = {"predicted": True, "command": f"bench/predictions/predict.py {' '.join(command_line)}",
                "launches": pathlib.Path(arguments.launches).name, "results": results}
        pathlib.Path(arguments.json).write_text(json.dumps(text, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
