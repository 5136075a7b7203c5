"""Figures 12 to 17, tables 1 and 2, the four blur iterations, stages, quality over time per frame."""

import statistics

import paper
from chart import Chart, look
from plan import LADDER, SWEPT
from quality_charts import PANEL, scene_title, title_of
from stages import STAGES, stage_of

CHANNELS = {"cubes_distance": ("reflection rays", "reflection accumulation", "reflection blur"),
            "breakfast_room": ("shadow rays", "shadow accumulation", "shadow blur")}


def by_stage(passes):
    """{stage: milliseconds}"""
    times = dict.fromkeys((stage for stage, _ in STAGES), 0.0)
    for name, ms in passes.items():
        times[stage_of(name)] += ms
    return times


def stage_curve(results, scene, preset, stages):
    """Swept values, and the milliseconds of these stages together."""
    times = {value: by_stage(passes) for value, passes in results.pass_times(scene, preset).items()}
    return list(times), [sum(of_value[stage] for stage in stages) for of_value in times.values()]


def pass_source(scene, preset, stages):
    return {"file": "passes.csv", "kind": "times", "scene": scene, "preset": preset,
            "stages": list(stages), "x": "value", "y": "ms"}


def paper_figure(results, figure):
    channel = CHANNELS[figure.scene]
    light = "Indirect specular" if figure.scene == "cubes_distance" else "Shadows"
    chart = Chart(f"figure-{figure.number}",
                  f"Figure {figure.number}: {light}, time of {title_of(figure.after)}, "
                  f"{scene_title(figure.scene)}",
                  "(a) The channel's main passes, dashed without the technique. (b) The whole "
                  "channel with each technique so far.", 2, share_y=False)
    for name, stage in zip(("svgf", "rectification", "separable"), channel):
        for preset, style in ((figure.before, "--"), (figure.after, "-")):
            x, y = stage_curve(results, figure.scene, preset, [stage])
            if x:
                chart.line(chart.axes[0], f"passes-{preset}-{stage.replace(' ', '-')}", name,
                           stage if style == "-" else f"{stage}, {title_of(preset)}", x, y,
                           pass_source(figure.scene, preset, [stage]), linestyle=style)
    for preset in LADDER[:LADDER.index(figure.after) + 1]:
        x, y = stage_curve(results, figure.scene, preset, channel)
        if x:
            chart.line(chart.axes[1], f"technique-{preset}", preset, f"channel: {title_of(preset)}",
                       x, y, pass_source(figure.scene, preset, channel))
    titles = ("main passes", "techniques")
    for index, axes in enumerate(chart.axes):
        axes.set_title(f"({PANEL[index]}) {titles[index]}")
        axes.set_xlabel(paper.SWEPT_TITLES[figure.scene])
        axes.set_ylim(bottom=0.0)
    chart.axes[0].set_ylabel("milliseconds")
    return chart.finish(legend_columns=3)


def nearest(table, value):
    return table[min(table, key=lambda known: abs(known - value))] if table else {}


def blur_iterations(results):
    """Section 4.2: the paper's four numbers and ours."""
    table = results.pass_times("cubes_distance", "svgf")
    passes = nearest(table, paper.BLUR_ROUGHNESS)
    ours = [passes.get(f"specular.atrous.{level}") for level in range(4)]
    chart = Chart("blur-iterations", "Section 4.2: the four blur iterations of SVGF, Cubes "
                  f"Distance, roughness {paper.BLUR_ROUGHNESS:g}",
                  "Each iteration as a share of the mean of its four; milliseconds stand on the "
                  "bars. The paper's are of its GPU and its frame size.", 1, width=6.5)
    axes = chart.axes[0]
    places = range(4)
    names = [f"iteration {level + 1}" for level in places]
    rows = [("paper", "paper", "the paper", list(paper.BLUR_MS), None)]
    if all(ours):
        value = min(table, key=lambda known: abs(known - paper.BLUR_ROUGHNESS))
        rows.append(("ours", "best", "this machine", ours, {
            "file": "passes.csv", "kind": "times", "scene": "cubes_distance", "preset": "svgf",
            "value": value, "passes": [f"specular.atrous.{level}" for level in places],
            "y": "ms"}))
    for offset, (identifier, name, label, times, source) in enumerate(rows):
        mean = statistics.fmean(times)
        shares = [ms / mean for ms in times]
        chart.bars(axes, identifier, name, label, [p + 0.4 * (offset - 0.5) for p in places],
                   shares, 0.4, source, names)
        for place, share, ms in zip(places, shares, times):
            axes.text(place + 0.4 * (offset - 0.5), share + 0.01, f"{ms:.2f}", ha="center",
                      va="bottom", fontsize=7.5)
    axes.set_xticks(places, names)
    axes.set_ylabel("of the mean")
    return chart.finish()


def rates_figure(results):
    """Tables 1 and 2 as a plot."""
    chart = Chart("tables-1-2", "Tables 1 and 2: frames per second of the animated scenes",
                  "Means; lines span the slowest and the fastest frame. The paper's are of its "
                  "GPU and frame size.", 1, height=3.6, width=9.0)
    axes = chart.axes[0]
    scenes = list(paper.RATES)
    rows = [("paper", "paper", paper.RATES)]
    for preset, label in (("reinhard", "complete paper, this machine"), ("best", "best, this machine")):
        rates = {scene: results.rates(scene, preset) for scene in scenes}
        rows.append((preset, label, {scene: rate for scene, rate in rates.items() if rate}))
    for offset, (name, label, rates) in enumerate(rows):
        shown = [scene for scene in scenes if scene in rates]
        source = None if name == "paper" else {"file": "timings.csv", "kind": "rates",
                                               "preset": name, "x": "scene", "y": "avg_fps"}
        if shown:
            chart.bars(axes, name, name, label,
                       [scenes.index(scene) + 0.27 * (offset - 1) for scene in shown],
                       [rates[scene][1] for scene in shown], 0.27, source, shown,
                       [rates[scene][2] for scene in shown], [rates[scene][0] for scene in shown])
    axes.set_xticks(range(len(scenes)), [scene_title(scene) for scene in scenes], rotation=25,
                    ha="right")
    axes.set_ylabel("frames per second")
    return chart.finish()


def stages_figure(results, preset):
    """Time per stage on this machine."""
    scenes = [scene for scene in paper.RATES if results.mean_passes(scene, preset)]
    if not scenes:
        return None
    chart = Chart(f"stages-{preset}", f"Time per stage on this machine, {title_of(preset)}",
                  "Means of both animated movements.", 1, height=4.2, width=9.0)
    axes = chart.axes[0]
    times = {scene: by_stage(results.mean_passes(scene, preset)) for scene in scenes}
    beneath = [0.0] * len(scenes)
    for index, (stage, _) in enumerate(STAGES):
        heights = [times[scene][stage] for scene in scenes]
        if not any(heights):
            continue
        chart.bars(axes, stage.replace(" ", "-"), f"{index}", stage, range(len(scenes)), heights,
                   0.7, {"file": "passes.csv", "kind": "rates", "preset": preset,
                         "stages": [stage], "x": "scene", "y": "ms"}, scenes, beneath=beneath,
                   color=STAGE_COLORS[index])
        beneath = [a + b for a, b in zip(beneath, heights)]
    axes.set_xticks(range(len(scenes)), [scene_title(scene) for scene in scenes], rotation=25,
                    ha="right")
    axes.set_ylabel("milliseconds")
    return chart.finish(legend_columns=5)


STAGE_COLORS = ("#7d7d7d", "#3d8bdb", "#5f9ea0", "#2f9e5b", "#a58a2e", "#e0513f", "#cf8000",
                "#c95fa6", "#b04a4a", "#8d74d6", "#d97b5a")


def front(points):
    """Which of (milliseconds, similarity) no other beats in both."""
    return [point for point in points
            if not any(other[0] <= point[0] and other[1] >= point[1] and other != point
                       for other in points)]


def pareto_figure(results):
    """Quality over milliseconds: the mean of all swept values of a static view."""
    chart = Chart("pareto", "Quality over time of a frame: the front of presets",
                  "Static view, mean of all swept values. The line joins presets that no other "
                  "beats in both.", 2, share_y=False)
    for index, (axes, scene) in enumerate(zip(chart.axes, SWEPT)):
        points = {}
        for preset in LADDER + ("best",):
            kind = "later" if preset == "best" else "sweep"
            quality = results.curve(kind, scene, "static", preset)[1]
            passes = results.pass_times(scene, preset).values()
            if quality and passes:
                points[preset] = (statistics.fmean(sum(each.values()) for each in passes),
                                  statistics.fmean(quality))
        for preset, (ms, ssim) in points.items():
            chart.line(axes, f"{scene.replace('_', '-')}-{preset}", preset, title_of(preset), [ms],
                       [ssim], None, linestyle="", markersize=8)
        best = sorted(front(list(points.values())))
        axes.plot(*zip(*best), color=look("paper")[0], linewidth=1.0, zorder=0)
        axes.set_title(f"({PANEL[index]}) {scene_title(scene)}")
        axes.set_xlabel("milliseconds per frame")
        axes.set_ylabel("SSIM")
    return chart.finish(legend_columns=3)


def figures(results):
    return [paper_figure(results, figure) for figure in paper.TIMES]


def further_figures(results):
    found = [pareto_figure(results), stages_figure(results, "reinhard"),
             stages_figure(results, "best")]
    return [chart for chart in found if chart is not None]
