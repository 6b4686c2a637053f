"""Frames of a launched run while it goes on, with astropy's world coordinates; and the shipped view in Rerun, read back by Rerun:
frames, detections and lines of sight.

    view.py DMISE
"""

import concurrent.futures
import os
import pathlib
import sys
import threading

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/system"), str(ROOT / "build/python")]
os.environ["PYTHONPATH"] = str(ROOT / "build/python")
from harness import Run, check, main, wait_until, write_scenario  # noqa: E402

try:
    import astropy.io.fits
    import numpy
    import rerun  # noqa: F401
    import rerun.dataframe
    import stonesoup  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dmise setup --tests)")
    sys.exit(77)
import dmise  # noqa: E402

FRAMES = 60  # frames of a sensor


def columns(path):
    """Rows of each component by entity: {("/alpha/frame", "Image:buffer"): 24, ..}."""
    recording = rerun.dataframe.load_recording(path)
    table = recording.view(index="utc", contents="/**").select().read_all()
    return {name: len(table) - table[name].null_count for name in table.column_names}


def are_frames(heard, out):
    numbers = [frame.report.frame for frame in heard]
    check(numbers == list(range(numbers[0], FRAMES + 1)), f"frames {numbers[0]} to {numbers[-1]} are heard")
    for frame in heard[:3]:
        counts = astropy.io.fits.getdata(out / f"alpha/frame-{frame.report.frame:06d}.fits")
        check(frame.image.shape == (384, 512) and (frame.image == counts).all(), "images are those of the files")
        at = frame.wcs.pixel_to_world_values(255.5, 191.5)
        boresight = numpy.degrees([frame.report.boresight_ra_rad, frame.report.boresight_dec_rad])
        check(numpy.allclose(at, boresight, atol=0.015), f"astropy's coordinates of the centre {at} are the boresight's")  # half a pixel


def last_frames(frames, out):
    """Numbers of the frames that come to a reader who is slow: five more are made before it asks again."""
    numbers = []
    for frame in frames:
        numbers.append(frame.report.frame)
        made = out / frame.report.sensor / f"frame-{min(FRAMES, numbers[-1] + 5):06d}.fits"
        wait_until(made.exists, f"{made.name} of {frame.report.sensor}")
    return numbers


def test(binary, directory):
    out, path, shown = directory / "out", directory / "run.mcap", directory / "shown.rrd"
    # Fifteen seconds, so that the run does not end before its readers have begun.
    scenario = write_scenario(directory, duration_s=5 * FRAMES, network=", real_time: 20")
    with Run(binary, "launch", scenario, "--out", out) as run:
        announced = out / "logs/master.address"
        address = wait_until(lambda: announced.exists() and announced.read_text().strip(), "the time-master's address")
        with concurrent.futures.ThreadPoolExecutor(2) as thread:
            recorded = thread.submit(dmise.record, address, path)
            last = thread.submit(lambda: last_frames(dmise.frames(address, "beta", mode="latest"), out))
            served = dmise.frames(address, "alpha")
            are_frames(list(served), out)
            check(not served.lost, "no frame is lost")
            check(run.finish()[0] == 0, f"the run is complete; {recorded.result()}")
            numbers = last.result()
            # A report may come later than its file: so by how many frames each is ahead is not asked.
            check(numbers[-1] == FRAMES and numbers == sorted(set(numbers)) and len(numbers) <= FRAMES / 2,
                  f"a slow reader gets the last frames of a sensor: {len(numbers)} of {FRAMES}, up to the last")
    are_frames(list(dmise.frames(address, "alpha", directory=out)), out)  # nobody answers any more
    check([frame.report.frame for frame in dmise.frames(None, mode="latest", directory=out)] == [FRAMES, FRAMES],
          "the last of each sensor, of the directory")
    left = dmise.open_run(out)
    table = left.detections.to_pandas()
    check(len(table) == len(left.detections) > 0 and list(table.id) == [d.id for d in left.detections],
          f"{len(table)} detections as a table of pandas")
    wanted = list(dmise.open_recording(path))
    frames = sum(isinstance(record, dmise.FrameReport) for record in wanted)
    seen = {(record.sensor, record.frame) for record in wanted if isinstance(record, dmise.Detection)}

    # A replay waits for the view, which is slow to begin: so all is shown.
    replay = dmise.Replay(path, speed=float("inf"), observers=2)  # frames and detections
    playing = threading.Thread(target=replay.run)
    playing.start()
    with Run(sys.executable, ROOT / "clients/python/examples/rerun_view.py", replay.address, "1", out, shown) as view:
        check(view.finish()[0] == 0, f"the view ends with the run {view.stderr[-500:]}")
    playing.join()
    found = columns(shown)
    images = sum(rows for name, rows in found.items() if name.endswith("frame:Image:buffer"))
    check(images == frames > 0, f"Rerun has {images} of {frames} frames")
    drawn = sum(rows for name, rows in found.items() if name.endswith("frame/detections:Points2D:positions"))
    check(drawn == len(seen) > 0, f"Rerun has detections of {drawn} of {len(seen)} frames that have some")
    check(any(name.startswith("/space/") and "Arrows3D" in name for name in found), "and their lines of sight")


if __name__ == "__main__":
    main(test)
