"""Least SSIM of a ball of the scene `material_balls` beside the path traced truth, by its row.

Of the balls of a row, the worst counts. WHOLE is for the chart of `material_chart.py` with its
defaults: what is aimed at. SMALL is for that with --small: what --print-bars printed on a processor,
which is what was measured, less MARGIN for noise and other devices: by so much the worst ball of a
row differed between two processors at 32 samples. A row that is missing here counts as missed.
"""

import math

MARGIN = 0.06

WHOLE = {
    "dielectric_roughness": 0.9,
    "metal_roughness": 0.9,
    "ior": 0.9,
    "specular": 0.9,
    "specular_color": 0.9,
    "clearcoat": 0.9,
    "clearcoat_roughness": 0.9,
    "sheen": 0.9,
    "sheen_roughness": 0.9,
    "iridescence": 0.9,
    "iridescence_thickness": 0.9,
    "anisotropy": 0.9,
    "anisotropy_rotation": 0.9,
    "emission": 0.9,
    "transmission": 0.7,
    "transmission_roughness": 0.7,
    "volume_roughness": 0.7,
    "volume_attenuation": 0.7,
    "volume_ior": 0.7,
    "dispersion": 0.7,
    "diffuse_transmission": 0.7,
    "diffuse_transmission_color": 0.7,
    "alpha_blend": 0.7,
    "alpha_mask": 0.7,
}

SMALL = {
    "dielectric_roughness": 0.9,
    "metal_roughness": 0.85,
    "ior": 0.9,
    "specular": 0.92,
    "specular_color": 0.91,
    "clearcoat": 0.88,
    "clearcoat_roughness": 0.88,
    "sheen": 0.88,
    "sheen_roughness": 0.84,
    "iridescence": 0.89,
    "iridescence_thickness": 0.86,
    "anisotropy": 0.84,
    "anisotropy_rotation": 0.82,
    "emission": 0.92,
    "transmission": 0.82,
    "transmission_roughness": 0.59,
    "volume_roughness": 0.56,
    "volume_attenuation": 0.65,
    "volume_ior": 0.64,
    "dispersion": 0.6,
    "diffuse_transmission": 0.87,
    "diffuse_transmission_color": 0.83,
    "alpha_blend": 0.85,
    "alpha_mask": 0.88,
}


def bar_of(measured):
    """Of the least SSIM of a row: two decimals, not above what was measured less the margin."""
    return math.floor((measured - MARGIN) * 100.0 + 1e-9) / 100.0
