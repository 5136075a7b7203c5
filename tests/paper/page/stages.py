"""The stages of a frame, of which each has several passes."""

# Passes by the beginnings of their names, in the order of a frame; the first that fits counts.
STAGES = (
    ("G-buffer", ("gbuffer.", "reproject")),
    ("shadow rays", ("shadows.",)),
    ("ambient rays", ("ambient.",)),
    ("shadow accumulation", ("visibility.temporal", "visibility.rectify", "visibility.variance",
                             "visibility.combine")),
    ("shadow blur", ("visibility.",)),
    ("reflection rays", ("specular.rays", "specular.begin", "specular.trace", "specular.resolve",
                         "specular.shade", "specular.shadows.")),
    ("reflection accumulation", ("specular.temporal", "specular.rectify",
                                 "specular.variance")),
    ("reflection blur", ("specular.",)),
    ("shadow and reflection blur", ("visibility_specular.",)),  # one pass for both, on GPUs
    ("indirect light", ("indirect.", "cache.", "radiance_cache.", "guide.", "path_guide.")),
    ("composition and display", ("",)),
)


def stage_of(name):
    return next(stage for stage, starts in STAGES if name.startswith(starts))
