#!/usr/bin/env python3
"""Makes pairs of pictures, and measures them with published implementations of the metrics.

The reference implementation of FLIP and HDR-FLIP is the package `flip-evaluator`, those of SSIM and PSNR are scikit-image's. RMSE and
relative MSE are written out with NumPy. The test `cli/tests/suite/compare.rs` holds `framewright compare` against the figures.

    python3 -m venv /tmp/judges
    /tmp/judges/bin/pip install flip-evaluator==1.7 scikit-image==0.26.0 numpy==2.4.6 pillow==13.0.0 OpenEXR==3.5.3
    /tmp/judges/bin/python cli/tests/metrics/judge.py
"""

import json
from pathlib import Path

import flip_evaluator
import numpy as np
import OpenEXR
from PIL import Image
from skimage.metrics import peak_signal_noise_ratio, structural_similarity

HERE = Path(__file__).parent
# A rendered picture, with edges, textures and flat parts.
RENDERED = HERE / "../../../docs/pictures/deferred.png"


def decode(encoded):
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def encode(linear):
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)


def shifted(light):
    """Half a pixel to the right."""
    return (light + np.concatenate([light[:, :1], light[:, :-1]], axis=1)) / 2


def pairs():
    """Names of reference and picture, and both: bytes for PNGs, or half floats for OpenEXR files."""
    random = np.random.default_rng(18)
    rendered = np.asarray(Image.open(RENDERED).convert("RGB"))
    height, width = rendered.shape[:2]
    shown = rendered[height // 2 - 60 : height // 2 + 60, width // 2 - 80 : width // 2 + 80]
    light = decode(shown / 255.0)
    wrong = shown.copy()
    wrong[37, 101] = 255 - wrong[37, 101]
    noise = np.clip(shown.astype(int) + random.integers(-12, 13, shown.shape), 0, 255).astype(np.uint8)
    yield "shown", "one_pixel", shown, wrong
    yield "shown", "shifted", shown, np.round(encode(shifted(light)) * 255).astype(np.uint8)
    yield "shown", "gamma", shown, np.round((shown / 255.0) ** 1.1 * 255).astype(np.uint8)
    yield "shown", "noise", shown, noise
    yield "green", "blue", np.full((12, 16, 3), [0, 255, 0], np.uint8), np.full((12, 16, 3), [0, 0, 255], np.uint8)
    yield "low", "low_noise", shown[50:53, :40], noise[50:53, :40]
    # Light up to some 60 times as bright as white.
    bright = (light[:72, :96] * np.exp2(6 * np.linspace(0, 1, 96))[None, :, None]).astype(np.float16)
    grain = (bright.astype(np.float32) * random.uniform(0.8, 1.25, bright.shape)).astype(np.float16)
    yield "bright", "bright_noise", bright, grain
    yield "bright", "bright_shifted", bright, shifted(bright.astype(np.float32)).astype(np.float16)
    yield "bright", "bright_clipped", bright, np.minimum(bright, np.float16(1))


def written(name, pixels):
    """Writes a picture, and answers with its file's name."""
    if pixels.dtype == np.uint8:
        Image.fromarray(pixels).save(HERE / f"{name}.png", optimize=True)
        return f"{name}.png"
    channels = {channel: np.ascontiguousarray(pixels[:, :, at]) for at, channel in enumerate("RGB")}
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, channels).write(str(HERE / f"{name}.exr"))
    return f"{name}.exr"


def measured(reference, test):
    is_hdr = reference.dtype != np.uint8
    if is_hdr:
        linear = [picture.astype(np.float64) for picture in (reference, test)]
        seen = [encode(picture) for picture in linear]
        inputs = [picture.astype(np.float32) for picture in (reference, test)]
    else:
        seen = [picture / 255.0 for picture in (reference, test)]
        linear = [decode(picture) for picture in seen]
        inputs = [picture.astype(np.float32) for picture in seen]
    flip, mean, parameters = flip_evaluator.evaluate(
        *inputs, "HDR" if is_hdr else "LDR", inputsRGB=not is_hdr, applyMagma=False
    )
    flip = np.sort(np.asarray(flip, np.float64).ravel())
    difference = linear[1] - linear[0]
    figures = {
        "flip": {
            "mean": float(flip.mean()),
            "percentile_95": float(flip[-(-95 * flip.size // 100) - 1]),
            "worst": float(flip[-1]),
        },
        "rmse": float(np.sqrt((difference**2).mean())),
        "max_error": float(np.abs(difference).max()),
        "relative_mse": float((difference**2 / (linear[0] ** 2 + 0.01)).mean()),
    }
    if (difference != 0).any():
        peak = max(1.0, float(linear[0].max()))
        figures["psnr"] = float(peak_signal_noise_ratio(*linear, data_range=peak))
    assert abs(figures["flip"]["mean"] - mean) < 1e-5
    if is_hdr:
        names = {"first": "startExposure", "last": "stopExposure", "count": "numExposures"}
        figures["flip"]["exposures"] = {name: parameters[theirs] for name, theirs in names.items()}
    # The published implementation takes no picture that is smaller than the window.
    if min(reference.shape[:2]) >= 11:
        figures["ssim"] = float(
            structural_similarity(
                *seen, data_range=1, channel_axis=2, gaussian_weights=True, sigma=1.5, use_sample_covariance=False
            )
        )
    return figures


def main():
    figures = [
        {"reference": written(before, reference), "picture": written(after, picture), **measured(reference, picture)}
        for before, after, reference, picture in pairs()
    ]
    (HERE / "figures.json").write_text(json.dumps(figures, indent=2, allow_nan=False) + "\n")


if __name__ == "__main__":
    main()
