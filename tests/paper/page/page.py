"""Writes the page: everything measured, drawn and tested, in one file with its data beside it."""

import json
import math
import pathlib
from html import escape

import findings
import markup
import paper
import quality_charts
import records
import sheets
import time_charts
import time_findings
from markup import section, table

HERE = pathlib.Path(__file__).parent
TITLES = {**paper.TITLES, "best": "best", sheets.TRUTH: "ground truth"}
SENTENCES = {findings.REPRODUCED: "yes", findings.NOT_REPRODUCED: "no", findings.OPEN: "soft"}


class Page:
    def __init__(self, results, size, output):
        self.results = results
        self.size = size
        self.output = pathlib.Path(output)
        self.images = self.output / "images"
        self.images.mkdir(parents=True, exist_ok=True)
        self.views = sheets.all_views(results)
        self.charts = {"quality": quality_charts.figures(results),
                       "times": time_charts.figures(results),
                       "tables": [time_charts.rates_figure(results),
                                  time_charts.blur_iterations(results)],
                       "further": quality_charts.further_figures(results)
                       + time_charts.further_figures(results)}
        self.outcomes = findings.evaluate(results) + time_findings.evaluate(results)

    def all_charts(self):
        return [chart for charts in self.charts.values() for chart in charts]

    def save(self, image, name):
        image.save(self.images / name, optimize=True)
        return f"images/{name}"

    # Sections, in the order of the page.

    def findings_table(self):
        rows = []
        for outcome in self.outcomes:
            p = "–" if math.isnan(outcome.p) else ("< .0001" if outcome.p < 1e-4
                                                  else f"{outcome.p:.4f}")
            figure = f"Figure {outcome.figure}" if outcome.figure > 4 else "Tables 1, 2"
            rows.append((f'<a href="#{"figure-" + str(outcome.figure)}">{figure}</a>'
                         if outcome.figure > 4 else '<a href="#tables-1-2">Tables 1, 2</a>',
                         escape(outcome.statement), escape(outcome.test), escape(outcome.change),
                         p, f'<span class="verdict {SENTENCES[outcome.verdict]}">'
                         f"{outcome.verdict}</span>", escape(outcome.why)))
        return table(("figure", "the paper says", "tested on our data", "change", "p", "verdict",
                      "why"), rows, "Findings of the paper, each with its test", kind="findings")

    def findings_section(self):
        counts = {verdict: sum(outcome.verdict == verdict for outcome in self.outcomes)
                  for verdict in SENTENCES}
        words = ", ".join(f"{count} {verdict}" for verdict, count in counts.items())
        return section("findings", "Findings of the paper",
                       f"<p>Of {len(self.outcomes)} statements: {words}. Quality is tested in "
                       "pairs of renderings with the same seed, with Student's t; “similar” by two "
                       "one-sided tests. A statement is reproduced if p &lt; .05. Changes are "
                       "those of the technique against the step before it, with their 95 % "
                       f"confidence interval.</p>{self.findings_table()}")

    def charts_section(self, identifier, title, charts, before=""):
        return section(identifier, title,
                       before + "".join(markup.figure(chart) for chart in charts))

    def rates_table(self):
        rows = []
        for scene, (most, mean, least) in paper.RATES.items():
            cells = [f"{most:g} / {mean:g} / {least:g}"]
            for preset in ("reinhard", "best"):
                rate = self.results.rates(scene, preset)
                cells.append("not measured" if rate is None else
                             " / ".join(f"{value:.1f}" for value in rate))
            rows.append((paper.SCENE_TITLES[scene], *cells))
        return table(("scene", "the paper", "complete paper, here", "best, here"), rows,
                     "Frames per second: max / avg / min")

    def sheet(self, number_of_sheet, views):
        rows, gain = sheets.SHEETS[number_of_sheet]
        lines = []
        for view in views:
            cells = []
            for row in rows:
                if row not in view.images:
                    continue
                name = f"sheet-{number_of_sheet}-{view.name}-{row}.png"
                path = self.save(sheets.cell(view, row, gain), name)
                what = f"{TITLES[row]}, {paper.SCENE_TITLES[view.scene]}, " \
                       f"{paper.MOVEMENT_TITLES[view.movement]}, with two close-ups"
                cells.append(f'<img src="{path}" loading="lazy" alt="{escape(what)}">')
            lines.append((f"{paper.SCENE_TITLES[view.scene]}, "
                          f"{paper.MOVEMENT_TITLES[view.movement]}", *cells))
        contrast = " Contrast is doubled." if gain != 1.0 else ""
        title = f"Figure {number_of_sheet}: images with close-ups"
        note = ("<p class=\"soft\">Green: where history rectification changes most. Red: where the "
                f"wider and separable blurs do.{contrast}</p>")
        return section(f"figure-{number_of_sheet}", title, note + table(
            ("", *(TITLES[row] for row in rows)), lines, title, kind="sheet"), 3)

    def comparison(self, view):
        """A strip of crops, and a slider between two images."""
        crops, options = [], {}
        for row in sheets.ROWS:
            if row not in view.images:
                continue
            image = view.images[row]
            whole = self.save(image, f"{view.name}-{row}.png")
            crop = self.save(sheets.enlarged(view.green.crop(image), 320),
                             f"{view.name}-{row}-crop.png")
            options[whole] = TITLES[row]
            text = f'<img src="{crop}" loading="lazy" alt="{escape(TITLES[row])}, close-up">'
            if row == sheets.TRUTH:
                crops.append(f"<li>{text}{TITLES[row]}</li>")
                continue
            false_color = sheets.difference(image, view.images[sheets.TRUTH])
            shown = self.save(false_color, f"{view.name}-{row}-difference.png")
            close = self.save(sheets.enlarged(view.green.crop(false_color), 320),
                              f"{view.name}-{row}-difference-crop.png")
            options[shown] = f"{TITLES[row]}: difference"
            ssim, flip = sheets.scores(view, row)
            crops.append(f'<li>{text}<img src="{close}" loading="lazy" alt="Difference of '
                         f'{escape(TITLES[row])} from ground truth">{escape(TITLES[row])}<br>'
                         f"SSIM {ssim:.3f}<br>FLIP {flip:.3f}</li>")
        return f'<ul class="strip" tabindex="0">{"".join(crops)}</ul>' + self.slider(view, options)

    def slider(self, view, options):
        names = list(options)
        title = f"{paper.SCENE_TITLES[view.scene]}, {paper.MOVEMENT_TITLES[view.movement]}"

        def choice(label, chosen):
            entries = "".join(f'<option value="{path}"{" selected" if path == chosen else ""}>'
                              f"{escape(text)}</option>" for path, text in options.items())
            return f"<label>{label} <select>{entries}</select></label>"

        return (f'<div class="compare" data-view="{escape(title)}"><div class="stack">'
                f'<img class="under" src="{names[0]}" loading="lazy" '
                f'alt="{escape(options[names[0]])}, {escape(title)}"><div class="over">'
                f'<img src="{names[-1]}" loading="lazy" alt="{escape(options[names[-1]])}, '
                f'{escape(title)}"></div></div><div class="controls">'
                f'{choice("Left", names[0])}<label>Slider <input type="range" min="0" max="100" '
                f'value="50"></label>{choice("Right", names[-1])}</div></div>')

    def comparisons_section(self):
        bar = self.save(sheets.scale_bar(), "difference-scale.png")
        text = (f'<p>The last frame of each view. Differences are those of luma: <img src="{bar}" '
                f'alt="black to yellow"> 0 to {sheets.RANGE:g} code values and more. SSIM and FLIP '
                "(67 pixels per degree) are of the whole image.</p>")
        for view in self.views:
            title = f"{paper.SCENE_TITLES[view.scene]}, {paper.MOVEMENT_TITLES[view.movement]}"
            text += section(f"view-{view.name}", title, self.comparison(view), 3)
        return section("comparison", "Visual comparison", text)

    def settings_section(self, files):
        runs = self.results.runs
        folder = self.output / "settings"
        folder.mkdir(exist_ok=True)
        names = {}
        for run in runs.values():
            for preset, settings in run["settings"].items():
                names.setdefault(preset, settings)
        for preset, settings in names.items():
            (folder / f"{preset}.json").write_text(json.dumps(settings, indent=1) + "\n")
        kinds = {}
        for unit, run in runs.items():
            kinds.setdefault(unit.split("_", 1)[0], run)
        rows = [(kind, run["size"], run["frames"], f'{run["frame_rate"]:g}', run["samples"],
                 run["texture_size"], run["truth"], ", ".join(map(str, run["seeds"])))
                for kind, run in kinds.items()]
        text = table(("runs", "size", "frames", "per second", "samples of ground truth",
                      "texels", "ground truth", "seeds"), rows, "What was rendered")
        data = ", ".join(f'<a href="data/{name}">{name}</a>' for name in files)
        presets = ", ".join(f'<a href="settings/{name}.json">{name}</a>' for name in names)
        text += (f"<p>Data: {data}. All settings of every row: {presets}; those of each run are in "
                 "runs.json. The seeds of a row differ in <code>sampling.seed</code>.</p>")
        return section("settings", "Settings and data", text)

    def body(self, files):
        results = self.results
        eighteen, nineteen = sheets.sheet_views(self.views)
        minutes = results.seconds() / 60.0
        sections = (
            ("findings", "Findings", self.findings_section()),
            ("quality", "Quality", self.charts_section(
                "quality", "Quality: figures 5 to 11", self.charts["quality"])),
            ("times", "Times", self.charts_section(
                "times", "Times: figures 12 to 17", self.charts["times"])),
            ("tables", "Tables 1 and 2", self.charts_section(
                "tables", "Frame rates: tables 1 and 2", self.charts["tables"],
                self.rates_table())),
            ("images", "Images", section("images", "Images: figures 18 and 19",
                                         self.sheet(18, eighteen) + self.sheet(19, nineteen))),
            ("comparison", "Visual comparison", self.comparisons_section()),
            ("further", "Beyond the paper", self.charts_section(
                "further", "Beyond the paper", self.charts["further"])),
            ("machines", "Machines", section("machines", "Recorded machines", records.as_table())),
            ("settings", "Settings and data", self.settings_section(files)),
        )
        links = "".join(f'<li><a href="#{name}">{title}</a></li>' for name, title, _ in sections)
        return (f'<a class="skip" href="#findings">To the findings</a><header>'
                f"<h1>Hybrid-Rendering Techniques in GPU, measured again</h1>"
                f"<p>Every figure and table of Granja and Pereira (2021), rendered by Heliograph "
                f"on {escape(results.device())}: {len(results.units)} runs, "
                f"{minutes:.0f} minutes, size “{escape(self.size.name)}”. Also as "
                f'<a href="paper.pdf">PDF</a>.</p></header>'
                f'<nav aria-label="Contents"><ul>{links}</ul></nav><main>'
                + "".join(text for _, _, text in sections) + "</main>")

    def write(self):
        files = self.results.write(self.output / "data")
        drawn = {chart.key: {"title": chart.title, "scales": chart.scales(),
                             "series": [{key: series[key] for key in series if key != "axes"}
                                        for series in chart.series]}
                 for chart in self.all_charts()}
        (self.output / "data" / "figures.json").write_text(json.dumps(drawn, indent=1) + "\n")
        text = markup.document("Hybrid-Rendering Techniques in GPU, measured again",
                               (HERE / "page.css").read_text(), (HERE / "page.js").read_text(),
                               self.body([*files, "figures.json"]))
        (self.output / "index.html").write_text(text)
        return self.output / "index.html"
