"""A plot that knows its numbers: drawn with matplotlib, readable on white and on dark pages."""

import io
import re

import matplotlib

matplotlib.use("Agg")
from matplotlib.figure import Figure  # noqa: E402  (the backend is chosen first)

# Text and axes take the colour of the page: this one stands for it until the file is written.
INK = "#000001"
GREY = "#808080"
# Between a third and a half of white's luminance: visible on both pages. Markers differ as well.
LOOKS = {
    "svgf": ("#7d7d7d", "o"), "rectification": ("#3d8bdb", "s"), "adapted": ("#2f9e5b", "^"),
    "separable": ("#cf8000", "D"), "reinhard": ("#c95fa6", "v"), "best": ("#e0513f", "*"),
    "fast_history": ("#8d74d6", "P"), "percentile": ("#5f9ea0", "X"), "gradient": ("#a58a2e", "h"),
    "best_upsampled": ("#d97b5a", "<"), "best_indirect": ("#e0513f", ">"), "paper": ("#7d7d7d", "o"),
}
OTHERS = ("#3d8bdb", "#e0513f", "#2f9e5b", "#cf8000", "#c95fa6", "#8d74d6", "#5f9ea0", "#a58a2e",
          "#7d7d7d", "#d97b5a")

STYLE = {
    "svg.fonttype": "none", "svg.hashsalt": "heliograph", "font.family": "sans-serif",
    "font.size": 9.0, "text.color": INK, "axes.labelcolor": INK, "axes.edgecolor": GREY,
    "axes.titlesize": 9.5, "xtick.color": INK, "ytick.color": INK, "legend.frameon": False,
    "axes.grid": True, "grid.color": GREY, "grid.alpha": 0.25, "axes.spines.top": False,
    "axes.spines.right": False, "figure.dpi": 72, "pdf.fonttype": 42,
}


def look(name):
    return LOOKS.get(name) or (OTHERS[sum(map(ord, name)) % len(OTHERS)], "o")


class Chart:
    """One figure of the page.

    series: for each line or row of bars its numbers and where they come from, so that the page can
    show them as a table and a test can compare the drawing with the CSV.
    """

    def __init__(self, key, title, caption, panels, height=3.0, width=None, share_y=True):
        self.key = key
        self.title = title
        self.caption = caption
        self.series = []
        with matplotlib.rc_context(STYLE):
            self.figure = Figure(figsize=(width or max(9.0, 3.5 * panels), height))
            self.axes = self.figure.subplots(1, panels, sharey=share_y, squeeze=False)[0]

    def remember(self, axes, identifier, label, x, y, source, low=None, high=None):
        self.series.append({"id": f"{self.key}-{identifier}", "label": label, "x": list(x),
                            "y": list(y), "low": low, "high": high, "source": source,
                            "panel": list(self.axes).index(axes), "axes": axes})

    def line(self, axes, identifier, name, label, x, y, source, low=None, high=None, names=None,
             **options):
        """source: what selects these rows of the CSV, {"file": ..., column: value}
        names: of the points in the table, where x is only their place"""
        color, marker = look(name)
        style = {"color": color, "marker": marker, "markersize": 4.5, "linewidth": 1.6, **options}
        axes.plot(x, y, label=label, gid=f"{self.key}-{identifier}", **style)
        if low is not None and any(a != b for a, b in zip(low, high)):
            axes.fill_between(x, low, high, color=color, alpha=0.2, linewidth=0)
        self.remember(axes, identifier, label, names or x, y, source, low, high)

    def bars(self, axes, identifier, name, label, positions, heights, width, source, names,
             low=None, high=None, beneath=None, color=None):
        """names: of the bars, for the table. beneath: the heights that these stand on"""
        errors = None
        if low is not None:
            errors = [[h - a for h, a in zip(heights, low)], [b - h for h, b in zip(heights, high)]]
        drawn = axes.bar(positions, heights, width, label=label, color=color or look(name)[0],
                         yerr=errors, bottom=beneath, error_kw={"ecolor": GREY, "elinewidth": 1})
        for index, bar in enumerate(drawn):
            bar.set_gid(f"{self.key}-{identifier}-{index}")
        self.remember(axes, identifier, label, names, heights, source, low, high)

    def finish(self, legend_columns=4):
        """One legend below all panels, without repetitions."""
        with matplotlib.rc_context(STYLE):
            handles = {}
            for axes in self.axes:
                for handle, label in zip(*axes.get_legend_handles_labels()):
                    handles.setdefault(label, handle)
            rows = -(-len(handles) // legend_columns)
            inches = self.figure.get_size_inches()[1]
            below = 0.2 * rows / inches if handles else 0.0
            self.figure.tight_layout(rect=(0, below + 0.01, 1, 1))
            if handles:
                self.figure.legend(handles.values(), handles.keys(), loc="lower center",
                                   ncol=min(legend_columns, len(handles)), fontsize=8.5)
        return self

    def scales(self):
        """For each panel how numbers become coordinates of the SVG: x = ax + bx * value."""
        self.figure.canvas.draw()
        _, height = self.figure.get_size_inches() * 72.0
        scales = []
        for axes in self.axes:
            if axes.get_yscale() != "linear" or axes.get_xscale() != "linear":
                scales.append(None)
                continue
            zero = axes.transData.transform((0.0, 0.0))
            one = axes.transData.transform((1.0, 1.0))
            scales.append({"x": [zero[0], one[0] - zero[0]],
                           "y": [height - zero[1], zero[1] - one[1]]})
        return scales

    def svg(self):
        """For use inside of a page with a strict policy: no style attributes, ids of its own."""
        with matplotlib.rc_context(STYLE):
            text = io.StringIO()
            self.figure.savefig(text, format="svg", transparent=True,
                                metadata={"Date": None, "Creator": None})
        return inline(text.getvalue(), self.key)


FONT = re.compile(r"^(?:(italic|normal) )?(?:(bold|\d+) )?([\d.]+px) (.*)$")


def attributes_of(style):
    """The presentation attributes that say what a style attribute says."""
    found = []
    for part in style.split(";"):
        name, _, value = part.strip().partition(": ")
        if name == "font":
            match = FONT.match(value)
            found.append(("font-size", match.group(3)))
            if match.group(2):
                found.append(("font-weight", match.group(2)))
        elif name:
            found.append((name, value))
    return " ".join(f'{name}="{value}"' for name, value in found)


def inline(svg, key):
    svg = svg[svg.index("<svg"):]
    svg = re.sub(r"<metadata>.*?</metadata>|<style.*?</style>", "", svg, flags=re.DOTALL)
    svg = re.sub(r'style="([^"]*)"', lambda m: attributes_of(m.group(1)), svg)
    svg = svg.replace(INK, "currentColor")
    # Lines and bars have names that begin with the key already; all other ids get it.
    svg = re.sub(rf'id="(?!{re.escape(key)}-)([^"]*)"', rf'id="{key}-\1"', svg)
    svg = re.sub(r'(href="#|url\(#)', rf"\g<1>{key}-", svg)
    svg = re.sub(r'<svg ([^>]*?)width="[\d.]+pt"', r"<svg \1", svg)
    svg = re.sub(r'<svg ([^>]*?)height="[\d.]+pt"', r"<svg \1", svg)
    return svg.strip()
