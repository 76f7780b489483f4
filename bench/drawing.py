"""Figures of records: panels, lines, bars, and their SVG."""
import io
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


def set_log(axis, unit=None, places=None, log=True):
    """A logarithmic axis unless told otherwise, with figures such as 10k, and units."""
    if log and axis.axis_name == "y":
        axis.axes.set_yscale("log")
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(EngFormatter(unit=unit or "", sep=" " if unit else "", places=places))
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


def guide(panel, place, horizontal=True):
    """A dashed line across the panel."""
    (panel.axhline if horizontal else panel.axvline)(place, color="gray", linestyle="--", linewidth=0.8)


def save(figure, path, panels=()):
    """Writes a figure, half as long as Matplotlib would: without metadata, comments and needless digits, and with a
    class for each style."""
    legend_of(figure, panels)
    text = io.StringIO()
    figure.savefig(text, format="svg", bbox_inches="tight", metadata={"Date": None, "Creator": None})
    plt.close(figure)
    svg = re.sub(r"<\?xml.*?>|<metadata>.*?</metadata>|<!--.*?-->|<!DOCTYPE.*?>", "", text.getvalue(), flags=re.DOTALL)
    svg = re.sub(r'(?<=[ "(,\n-])(\d+\.\d)\d+', r"\1", svg)
    svg = re.sub(r"(\d)\.0(?=\D)", r"\1", svg)
    used = set(re.findall(r"#([^\")]*)", svg))
    svg = re.sub(r' id="([^"]*)"', lambda match: match[0] if match[1] in used else "", svg)
    styles = dict.fromkeys(re.findall(r' style="([^"]*)"', svg))
    classes = {style: f"s{k}" for k, style in enumerate(styles)}
    svg = re.sub(r' style="([^"]*)"', lambda match: f' class="{classes[match[1]]}"', svg)
    rules = "".join(f".{name}{{{style}}}\n" for style, name in classes.items())
    svg = svg.replace("<defs>", f'<style type="text/css">\n{rules}</style>\n<defs>', 1)
    with open(path, "w", encoding="utf-8") as file:
        file.write(re.sub(r"\s*\n\s*", "\n", svg))
