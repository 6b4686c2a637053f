"""Programs of other people read what `dmise dataset` writes: pycocotools the labels, tarfile and webdataset the archives; scipy
judges what was drawn; astropy reads the planes of the same scenario without noise, which judge the masks.

    read_dataset.py DMISE
"""

import hashlib
import io
import json
import math
import pathlib
import subprocess
import sys
import tarfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/system"), str(ROOT / "build/python")]
from harness import check, main  # noqa: E402

try:
    import numpy as np
    import pycocotools.coco
    import pycocotools.mask
    import scipy.stats
    import webdataset
    from astropy.io import fits
except ImportError as missing:
    print(f"skipped: {missing} (./dmise setup --tests)")
    sys.exit(77)

CAMERA = ("{{optics: {{columns: 160, rows: 120, pixel_pitch_m: 9e-6, focal_length_m: 0.2, aperture_m: 0.1, psf_fwhm_px: {fwhm}}},"
          " detector: {{read_noise_e: {noise}, full_well_e: 60000, gain_e_per_dn: 1, bias_dn: {bias}}},"
          " band: {{name: V, centre_m: 0.55e-6, width_m: 0.128e-6}}}}")
SCENARIO = """simulation: {{start: {start}, duration_s: 10, tick_s: 10, seed: 1}}
objects:
  - {{catalogue: demo, only: [GOES 13, GOES 14, GOES 15], radius_m: {radius}}}
stars: {{catalogue: kstars}}
detection: off
accuracy: off
sensors:
  - name: eye
    site: {{latitude_deg: {latitude}, longitude_deg: -100, height_m: 300}}
    camera: """ + CAMERA + """
    pointing: {{target: {target}, offset_deg: [{x}, {y}], roll_deg: {roll}, tracking: sidereal}}
    exposure_s: {exposure}
    cadence_s: 10
output: {output}
"""
DRAWN = dict(start="{uniform: [2018-01-21T03:00:00Z, 2018-01-21T09:00:00Z]}", radius="{log_uniform: [1, 8]}",
             latitude="{uniform: [25, 40]}", fwhm="{normal: {mean: 2.2, sigma: 0.4, min: 1.5}}", noise="{uniform: [3, 12]}",
             bias="{integers: [100, 109]}", target="{one_of: [GOES 13, GOES 14, GOES 15]}", x="{uniform: [-0.1, 0.1]}",
             y="{uniform: [-0.1, 0.1]}", roll="{uniform: [-180, 180]}", exposure="{log_uniform: [1, 8]}", output="{fits: on}")
KEYS = dict(start="simulation.start", radius="objects[0].radius_m", latitude="sensors[0].site.latitude_deg",
            fwhm="sensors[0].camera.optics.psf_fwhm_px", noise="sensors[0].camera.detector.read_noise_e",
            bias="sensors[0].camera.detector.bias_dn", target="sensors[0].pointing.target",
            x="sensors[0].pointing.offset_deg[0]", y="sensors[0].pointing.offset_deg[1]",
            roll="sensors[0].pointing.roll_deg", exposure="sensors[0].exposure_s")
SEEDS = 400


def run(*arguments):
    return subprocess.run([str(a) for a in arguments], check=True, capture_output=True, text=True)


def contents(out):
    """Members of each key by ending, from all archives."""
    frames = {}
    for path in sorted(out.glob("dataset-*.tar")):
        with tarfile.open(path) as archive:
            for member in archive:
                key, ending = member.name.split(".", 1)
                frames.setdefault(key, {})[ending] = archive.extractfile(member).read()
    return frames


def archives_are_as_the_manifest_says(out, frames):
    manifest = json.loads((out / "dataset.json").read_text())
    for entry in [*manifest["shards"], manifest["coco"]]:
        content = (out / entry["name"]).read_bytes()
        check(len(content) == entry["bytes"] and hashlib.sha256(content).hexdigest() == entry["sha256"],
              f"{entry['name']} has the size and the SHA-256 of the manifest")
    check(len(frames) == SEEDS == sum(shard["frames"] for shard in manifest["shards"]), "a frame for each seed")
    for members in list(frames.values())[::40]:
        image = np.load(io.BytesIO(members["image.npy"]))
        with fits.open(io.BytesIO(members["fits"])) as hdus:
            check((hdus[0].data == image).all() and image.shape == (120, 160), "image.npy has the counts of the FITS file")
    pattern = f"{out}/dataset-{{000000..{len(manifest['shards']) - 1:06d}}}.tar"
    read = list(webdataset.WebDataset(pattern, shardshuffle=False).decode())
    check([sample["__key__"] for sample in read] == list(frames), "webdataset has all samples in order")
    check(all(sample["labels.json"]["key"] == sample["__key__"] and sample["mask.npy"].shape == (120, 160)
              for sample in read), "and decodes them")


def draws_follow_their_distributions(labels):
    drawn = {name: [label["drawn"][path] for label in labels] for name, path in KEYS.items()}
    start = np.datetime64("2018-01-21T03:00:00")
    drawn["start"] = [(np.datetime64(text[:-1]) - start) / np.timedelta64(1, "us") for text in drawn["start"]]
    uniform = scipy.stats.uniform
    for name, law in dict(start=uniform(0, 6 * 3600e6), radius=scipy.stats.loguniform(1, 8), latitude=uniform(25, 15),
                          fwhm=scipy.stats.truncnorm((1.5 - 2.2) / 0.4, math.inf, 2.2, 0.4), noise=uniform(3, 9),
                          x=uniform(-0.1, 0.2), y=uniform(-0.1, 0.2), roll=uniform(-180, 360),
                          exposure=scipy.stats.loguniform(1, 8)).items():
        p = scipy.stats.kstest(drawn[name], law.cdf).pvalue
        check(p > 0.01, f"{name} follows its distribution: p = {p:.3f} of Kolmogorov and Smirnov")
    for name in ("bias", "target"):
        counts = np.unique(drawn[name], return_counts=True)[1]
        check(len(counts) == dict(bias=10, target=3)[name] and scipy.stats.chisquare(counts).pvalue > 0.01,
              f"{name} is equally likely: p = {scipy.stats.chisquare(counts).pvalue:.3f} of chi-square")
    independent = scipy.stats.spearmanr(drawn["x"], drawn["y"]).pvalue
    check(independent > 0.01, f"offsets along the two axes are independent: p = {independent:.3f}")


def labels_agree_with_pycocotools(out, frames, labels):
    coco = pycocotools.coco.COCO(str(out / "coco.json"))
    check(len(coco.imgs) == SEEDS and len(coco.anns) == sum(len(label["objects"]) for label in labels),
          f"pycocotools reads {len(coco.imgs)} images and {len(coco.anns)} annotations")
    wrong = 0
    for annotation in coco.anns.values():
        mask = coco.annToMask(annotation)
        rows, columns = np.nonzero(mask)
        box = [columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1]
        wrong += box != annotation["bbox"] or mask.sum() != annotation["area"]
        plane = np.load(io.BytesIO(frames[coco.imgs[annotation["image_id"]]["key"]]["mask.npy"]))
        alone = len(coco.getAnnIds(annotation["image_id"])) == 1
        wrong += alone and ((plane == annotation["label"]) != mask).any()
    check(not wrong, "every mask has its box and its area, and is in the plane of numbers")
    return coco


def masks_hold_the_light(binary, directory, coco, labels):
    """The scenario of a seed again, with the object alone: its plane of sources is its light."""
    worst_share, worst_iou, tried = 1.0, 1.0, 0
    for label in labels[:24]:
        values = {name: label["drawn"][path] for name, path in KEYS.items()}
        text = SCENARIO.format(**values, output="{planes: [sources], fits: off, png: off, truth: off}")
        text = text.replace("only: [GOES 13, GOES 14, GOES 15]", f"only: [{values['target']}]")
        path = directory / "alone.yaml"
        path.write_text(text.replace("stars: {catalogue: kstars}\n", "effects: {sky: off}\n"))
        run(binary, "run", path, "--seed", label["seed"], "--out", directory / "alone", "--force")
        light = fits.getdata(directory / "alone/eye/frame-000001-sources.fits").astype(float)
        found = next(o for o in label["objects"] if o["name"] == values["target"])
        mask = pycocotools.mask.decode(found["segmentation"]).astype(bool)
        brightest = np.sort(light.ravel())[::-1]
        least = brightest[np.searchsorted(np.cumsum(brightest), 0.99 * light.sum())]
        reference = light >= least
        worst_share = min(worst_share, light[mask].sum() / light.sum())
        worst_iou = min(worst_iou, (mask & reference).sum() / (mask | reference).sum())
        tried += 1
    check(worst_share >= 0.99 - 1e-6, f"masks hold at least {worst_share:.5f} of their object's light in {tried} frames")
    check(worst_iou >= 0.95, f"and are what holds 99 % of it in the plane without noise: IoU at least {worst_iou:.4f}")


def the_client_reads_it(out, frames):
    try:
        import dmise.datasets
    except ImportError as missing:
        print(f"not tested: {missing}")
        return
    samples = dmise.datasets.open_dataset(out)
    samples.verify()
    check([sample.key for sample in samples] == list(frames), "the client has all samples in order")
    for sample in (samples[k] for k in range(0, SEEDS, 20)):
        for ours, found in zip(sample.masks(), sample.objects):
            check((ours == pycocotools.mask.decode(found["segmentation"]).astype(bool)).all(),
                  f"{sample.key}: the mask is pycocotools'")
    image, mask = dmise.datasets.FrameDataset(out)[-1]
    check(image.shape == (1, 120, 160) and image.dtype == "float32" and mask.dtype == "int64", "arrays for PyTorch")
    check(dmise.datasets.FrameDataset(out, transform=lambda sample: sample.key)[0] == next(iter(frames)), "transformed")
    try:
        samples[SEEDS]
        check(False, "past the end")
    except IndexError:
        pass


def test(binary, directory):
    scenario = directory / "drawn.yaml"
    scenario.write_text(SCENARIO.format(**DRAWN))
    out = directory / "set"
    run(binary, "dataset", scenario, "--seeds", f"1..{SEEDS}", "--per-shard", 150, "--out", out)
    frames = contents(out)
    labels = [json.loads(members["labels.json"]) for members in frames.values()]
    archives_are_as_the_manifest_says(out, frames)
    draws_follow_their_distributions(labels)
    coco = labels_agree_with_pycocotools(out, frames, labels)
    masks_hold_the_light(binary, directory, coco, labels)
    the_client_reads_it(out, frames)


main(test)
