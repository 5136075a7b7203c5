"""The same as a PDF: findings, every figure and the sheets of images, with matplotlib."""

import math
import textwrap

import matplotlib
from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.figure import Figure

import paper
import sheets
from chart import STYLE

A4 = (11.7, 8.3)
WIDTHS = (62, 46, 40)


def text_page(title, lines, size=8.0):
    figure = Figure(figsize=A4)
    figure.text(0.05, 0.95, title, fontsize=14, va="top", weight="bold")
    figure.text(0.05, 0.89, "\n".join(lines), fontsize=size, va="top", family="monospace")
    return figure


def finding_lines(outcome):
    p = "" if math.isnan(outcome.p) else f"p {outcome.p:.4f}"
    columns = [textwrap.wrap(text, width) or [""] for text, width in zip(
        (outcome.statement, outcome.test, f"{outcome.change} {p}"), WIDTHS)]
    where = f"Fig. {outcome.figure}" if outcome.figure > 4 else "Tab. 1"
    lines = []
    for index in range(max(map(len, columns))):
        parts = [column[index] if index < len(column) else "" for column in columns]
        first = (where, outcome.verdict) if index == 0 else ("", "")
        lines.append(f"{first[0]:8}{first[1]:16}"
                     + "  ".join(f"{part:{width}}" for part, width in zip(parts, WIDTHS)))
    return lines


def finding_pages(outcomes, most=58):
    pages = [[]]
    for outcome in outcomes:
        lines = finding_lines(outcome)
        if len(pages[-1]) + len(lines) > most:
            pages.append([])
        pages[-1] += [*lines, ""]
    return [text_page("Findings of the paper", lines, 7.0) for lines in pages]


def rate_lines(results):
    lines = [f"{'':20}{'the paper':28}{'complete paper, here':28}best, here"]
    for scene, rates in paper.RATES.items():
        cells = [" / ".join(f"{value:.1f}" for value in rates)]
        for preset in ("reinhard", "best"):
            found = results.rates(scene, preset)
            cells.append("not measured" if found is None
                         else " / ".join(f"{value:.1f}" for value in found))
        lines.append(f"{paper.SCENE_TITLES[scene]:20}"
                     + "".join(f"{cell:28}" for cell in cells))
    return lines


def sheet_page(number, view, rows, gain, titles):
    figure = Figure(figsize=A4)
    shown = [row for row in rows if row in view.images]
    columns = min(4, len(shown))
    grid = figure.subplots(-(-len(shown) // columns), columns, squeeze=False)
    for axes in grid.flat:
        axes.axis("off")
    for axes, row in zip(grid.flat, shown):
        axes.imshow(sheets.cell(view, row, gain), interpolation="nearest")
        axes.set_title(titles[row], fontsize=9)
    figure.suptitle(f"Figure {number}: {paper.SCENE_TITLES[view.scene]}, "
                    f"{paper.MOVEMENT_TITLES[view.movement]}")
    figure.tight_layout()
    return figure


def write(page, titles):
    """@return the path of the PDF"""
    path = page.output / "paper.pdf"
    results = page.results
    first = [f"Rendered by Heliograph on {results.device()}, size {page.size.name}.",
             f"{len(results.units)} runs, {results.seconds() / 60.0:.0f} minutes.", "",
             "Frames per second, max / avg / min:", "", *rate_lines(results)]
    eighteen, nineteen = sheets.sheet_views(page.views)
    with matplotlib.rc_context(STYLE), PdfPages(path, metadata={"CreationDate": None}) as file:
        file.savefig(text_page("Hybrid-Rendering Techniques in GPU, measured again", first))
        for figure in finding_pages(page.outcomes):
            file.savefig(figure)
        for chart in page.all_charts():
            chart.figure.suptitle(chart.title, fontsize=10, y=1.05)
            file.savefig(chart.figure, bbox_inches="tight")
        for number, views in ((18, eighteen), (19, nineteen)):
            rows, gain = sheets.SHEETS[number]
            for view in views:
                file.savefig(sheet_page(number, view, rows, gain, titles))
    return path
