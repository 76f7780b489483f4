#!/usr/bin/python3
"""Draws a record of flaunay-bench as SVG.

  bench/plot.py RECORD.json -o FILE.svg
  bench/plot.py RECORD.json --part modes -o FILE.svg    a record within a record of scripts/gpu.py
  bench/plot.py PAPER.json -o FILE.md                   the report on the paper's claims, its figures beside it

Needs Matplotlib (on Debian: python3-matplotlib).
"""
import argparse
import json
import os

import paper
from drawing import bars, guide, in_seconds, lines, names, new_figure, save, set_log, set_sizes


def seconds_of(row):
    return [row[f"seconds_{name}"] for name in ("median", "min", "max")]


def valid(record):
    """Rows with a right result: the time of a wrong one says nothing."""
    return [row for row in record["results"] if row.get("agrees", True)]


def time_by_size(record, title):
    """Time per point, a panel for each distribution; of modes, where the fastest one changes."""
    rows = valid(record)
    distributions = names(rows, "distribution")
    figure, panels = new_figure(title, record, len(distributions))
    for panel, distribution in zip(panels, distributions):
        series = {name: [] for name in names(rows, "implementation")}
        for row in rows:
            if row["distribution"] == distribution:
                series[row["implementation"]].append((row["n"], [s / row["n"] for s in seconds_of(row)]))
        lines(panel, series)
        set_sizes(panel, {row["n"] for row in rows})
        set_log(panel.yaxis, "s")
        for crossover in record.get("crossovers", []):
            if crossover.get("of_fastest", True) and crossover["distribution"] == distribution:
                guide(panel, crossover["n"], horizontal=False)
                panel.annotate(f"{crossover['faster_below']} | {crossover['faster_above']}", (crossover["n"], 1),
                               xycoords=("data", "axes fraction"), fontsize=7, rotation=90, va="top", ha="right")
        panel.set(title=distribution, ylabel="time per point")
    return figure, panels


def bars_by_size(record, title, rows, group, name, value, unit, ylabel, what="points", log=True, **options):
    """Bars, a panel for each number of points."""
    sizes = names(rows, "n")
    figure, panels = new_figure(title, record, len(sizes), 1, (10, 3.4))
    for panel, n in zip(panels, sizes):
        bars(panel, [row for row in rows if row["n"] == n], group, name, value, **options)
        set_log(panel.yaxis, unit, log=log)
        panel.set(title=f"{n} {what}", ylabel=ylabel)
    return figure, panels


def time_bars(record, title, log=False, group="distribution"):
    return bars_by_size(record, title, valid(record), group, "implementation", seconds_of, "s", "time", log=log,
                        label=in_seconds)


def draw_peers(record):
    if len(names(record["results"], "n")) > 1:
        return time_by_size(record, "Delaunay triangulation by number of points")
    return time_bars(record, "Delaunay triangulation beside others")


def draw_threads(record):
    for row in record["results"]:
        row["group"] = f"{row['distribution']}, threads: {row['threads']}"
    return time_bars(record, "Time by number of threads", group="group")


def draw_ranks(record):
    """Wall time and CPU time per point by number of ranks, on the same points and on as many for each rank."""
    figure, panels = new_figure("Time by number of ranks", record, 4, 2)
    kinds = [(scaling, of, key, name) for scaling, of in (("strong", "the same points"),
                                                          ("weak", "as many points for each rank"))
             for key, name in (("seconds_median", "wall"), ("processor_seconds_median", "CPU"))]
    for panel, (scaling, of, key, name) in zip(panels, kinds):
        series = {name: [] for name in names(record["results"], "distribution")}
        for row in record["results"]:
            if row["scaling"] == scaling:
                # Older records call processor times so.
                seconds = row.get(key, row.get("cpu_seconds"))
                series[row["distribution"]].append((row["ranks"], seconds / row["n"]))
        lines(panel, series)
        panel.set_ylim(bottom=0)
        set_log(panel.yaxis, "s", log=False)
        panel.set_xticks(sorted({row["ranks"] for row in record["results"]}))
        panel.set(title=f"{scaling}: {of}", xlabel="ranks", ylabel=f"{name} time per point")
    return figure, panels


def draw_cliffs(record):
    figure, panels = bars_by_size(record, "Inputs on which triangulators are slow", record["cliffs"], "distribution",
                                  "implementation", lambda row: [row["times_uniform"]] * 3, None,
                                  "times its uniform time (dashed: limit)")
    for panel in panels:
        guide(panel, record["cliffs"][0]["limit"])
        panel.yaxis.set_major_formatter("{x:g}")
    return figure, panels


def draw_targets(record):
    """How far each target is reached: 1 is what it must be at least, a diamond is the goal."""
    rows = [row for row in record["targets"] if row["measured"] is not None]

    def reached(row, key):
        share = row[key] / row["at_least"]
        return share if row["more_is_better"] else 1 / share

    figure, (panel,) = new_figure("Targets", record, 1, 1, (11, 5))
    bars(panel, rows, "what", "implementation", lambda row: [reached(row, "measured")] * 3)
    whats = names(rows, "what")
    panel.plot([whats.index(row["what"]) for row in rows], [reached(row, "goal") for row in rows], "D", color="black",
               markersize=4, label="goal")
    guide(panel, 1)
    set_log(panel.yaxis)
    panel.yaxis.set_major_formatter("{x:g}")
    panel.set(ylabel="how far (1: what it must be at least)")
    return figure, [panel]


def draw_embedding(record):
    largest = max(row["n"] for row in record["results"])
    rows = [row for row in record["results"] if row["n"] == largest]
    figure, panels = new_figure(f"Embedded: {largest} points in device memory", record, 2, 1, (11, 3.4))
    for panel, triangulating in zip(panels, (True, False)):
        own = [dict(row, group=f"{row['parts']}, {row['precision']}" if triangulating else row["operation"])
               for row in rows if (row["operation"] == "triangulate") == triangulating]
        bars(panel, own, "group", "implementation", seconds_of, in_seconds)
        set_log(panel.yaxis, "s", log=not triangulating)
        panel.set(title="triangulate" if triangulating else "what is derived",
                  ylabel="time of a call" if triangulating else "time for all points or queries")
        panel.legend(fontsize=7)
    return figure, []


def draw_primitives(record):
    def rates(row):
        return [row["bytes"] / row[f"seconds_{name}"] for name in ("median", "max", "min")]
    return bars_by_size(record, "Vector operations: bytes that must be read and written, by time", record["results"],
                        "operation", "segmentation", rates, "B/s", "bytes per second", "elements", label=None)


DRAW = {
    "peers": draw_peers, "threads": draw_threads, "ranks": draw_ranks, "cliffs": draw_cliffs, "targets": draw_targets,
    "embedding": draw_embedding, "primitives": draw_primitives,
    "scaling": lambda record: time_by_size(record, "Time per point by number of points"),
    "small": lambda record: time_by_size(record, "Few points in a call"),
    "modes": lambda record: time_by_size(record, "Time by mode"),
    "batches": lambda record: time_bars(record, "Many sets in one call", log=True),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("record", help="what flaunay-bench --json has written")
    parser.add_argument("-o", "--output", required=True, help="where the SVG goes; of the paper, the report (.md)")
    parser.add_argument("--part", help="a record within the record")
    arguments = parser.parse_args()
    with open(arguments.record, encoding="utf-8") as file:
        record = json.load(file)
    if arguments.part:
        record = record[arguments.part]
    subcommand = record.get("subcommand")
    if subcommand == "paper":
        paper.write(record, os.path.basename(arguments.record), arguments.output)
    elif subcommand in DRAW:
        figure, panels = DRAW[subcommand](record)
        save(figure, arguments.output, panels)
    else:
        parser.error(f"{arguments.record} is no record that can be drawn")


if __name__ == "__main__":
    main()
