"""The report on the paper's claims, and its figures: what bench/drawing.py makes of a record of flaunay-bench paper."""
import os

import drawing

DISTRIBUTIONS = ["uniform", "normal", "kuzmin", "line"]
OURS, PUBLISHED, ALTERNATE = ("prune", "interquartile"), ("balanced", "alternate"), ("prune", "alternate")
DWYER = ("dwyer", "alternate")
COMPONENTS = ["sorting", "cuts", "hull", "merge", "split", "endgame"]

INTRODUCTION = """# The paper's experiments, made again

G. E. Blelloch, G. L. Miller, D. Talmor: *Developing a practical projection-based parallel Delaunay algorithm*, SoCG
1996, counted operations and depth on four distributions. These are the same experiments with flaunay. The counts do
not depend on the machine.

*flaunay* is prune and interquartile cuts, the defaults of the modes that follow the paper; *the paper's variant* is
the balanced hull and alternate cuts.
"""

DIFFERENCES = """
## How this differs from the paper

- **Cuts.** The paper cuts x and y in turn. flaunay cuts each region across its longer interquartile range, which keeps
  regions round and borders short on `line`; alternate cuts remain as an option.
- **Dividing paths.** The paper computes them by quickhull and mends its skewed splits with the balanced split of Chan,
  Snoeyink and Yap. flaunay first drops by candidates from buckets what cannot be on a path (prune), so that quickhull
  sees few points. All variants are measured here.
- **Degenerate input.** The paper assumes general position. Here every decision is exact and no input is perturbed;
  exact evaluations after an undecided filter are rare on these inputs and not counted.
- **End game.** Regions are cut until they have no internal points; each that remains is triangulated on its own: over
  an edge stands the corner that sees it under the greatest angle.
- **What is counted.** Floating-point operations including comparisons, as in the paper, but by rules of our own for
  each stage: [docs/counting.md](../../docs/counting.md). Dwyer's algorithm is counted by the same rules; both sort
  their input, and both counts include that.
- **Generators.** The same four distributions, from generators of our own.
"""


def percent(share, digits=0):
    return f"{100 * share:.{digits}f} %"


def listed(values, digits):
    return ", ".join(f"{distribution} {value:.{digits}f}" for distribution, value in values.items())


class Record:
    """The record by method, distribution and number of points."""

    def __init__(self, record):
        self.record = record
        self.rows = {(row["algorithm"], row["cut"], row["distribution"], row["n"]): row for row in record["results"]}
        self.sizes = drawing.names(record["results"], "n")
        self.largest = max(self.sizes)
        self.methods = list(dict.fromkeys((row["algorithm"], row["cut"]) for row in record["results"]))

    def spread(self, method, distribution, quantity, n=None):
        """Median, minimum and maximum of the instances."""
        return self.rows[(*method, distribution, n or self.largest)][quantity]

    def medians(self, method, quantity, n=None):
        return {one: self.spread(method, one, quantity, n)[0] for one in DISTRIBUTIONS}

    def row(self, table, method, distribution):
        return next(row for row in self.record[table]
                    if (row["algorithm"], row["cut"], row["distribution"]) == (*method, distribution))

    def levels(self, method, distribution, quantity):
        """Medians, level by level."""
        return list(enumerate(self.row("levels", method, distribution)[quantity]))

    def endgame(self, method, distribution):
        """How many regions there are by their number of corners, when the end game begins."""
        row = self.row("endgame", method, distribution)
        return list(zip(row["corners"], row["regions"]))

    def excess(self, method, quantity):
        """By how much more than on uniform points, by distribution."""
        medians = self.medians(method, quantity)
        return {one: value / medians["uniform"] - 1 for one, value in medians.items()}


def endgame_sizes(histogram):
    """Mean and largest number of corners, and the share of regions that have more than 50."""
    regions = sum(count for _, count in histogram)
    mean = sum(corners * count for corners, count in histogram) / regions
    return mean, histogram[-1][0], sum(count for size, count in histogram if size > 50) / regions


# ---- Claims


def claims(record):
    """(claim, measured, agrees, agrees in part, rule, reason why not) for each."""
    ours, published = record.medians(OURS, "over_dwyer"), record.medians(PUBLISHED, "over_dwyer")
    both = lambda a, b, digits: f"flaunay: {listed(a, digits)}; the paper's variant: {listed(b, digits)}"  # noqa: E731
    most, least = lambda values: max(values.values()), lambda values: min(values.values())
    yield ("work within a factor of about 2 of Dwyer's: 1.1 to 2.5 times, by distribution", both(ours, published, 2),
           max(most(ours), most(published)) <= 2.5, min(most(ours), most(published)) <= 2.5,
           "at most 2.5 times on every distribution; partly if by one of the two",
           "without prune, every round of quickhull holds every point that is left against a chord, 12 operations each "
           "time; and the corners of a region's border, which at the last levels are more than its points, are looked "
           "at anew at every level")
    inverse = [{one: 1 / value for one, value in values.items()} for values in (ours, published)]
    yield ("work efficiency (Dwyer's operations / the algorithm's) 0.4 to 0.9", both(*inverse, 2),
           min(map(least, inverse)) >= 0.4, max(map(least, inverse)) >= 0.4,
           "at least 0.4 on every distribution; partly if by one of the two", "as above, whose inverse it is")

    excess = {hull: [record.excess((hull, cut), "operations_per_point")["kuzmin"] for cut in ("interquartile",
                                                                                              "alternate")]
              for hull in ("quickhull", "balanced", "prune")}
    text = {hull: f"interquartile cuts {percent(a)}, alternate cuts {percent(b)}" for hull, (a, b) in excess.items()}
    yield ("kuzmin up to 75 % dearer than uniform with quickhull alone", text["quickhull"],
           all(0.5 <= value <= 1 for value in excess["quickhull"]), max(excess["quickhull"]) >= 0.25,
           "50 to 100 % with either cut; partly from 25 %",
           "it depends on quickhull's share of all work, and that on what each predicate counts")
    yield ("kuzmin up to 25 % dearer than uniform with the balanced hull",
           f"{text['balanced']}; with prune: {text['prune']}", max(excess["balanced"]) <= 0.35,
           all(a < b for a, b in zip(excess["balanced"], excess["quickhull"])),
           "at most 35 % with either cut; partly if less than with quickhull alone",
           "besides what a round of quickhull costs, a balanced one computes a slope for each pair, a height for each "
           "point, and a depth for each pair on one side; its better splits have to save that first")

    near = min(record.sizes, key=lambda n: max(n / 1e5, 1e5 / n))
    parallel = [record.medians(method, "parallelism", near) for method in (OURS, PUBLISHED)]
    yield ("work / depth about 10^4 at 10^5 points", f"at {near} points, {both(*parallel, 0)}",
           all(3.2e3 <= value <= 3.2e4 for values in parallel for value in values.values()),
           max(map(most, parallel)) >= 3.2e3, "all within half a decade of 10^4; partly if one is as high",
           "a round of quickhull is as deep here as its predicate is long, and a region's end game is sequential; less "
           "work for the same depth makes less parallelism")

    small, texts = [], []
    for method in (OURS, ALTERNATE):
        sizes = [endgame_sizes(record.endgame(method, one)) for one in DISTRIBUTIONS]
        mean, largest, share = (max(column) for column in zip(*sizes))
        small.append(mean < 10 and share < 0.01)
        texts.append(f"{method[1]} cuts: mean at most {mean:.1f}, over 50 at most {percent(share, 2)}, "
                     f"largest {largest}")
    yield ("components have fewer than 10 corners on average when the end game begins, rarely over 50",
           "; ".join(texts), all(small), any(small),
           "mean below 10 and less than 1 % of regions over 50, on every distribution with either cut; partly with one "
           "of them", "these are whole regions, which may fall apart into several components; and where alternate cuts "
           "run along dense strips, borders are long")

    worst, mean = (max(record.spread(method, one, quantity)[2] for method in (OURS, ALTERNATE)
                       for one in DISTRIBUTIONS) for quantity in ("worst_decline", "mean_decline"))
    yield ("the largest subproblem falls geometrically from level to level",
           f"to {mean:.2f} of the level before on average, to {worst:.2f} at worst", worst <= 0.75, mean <= 0.75,
           "to at most three quarters at every level, with either cut; partly if on average", "")

    coarse = [record.medians(method, "coarse_unsorted_over_dwyer") for method in (OURS, PUBLISHED)]
    spans = [f"{percent(least(values))} to {percent(most(values))}" for values in
             (*coarse, record.medians(OURS, "sorting_over_dwyer"))]
    levels = most(record.medians(OURS, "coarse_levels"))
    yield ("as a coarse partitioner the algorithm is nearly free",
           f"16 regions after {levels:.0f} levels, for {spans[0]} of all of Dwyer's operations (the paper's variant: "
           f"{spans[1]}); sorting, which a sequential algorithm needs too, takes {spans[2]}", most(coarse[0]) <= 0.1,
           least(coarse[0]) <= 0.1, "at most 10 % by flaunay on every distribution, after sorting; partly if on one",
           "a level touches every point, and a tenth of Dwyer's operations for four of them leaves a few operations "
           "for each")

    yield ("goal of this project: at most 1.0 times Dwyer's operations on each distribution", listed(ours, 2),
           most(ours) <= 1, least(ours) <= 1, "on every distribution; partly if on one", "")
    above = record.excess(OURS, "hull")
    yield ("goal of this project: no distribution more than 10 % above uniform in the hull",
           ", ".join(f"{one} {100 * above[one]:+.0f} %" for one in DISTRIBUTIONS[1:]), most(above) <= 0.1,
           min(above["kuzmin"], above["line"]) <= 0.1, "on every distribution; partly if on kuzmin or line", "")


# ---- Markdown


def table(header, rows):
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines) + "\n"


# ---- Figures


def by_size(record, panel, method, quantity, ylabel):
    drawing.lines(panel, {one: [(n, record.spread(method, one, quantity, n)) for n in record.sizes]
                          for one in DISTRIBUTIONS}, marker="")
    drawing.set_sizes(panel, record.sizes)
    panel.set(title=TITLES[method], ylabel=ylabel)


def over_dwyer(record, panel, method):
    by_size(record, panel, method, "over_dwyer", "times Dwyer's operations")
    for published in (1.1, 2.5):
        drawing.guide(panel, published)


def on_log(record, panel, *arguments):
    by_size(record, panel, *arguments)
    drawing.set_log(panel.yaxis)


def by_level(record, panel, method, quantity, ylabel, **options):
    drawing.lines(panel, {one: record.levels(method, one, quantity) for one in DISTRIBUTIONS}, marker="")
    panel.set(**{"title": f"{method[1]} cuts", "xlabel": "level", "ylabel": ylabel, **options})
    panel.minorticks_off()


def components(record, panel, cut):
    methods = [method for method in record.methods if method[1] == cut and method != DWYER] + [DWYER]
    bars = [(one, method) for one in DISTRIBUTIONS for method in methods]
    bottom = [0] * len(bars)
    for k, component in enumerate(COMPONENTS):
        heights = [record.spread(method, one, component)[0] for one, method in bars]
        panel.bar(range(len(bars)), heights, bottom=bottom, color=f"C{k}", label=component, clip_on=False)
        bottom = [a + b for a, b in zip(bottom, heights)]
    panel.set_xticks(range(len(bars)), [f"{one}, {method[0]}" for one, method in bars], rotation=40, ha="right")
    panel.set(title=f"{cut} cuts", ylabel="operations per point")


def endgame(record, panel, method):
    for k, one in enumerate(DISTRIBUTIONS):
        corners, counts = zip(*record.endgame(method, one))
        tail = [sum(counts[k:]) / sum(counts) for k in range(len(counts))]
        panel.plot(corners, tail, color=f"C{k}", label=one)
    panel.set(title=f"{method[1]} cuts", xscale="log", yscale="log", xlabel="corners",
              ylabel="share of regions with so many or more")
    panel.minorticks_off()


TITLES = {OURS: "flaunay", PUBLISHED: "the paper's variant", DWYER: "Dwyer's algorithm"}
LARGEST, SIZES = "internal points of the largest region", "(internal points + corners) / n"
COARSE = {"xlabel": "levels done", "yscale": "log"}
# Per file its description, the figure's title, the size of a panel, and the functions that draw the panels.
# Files are numbered as in the paper; figures from 13 on are not in the paper.
SECTIONS = {
    "figure-7-work": (
        "Floating-point operations per point, and as multiples of Dwyer's. The paper has 1.1 to 2.5 times.",
        "Work against Dwyer's algorithm", (4.2, 3.2), [
            (by_size, OURS, "operations_per_point", "operations per point"),
            (by_size, DWYER, "operations_per_point", "operations per point"), (over_dwyer, OURS),
            (over_dwyer, PUBLISHED)]),
    "figure-8-components": (
        "Operations per point by component, medians, for each way to compute the dividing paths, beside Dwyer's.",
        "Work by component", (11, 3.65), [(components, "interquartile"), (components, "alternate")]),
    "figure-9-depth": (
        "The critical path, summed over levels, and what it leaves for processors to do side by side.",
        "Depth, and work / depth", (4.2, 3.2), [
            (on_log, method, quantity, label) for quantity, label in (("depth", "depth (operations)"),
                                                                     ("parallelism", "work / depth"))
            for method in (OURS, PUBLISHED)]),
    "figures-10-and-11-levels": (
        "Internal points of the largest region of each level; internal points and border corners of all regions that "
        "are cut at a level, relative to n. Cuts go through the median, so no region has more than half of its "
        "parent's. Borders add to the sum, regions that are finished take from it.",
        "Subproblems of each level", (4.2, 3.2), [
            (lambda *all: by_level(*all, yscale="log"), OURS, "largest_region", LARGEST),
            (lambda *all: by_level(*all, yscale="log"), ALTERNATE, "largest_region", LARGEST),
            (by_level, OURS, "region_sizes_per_point", SIZES), (by_level, ALTERNATE, "region_sizes_per_point", SIZES)]),
    "figure-12-coarse-partition": (
        "Work up to each level, sorting included, relative to all of Dwyer's: what a coarse partitioner would have "
        "done when it hands over to a sequential algorithm.",
        "What a coarse partition would cost", (4.2, 3.2), [
            (lambda *all, title=TITLES[method]: by_level(*all, title=title, **COARSE), method, "work_before_over_dwyer",
             "operations so far / Dwyer's total") for method in (OURS, PUBLISHED)]),
    "figure-13-end-game": (
        "Corners of the regions that have no internal points left, all instances together.",
        "Regions when the end game begins", (4.2, 3.2), [(endgame, OURS), (endgame, ALTERNATE)]),
}


def draw(record, title, size, panels, path):
    header = dict(record.record, device="", driver="")
    figure, axes = drawing.new_figure(f"{title}; {record.largest} points at most", header, len(panels),
                                      1 if size[0] > 10 else 2, size)
    for axis, (function, *arguments) in zip(axes, panels):
        function(record, axis, *arguments)
    drawing.save(figure, path, axes)


def write(data, data_name, path):
    """Writes the report to path, and the figures beside it, named after it."""
    record = Record(data)
    name = os.path.splitext(path)[0]
    text = [INTRODUCTION, table(["record", ""], [
        ["command", f"`{data['command']}`"], ["commit", f"{data['commit']}, {data['date']}"],
        ["inputs", f"{min(record.sizes)} to {record.largest} points, {data['runs']} instances of each distribution"],
        ["numbers", f"medians of the instances, in brackets minimum to maximum ([data]({data_name}))"]]),
        f"\n## The paper's claims\n\nAt {record.largest} points unless it says otherwise.\n"]
    rows = []
    for claim, measured, agrees, in_part, rule, reason in claims(record):
        verdict = "agree" if agrees else "partly" if in_part else "disagree"
        rows.append([claim, measured, f"**{verdict}**", rule + (f". Why: {reason}" if reason and not agrees else "")])
    text += [table(["claim", "measured", "verdict", "agree if"], rows), DIFFERENCES, "\n## Figures\n"]
    for file, (caption, title, size, panels) in SECTIONS.items():
        draw(record, title, size, panels, f"{name}-{file}.svg")
        text.append(f"### {file.capitalize().replace('-', ' ')}\n\n{caption}\n\n"
                    f"![{file}]({os.path.basename(name)}-{file}.svg)\n")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(text).rstrip("\n") + "\n")
