"""Figures 5 to 11, and what the paper does not show: later techniques, flicker, luminance."""

import paper
from chart import GREY, Chart
from plan import INDIRECT, LADDER, MOVEMENTS, SWEPT, UPSAMPLED

MEASURES = {"ssim": "SSIM", "flicker": "flicker, code values",
            "luminance_ratio": "luminance / ground truth"}
PANEL = "abcdefgh"
LATER_TITLES = {"best": "best", "fast_history": "fast history", "percentile": "percentile",
                "gradient": "gradient", UPSAMPLED: "best, drawn at 2/3 of the size",
                INDIRECT: "best, with indirect light"}


def title_of(preset):
    return paper.TITLES.get(preset) or LATER_TITLES.get(preset) or preset


def scene_title(scene):
    return paper.SCENE_TITLES.get(scene, scene)


def source_of(kind, scene, movement, preset, measure):
    return {"file": "quality.csv", "kind": kind, "scene": scene, "movement": movement,
            "preset": preset, "x": "value", "y": measure}


def curve(chart, axes, results, kind, scene, movement, preset, measure, **options):
    x, mean, low, high = results.curve(kind, scene, movement, preset, measure)
    if x:
        chart.line(axes, f"{movement}-{preset}", preset, title_of(preset), x, mean,
                   source_of(kind, scene, movement, preset, measure), low, high, **options)


def label_panels(chart, scene, movements, measure):
    for index, (axes, movement) in enumerate(zip(chart.axes, movements)):
        axes.set_title(f"({PANEL[index]}) {paper.MOVEMENT_TITLES[movement]}")
        axes.set_xlabel(paper.SWEPT_TITLES[scene])
        axes.tick_params(labelleft=True)
    chart.axes[0].set_ylabel(MEASURES[measure])


def paper_figure(results, figure):
    chart = Chart(f"figure-{figure.number}",
                  f"Figure {figure.number}: {title_of(figure.after)}, {scene_title(figure.scene)}",
                  f"SSIM with and without {title_of(figure.after)}, over "
                  f"{paper.SWEPT_TITLES[figure.scene]}: mean of the seeds, and their range as a "
                  "band. The paper's figure shows the same two lines.", len(figure.movements))
    for axes, movement in zip(chart.axes, figure.movements):
        curve(chart, axes, results, "sweep", figure.scene, movement, figure.before, "ssim",
              linestyle="--")
        curve(chart, axes, results, "sweep", figure.scene, movement, figure.after, "ssim")
    label_panels(chart, figure.scene, figure.movements, "ssim")
    return chart.finish()


def later_figure(results, scene, measure):
    movements = SWEPT[scene]
    chart = Chart(f"{measure.replace('_', '-')}-{scene.replace('_', '-')}",
                  f"{MEASURES[measure].split(',')[0].capitalize() if measure != 'ssim' else 'SSIM'}"
                  f" of all techniques, {scene_title(scene)}",
                  "The paper's steps (mean of the seeds), and techniques that it does not have "
                  "(one seed).", len(movements), height=3.9)
    for axes, movement in zip(chart.axes, movements):
        for preset in LADDER:
            curve(chart, axes, results, "sweep", scene, movement, preset, measure, linewidth=1.0,
                  linestyle="--")
        for preset in ("best", "fast_history", "percentile", "gradient"):
            curve(chart, axes, results, "later", scene, movement, preset, measure)
        curve(chart, axes, results, "upsampled", scene, movement, UPSAMPLED, measure)
        if measure == "luminance_ratio":
            axes.axhline(1.0, color=GREY, linewidth=0.8)
    label_panels(chart, scene, movements, measure)
    return chart.finish(legend_columns=5)


def scenes_figure(results, measure):
    """All scenes with every movement, a panel each."""
    presets = ("svgf", "rectification", "reinhard", "best")
    scenes = [scene for scene in paper.SCENE_TITLES
              if results.quality("scene", scene, "static", "svgf")]
    if not scenes:
        return None
    chart = Chart(f"scenes-{measure.replace('_', '-')}",
                  f"All scenes: {MEASURES[measure].split(',')[0]}",
                  "Each scene at one swept value, one seed.", len(MOVEMENTS), height=3.6, width=11.0)
    for axes, movement in zip(chart.axes, MOVEMENTS):
        for offset, preset in enumerate(presets):
            heights = [next(iter(results.curve("scene", scene, movement, preset, measure)[1]))
                       for scene in scenes]
            chart.line(axes, f"{movement}-{preset}", preset, title_of(preset),
                       [index + 0.14 * (offset - 1.5) for index in range(len(scenes))], heights,
                       source_of("scene", None, movement, preset, measure), names=scenes,
                       linestyle="", markersize=6)
        axes.set_xticks(range(len(scenes)), [scene_title(scene) for scene in scenes], rotation=40,
                        ha="right", fontsize=7.5)
        axes.set_title(f"({PANEL[list(MOVEMENTS).index(movement)]}) "
                       f"{paper.MOVEMENT_TITLES[movement]}")
        axes.tick_params(labelleft=True)
    chart.axes[0].set_ylabel(MEASURES[measure])
    return chart.finish()


def indirect_figure(results):
    """With global illumination as ground truth."""
    rows = (("reinhard", "reinhard"), (INDIRECT, INDIRECT))
    scenes = [scene for scene in paper.SCENE_TITLES
              if results.quality("indirect", scene, "moving_camera", INDIRECT)]
    if not scenes:
        return None
    chart = Chart("indirect", "Indirect diffuse light, which the paper leaves out",
                  "SSIM and luminance of a moving camera; ground truth is the path tracer with "
                  "global illumination.", 2, height=3.6, width=9.0, share_y=False)
    for axes, measure in zip(chart.axes, ("ssim", "luminance_ratio")):
        for offset, (preset, name) in enumerate(rows):
            heights = [next(iter(results.curve("indirect", scene, "moving_camera", preset,
                                               measure)[1])) for scene in scenes]
            chart.line(axes, f"{measure}-{preset}", name, title_of(preset),
                       [index + 0.14 * (offset - 0.5) for index in range(len(scenes))], heights,
                       source_of("indirect", None, "moving_camera", preset, measure),
                       names=scenes, linestyle="", markersize=6)
        axes.set_xticks(range(len(scenes)), [scene_title(scene) for scene in scenes], rotation=40,
                        ha="right", fontsize=7.5)
        axes.set_ylabel(MEASURES[measure])
        axes.set_title(f"({'ab'[measure != 'ssim']}) {MEASURES[measure]}")
    chart.axes[1].axhline(1.0, color=GREY, linewidth=0.8)
    return chart.finish()


def over_time_figure(results, scene):
    kinds = {"denoised": "denoised frames", "accumulated": "with accumulation of a static view"}
    if not results.over_time("denoised", scene, "svgf")[0]:
        return None
    chart = Chart(f"over-time-{scene.replace('_', '-')}",
                  f"Quality over time of a static camera, {scene_title(scene)}",
                  "SSIM of every frame from the first, which has no history.", 2)
    for index, (axes, kind) in enumerate(zip(chart.axes, kinds)):
        for preset in ("svgf", "rectification", "reinhard", "best"):
            x, y = results.over_time(kind, scene, preset)
            if x:
                chart.line(axes, f"{kind}-{preset}", preset, title_of(preset), x, y,
                           {"file": "over_time.csv", "unit": f"over_time_{kind}_{scene}",
                            "preset": preset, "x": "frame", "y": "ssim"}, markersize=0)
        axes.set_title(f"({PANEL[index]}) {kinds[kind]}")
        axes.set_xlabel("frame")
        axes.tick_params(labelleft=True)
    chart.axes[0].set_ylabel("SSIM")
    return chart.finish()


def figures(results):
    return [paper_figure(results, figure) for figure in paper.QUALITY]


def further_figures(results):
    found = [later_figure(results, scene, measure) for scene in SWEPT for measure in MEASURES]
    found += [scenes_figure(results, measure) for measure in MEASURES]
    found += [over_time_figure(results, scene) for scene in SWEPT]
    found.append(indirect_figure(results))
    return [chart for chart in found if chart is not None]
