#!/usr/bin/python3
"""Draws a record of flaunay-bench as SVG.

  bench/plot.py RECORD.json -o FILE.svg
  bench/plot.py RECORD.json --part modes -o FILE.svg    a record within a record of scripts/gpu.py
  bench/plot.py PAPER.json -o FILE.md                   the report on the paper's claims, its figures beside it

Needs Matplotlib (on Debian: python3-matplotlib).
"""
import argparse
import io
import json
import os
import re

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import EngFormatter, LogLocator, NullLocator  # noqa: E402

# Text stays text, so that files are small; a fixed salt makes equal records equal files.
plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "flaunay", "font.sans-serif": ["DejaVu Sans"],
                     "font.size": 9, "axes.grid": True, "axes.grid.axis": "y", "grid.alpha": 0.3,
                     "axes.axisbelow": True, "legend.frameon": False, "figure.constrained_layout.use": True})


def names(rows, key):
    """The values of a key in the order of their first use."""
    return list(dict.fromkeys(row[key] for row in rows))


def seconds_of(row):
    return [row[f"seconds_{name}"] for name in ("median", "min", "max")]


def valid(record):
    """Rows with a right result: the time of a wrong one says nothing."""
    return [row for row in record["results"] if row.get("agrees", True)]


def new_figure(title, record, panels, columns=0, size=(4.2, 3.2)):
    """A figure with a grid of panels, and the panels."""
    columns = columns or min(panels, 3)
    rows = -(-panels // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(size[0] * columns, size[1] * rows + 0.7), squeeze=False)
    runs = f"median of {record['runs']} runs, minimum to maximum" if record["runs"] > 1 else "one run"
    device = f"; {record['device']}" if record["device"] else ""
    device += f", driver {record['driver']}" if record["driver"] else ""
    figure.suptitle(f"{title}\n{runs}{device}", fontsize=10)
    panel_list = list(axes.flat)
    for unused in panel_list[panels:]:
        unused.set_visible(False)
    return figure, panel_list[:panels]


def legend_of(figure, panels):
    """One legend for all panels, in which each name stands once."""
    entries = {}
    for panel in panels:
        for handle, label in zip(*panel.get_legend_handles_labels()):
            entries.setdefault(label, handle)
    if entries:
        figure.legend(entries.values(), entries.keys(), loc="upper center", bbox_to_anchor=(0.5, 0),
                      ncol=min(len(entries), 5))


in_seconds = EngFormatter(unit="s", places=1).format_data


def set_log(axis, unit=None, places=None):
    axis.set_major_formatter(EngFormatter(unit=unit or "", sep=" " if unit else "", places=places))
    if axis.axis_name == "y" and axis.get_scale() == "log":
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_minor_locator(NullLocator())


def set_sizes(panel, sizes):
    """Numbers of points along x: 16k stands for 2^14, too."""
    panel.set_xscale("log", base=2 if all(n & (n - 1) == 0 for n in sizes) else 10)
    set_log(panel.xaxis, places=0)
    panel.set(xlabel="points")


def lines(panel, series, marker="osD^vP*X"):
    """series: {name: [(x, y)]}, where y is a number or (median, low, high)"""
    for k, (name, points) in enumerate(series.items()):
        if not points:
            continue
        x, y = zip(*sorted(points))
        spreads = [value if isinstance(value, list) else None for value in y]
        panel.plot(x, [spread[0] if spread else value for value, spread in zip(y, spreads)], label=name,
                   marker=marker[k % 8:k % 8 + 1], markersize=3.5, linewidth=1.2, color=f"C{k}")
        if all(spreads):
            panel.fill_between(x, [low for _, low, _ in spreads], [high for _, _, high in spreads], alpha=0.2,
                               color=f"C{k}", linewidth=0)


def bars(panel, rows, group, name, value, label="{:.3g}".format):
    """Groups of bars: group and name are keys of the rows, value(row) is (median, low, high); label(median) stands
    above."""
    groups, all_names = names(rows, group), names(rows, name)
    width = 0.8 / len(all_names)
    for k, one in enumerate(all_names):
        own = [row for row in rows if row[name] == one]
        x = [groups.index(row[group]) + (k - (len(all_names) - 1) / 2) * width for row in own]
        spread = [value(row) for row in own]
        heights = [median for median, _, _ in spread]
        panel.bar(x, heights, width, color=f"C{k}", label=one, ecolor="black", error_kw={"linewidth": 0.7},
                  yerr=[[median - low for median, low, _ in spread], [high - median for median, _, high in spread]])
        if label:
            for at, height in zip(x, heights):
                panel.annotate(label(height), (at, height), xytext=(0, 2), textcoords="offset points",
                               ha="center", va="bottom", fontsize=6, rotation=90 if len(groups) > 5 else 0)
    panel.set_xticks(range(len(groups)), groups, rotation=25 if len(groups) > 5 else 0,
                     ha="right" if len(groups) > 5 else "center")
    panel.margins(y=0.15)


def time_by_size(record, title):
    """Time per point, a panel for each distribution; of modes, where the fastest one changes."""
    rows = valid(record)
    distributions = names(rows, "distribution")
    figure, panels = new_figure(title, record, len(distributions))
    everyone = names(rows, "implementation")
    for panel, distribution in zip(panels, distributions):
        series = {name: [] for name in everyone}
        for row in rows:
            if row["distribution"] == distribution:
                series[row["implementation"]].append((row["n"], [s / row["n"] for s in seconds_of(row)]))
        lines(panel, series)
        set_sizes(panel, {row["n"] for row in rows})
        panel.set_yscale("log")
        set_log(panel.yaxis, "s")
        for crossover in record.get("crossovers", []):
            if crossover["of_fastest"] and crossover["distribution"] == distribution:
                panel.axvline(crossover["n"], color="gray", linestyle="--", linewidth=0.8)
                panel.annotate(f"{crossover['faster_below']} | {crossover['faster_above']}", (crossover["n"], 1),
                               xycoords=("data", "axes fraction"), fontsize=7, rotation=90, va="top", ha="right")
        panel.set(title=distribution, ylabel="time per point")
    return figure, panels


def time_bars(record, title, log=False, group="distribution"):
    """Times as bars, a panel for each number of points."""
    rows = valid(record)
    sizes = names(rows, "n")
    figure, panels = new_figure(title, record, len(sizes), 1, (9, 3.4))
    for panel, n in zip(panels, sizes):
        bars(panel, [row for row in rows if row["n"] == n], group, "implementation", seconds_of, in_seconds)
        if log:
            panel.set_yscale("log")
        set_log(panel.yaxis, "s")
        panel.set(title=f"{n} points", ylabel="time")
    return figure, panels


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
    scalings = [(scaling, key) for scaling in ("strong", "weak") for key in ("wall", "CPU")]
    for panel, (scaling, key) in zip(panels, scalings):
        series = {name: [] for name in names(record["results"], "distribution")}
        for row in record["results"]:
            if row["scaling"] == scaling:
                seconds = row["cpu_seconds"] if key == "CPU" else row["seconds_median"]
                series[row["distribution"]].append((row["ranks"], seconds / row["n"]))
        lines(panel, series)
        panel.set_ylim(bottom=0)
        panel.yaxis.set_major_formatter(EngFormatter("s"))
        panel.set_xticks(sorted({row["ranks"] for row in record["results"]}))
        of = "the same points" if scaling == "strong" else "as many points for each rank"
        panel.set(title=f"{scaling}: {of}", xlabel="ranks", ylabel=f"{key} time per point")
    return figure, panels


def draw_cliffs(record):
    sizes = names(record["cliffs"], "n")
    figure, panels = new_figure("Inputs on which triangulators are slow", record, len(sizes), 1, (10, 3.2))
    for panel, n in zip(panels, sizes):
        bars(panel, [row for row in record["cliffs"] if row["n"] == n], "distribution", "implementation",
             lambda row: [row["times_uniform"]] * 3)
        panel.set_yscale("log")
        set_log(panel.yaxis)
        panel.axhline(record["cliffs"][0]["limit"], color="gray", linestyle="--", linewidth=0.8)
        panel.set(title=f"{n} points", ylabel="times its own uniform time")
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
    panel.axhline(1, color="gray", linewidth=0.8)
    panel.set_yscale("log")
    set_log(panel.yaxis)
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
        if not triangulating:
            panel.set_yscale("log")
        set_log(panel.yaxis, "s")
        panel.set(title="triangulate" if triangulating else "what is derived",
                  ylabel="time of a call" if triangulating else "time for all points or queries")
        panel.legend(fontsize=7)
    return figure, []


def draw_primitives(record):
    sizes = names(record["results"], "n")
    figure, panels = new_figure("Vector operations: bytes that must be read and written, by time", record, len(sizes),
                                1, (11, 3.6))
    for panel, n in zip(panels, sizes):
        bars(panel, [row for row in record["results"] if row["n"] == n], "operation", "segmentation",
             lambda row: [row["bytes"] / seconds for seconds in (row["seconds_median"], row["seconds_max"],
                                                                 row["seconds_min"])], label=None)
        panel.set_yscale("log")
        set_log(panel.yaxis, "B/s")
        panel.set(title=f"{n} elements", ylabel="bytes per second")
    return figure, panels


DRAW = {
    "peers": draw_peers, "threads": draw_threads, "ranks": draw_ranks, "cliffs": draw_cliffs, "targets": draw_targets,
    "embedding": draw_embedding, "primitives": draw_primitives,
    "scaling": lambda record: time_by_size(record, "Time per point by number of points"),
    "small": lambda record: time_by_size(record, "Few points in a call"),
    "modes": lambda record: time_by_size(record, "Time by mode"),
    "batches": lambda record: time_bars(record, "Many sets in one call", log=True),
}


def without_groups(svg):
    """Without those groups that have no attributes, and so no effect."""
    kept = []

    def keep(match):
        if match[0] != "</g>":
            kept.append(match[0] != "<g>")
        return match[0] if (kept.pop() if match[0] == "</g>" else kept[-1]) else ""
    return re.sub(r"<g\b[^>]*>|</g>", keep, svg)


def short_path(match):
    """A path of lines, in which those along an axis name one coordinate."""
    at, path = (None, None), ""
    for command, x, y in re.findall(r"([MLz])\s*(?:(\S+) ([^\sMLz]+))?", match[1]):
        if command == "L" and (x == at[0] or y == at[1]):
            path += f"V{y}" if x == at[0] else f"H{x}"
        else:
            path += command + (f"{x} {y}" if x else "")
        at = (x, y)
    return f' d="{path}"'


def save(figure, path, panels=()):
    """Writes a figure, a third as long as Matplotlib would: without metadata, comments, needless groups and digits, and
    with short names and a class for each style."""
    legend_of(figure, panels)
    text = io.StringIO()
    figure.savefig(text, format="svg", bbox_inches="tight", metadata={"Date": None, "Creator": None})
    plt.close(figure)
    svg = re.sub(r"<\?xml.*?>|<metadata>.*?</metadata>|<!--.*?-->|<!DOCTYPE.*?>", "", text.getvalue(), flags=re.DOTALL)
    svg = re.sub(r'(?<=[ "(,\n-])(\d+\.\d)\d+', r"\1", svg)
    svg = re.sub(r"(\d)\.0(?=\D)", r"\1", svg)
    svg = re.sub(r' transform="rotate\(-0[^"]*"', "", svg)
    used = set(re.findall(r"#([^\")]*)", svg))
    svg = re.sub(r' id="([^"]*)"', lambda match: match[0] if match[1] in used else "", svg)
    svg = without_groups(svg)
    for k, name in enumerate(dict.fromkeys(re.findall(r' id="([^"]*)"', svg))):
        svg = re.sub(rf'(?<=["#]){re.escape(name)}(?=[")])', f"n{k}", svg)
    svg = re.sub(r' d="([^"CQ]*)"', short_path, svg)
    styles = dict.fromkeys(re.findall(r' style="([^"]*)"', svg))
    classes = {style: f"s{k}" for k, style in enumerate(styles)}
    svg = re.sub(r' style="([^"]*)"', lambda match: f' class="{classes[match[1]]}"', svg)
    rules = "".join(f".{name}{{{style}}}\n" for style, name in classes.items())
    svg = svg.replace("<defs>", f'<style type="text/css">\n{rules}</style>\n<defs>', 1)
    svg = re.sub(r"\s*\n\s*", "\n", svg)
    with open(path, "w", encoding="utf-8") as file:
        file.write(svg)


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
        import paper
        paper.write(record, os.path.basename(arguments.record), arguments.output)
    elif subcommand in DRAW:
        figure, panels = DRAW[subcommand](record)
        save(figure, arguments.output, panels)
    else:
        parser.error(f"{arguments.record} is no record that can be drawn")


if __name__ == "__main__":
    main()
