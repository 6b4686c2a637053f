"""The Python package hears all of a launched run, with the values of the run's files, also in asyncio; it says when a run fails.

    python_client.py DMISE
"""

import asyncio
import collections
import dataclasses
import os
import pathlib
import signal
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "build/python"))
import dmise  # noqa: E402
import numpy  # noqa: E402
import zmq  # noqa: E402
from dmise.convert import RECORDS  # noqa: E402
from dmise.frame_endpoint import FrameEndpoint  # noqa: E402
from dmise.protocol import modules  # noqa: E402

from harness import Run, check, first_frame, main, wait_until, write_scenario  # noqa: E402


def address_of(out):
    announced = out / "logs/master.address"
    return wait_until(lambda: announced.exists() and announced.read_text().strip(), "the time-master's address")


def every_field():
    messages = {name: d for module in modules for name, d in module.DESCRIPTOR.message_types_by_name.items()}
    for name, record in RECORDS.items():
        if name in messages:
            theirs = {field.name for field in messages[name].fields} - {"arrays"}
            missing = theirs - {field.name for field in dataclasses.fields(record)}
            check(not missing, f"{name} has the {len(theirs)} fields of its message {missing or ''}")


def same(ours, theirs):
    """Equal but for the last bits, which a number loses on its way through degrees."""
    return all(numpy.allclose(a, b, rtol=1e-12, atol=0) if isinstance(a, float | numpy.ndarray) else a == b
               for field in dataclasses.fields(ours)
               for a, b in [(getattr(ours, field.name), getattr(theirs, field.name))])


def hears_a_run(binary, directory):
    out = directory / "out"
    heard = collections.defaultdict(list)
    with Run(binary, "launch", write_scenario(directory, duration_s=300), "--out", out) as run:
        subscription = dmise.subscribe(address_of(out), "detection/", "frame/", "truth/", "env/", "state/")
        for record in subscription:
            heard[type(record).__name__].append(record)
        check(run.finish()[0] == 0, "the run is complete")
    check(not subscription.gaps and not subscription.refused, "nothing is lost or refused")
    check(heard["EnvironmentState"] and heard["SiteState"], "environment and sites are heard")
    left = dmise.open_run(out)
    check(left.status == "complete", "the run's directory says so")
    for name, keys, lines in (("Detection", ("sensor", "frame", "index"), left.detections),
                              ("Truth", ("sensor", "frame", "name"), left.truth)):
        of_file = {tuple(getattr(r, k) for k in keys): r for r in lines}
        check(heard[name] and all(same(r, of_file[tuple(getattr(r, k) for k in keys)]) for r in heard[name]),
              f"{len(heard[name])} of {len(of_file)} {name} records are those of the file")
    check(heard["FrameReport"], f"{len(heard['FrameReport'])} of {len(left.frames)} frames are heard")
    states = heard["ObjectStates"][-1]
    check(states.position_m.shape == (3, len(states.roster.objects)), f"states of {states.count} objects with roster")


async def count(address):
    return [d.id async for d in dmise.aio.subscribe(address, "detection/")]


def hears_in_asyncio(binary, directory):
    out = directory / "asyncio"
    with Run(binary, "launch", write_scenario(directory, duration_s=300), "--out", out) as run:
        ids = asyncio.run(count(address_of(out)))
        run.finish()
    check(ids and set(ids) <= {d.id for d in dmise.open_run(out).detections}, f"asyncio hears {len(ids)} detections")


def names_a_topic_that_nobody_publishes(binary, directory):
    out = directory / "misspelt"
    with Run(binary, "launch", write_scenario(directory, duration_s=300), "--out", out) as run:
        for wanted, meant in (("detektion/", "detection/"), ("frame/alhpa", "frame/alpha")):
            try:
                collections.deque(dmise.subscribe(address_of(out), "track/", wanted), maxlen=0)
                said = ""
            except ValueError as error:
                said = str(error)
            check(said == f"topic '{wanted}': nobody publishes it, did you mean '{meant}'?", f"subscribe: {said}")
        run.interrupt()
        run.finish()


def says_failure(binary, directory):
    out = directory / "failing"
    with Run(binary, "launch", write_scenario(directory), "--out", out) as run:
        subscription = dmise.subscribe(address_of(out), "frame/")
        first_frame(out)
        run.interrupt()
        try:
            collections.deque(subscription, maxlen=0)
            cause = None
        except dmise.RunFailed as error:
            cause = str(error)
        run.finish()
    check(cause, f"a run that is interrupted raises RunFailed: {cause}")


class Lossy(dmise.Subscription):
    """Loses every fifth message of alpha's frames on its way, and forty of beta's in a row: more than beta keeps."""

    def _accept(self, message):
        alpha, number = message.topic == "frame/alpha", message.sequence
        if number and (alpha and number % 5 == 0 and number < 90 or not alpha and 15 <= number < 55):
            return
        super()._accept(message)


def fetches_what_it_missed(binary, directory):
    out = directory / "restart"
    scenario = write_scenario(directory, duration_s=500, on_silent_node="restart", silent_after_s=1.0, network=", real_time: 60")
    scenario.write_text(scenario.read_text().replace("png: false", "png: false, fits: false"))  # pixels come from memory
    heard, served, reader, context = collections.defaultdict(list), {}, None, zmq.Context()

    def read():
        reader.ask()
        if (came := reader.take(None)) is not None:
            served[came[0].frame] = came[1]
        return reader.over

    with Run(binary, "launch", scenario, "--out", out) as run:
        subscription, killed = Lossy(address_of(out), ("frame/",)), False
        for report in subscription:
            heard[report.sensor].append(report.frame)
            if reader is None:
                alpha = next(publisher for publisher in subscription.run.publishers if publisher.name == "alpha")
                reader = FrameEndpoint(context, None, alpha, subscription.run.run_id, latest=False)
            read()
            if not killed and min(len(heard["alpha"]), len(heard["beta"])) > 5:
                killed = run.node("broker")
                os.kill(killed, signal.SIGKILL)
        wait_until(read, "the sensor's word that it makes no more frames")
        code, _ = run.finish()
        check(code == 0 and killed, f"the run goes on with another broker {run.stderr[-300:] if code else ''}")
    alpha, beta = heard["alpha"], heard["beta"]
    check(alpha == list(range(alpha[0], alpha[-1] + 1)) and len(alpha) > 80,
          f"frames {alpha[0]} to {alpha[-1]} come in order, over the death of the broker: lost ones are fetched")
    numbers = list(served)
    check(numbers == list(range(numbers[0], alpha[-1] + 1)) and len(numbers) > 80 and not reader.lost and
          all(content[:9] == b"SIMPLE  =" and len(content) % 2880 == 0 and len(content) > 2 * 512 * 384 for content in served.values()),
          f"{len(numbers)} frames that are not written come from the sensor's memory")
    context.destroy(0)
    missing = beta[-1] + 1 - beta[0] - len(beta)
    counted = sum(len(gap) for gap in subscription.gaps)
    check(beta == sorted(set(beta)) and {gap.topic for gap in subscription.gaps} == {"frame/beta"} and missing == counted > 20,
          f"what is no longer kept is counted: {missing} frames are missing, {counted} messages in gaps")


def test(binary, directory):
    every_field()
    hears_a_run(binary, directory)
    hears_in_asyncio(binary, directory)
    names_a_topic_that_nobody_publishes(binary, directory)
    says_failure(binary, directory)
    fetches_what_it_missed(binary, directory)


if __name__ == "__main__":
    main(test)
