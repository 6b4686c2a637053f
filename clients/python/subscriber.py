#!/usr/bin/env python3
"""Prints every detection of a launched run, with its UTC, and ends with the run.

    subscriber.py MASTER_ADDRESS        tcp://HOST:PORT, from OUT/logs/master.address

Exit code 0 when the run is over, 1 when it failed, nobody answers or something is missing.
"""
import datetime
import pathlib
import sys
import time

MODULES = pathlib.Path(__file__).resolve().parents[2] / "build" / "python"
sys.path.insert(0, str(MODULES))
try:
    import google.protobuf  # noqa: F401
    import zmq
except ImportError as missing:
    sys.exit(f"{missing.name}: not installed; this needs pyzmq and protobuf: apt install python3-zmq python3-protobuf")
try:
    from dmise.v1 import detection_pb2, node_pb2, time_pb2
except ImportError as missing:
    sys.exit(f"{missing}: the messages are made by ./dmise build, into {MODULES}")

ANSWER_WITHIN_S = 3.0
LAST_WORDS_S = 1.0  # detections may arrive a little later than the news of the end


def main(address):
    context = zmq.Context()
    context.setsockopt(zmq.LINGER, 0)
    master = context.socket(zmq.DEALER)
    master.connect(address)
    run = ask(master, address)
    while not run.observe_endpoint and run.phase not in (time_pb2.PHASE_ENDED, time_pb2.PHASE_FAILED):
        time.sleep(0.1)  # the broker is still starting
        run = ask(master, address)
    start = datetime.datetime.fromisoformat(run.start_utc.replace("Z", "+00:00")) if run.start_utc else None
    clock, data = context.socket(zmq.SUB), context.socket(zmq.SUB)
    clock.connect(run.tick_endpoint)
    clock.subscribe("")
    if run.observe_endpoint:
        data.connect(run.observe_endpoint)
    data.subscribe("detection/")
    over = None  # when the news of the end came
    asked = time.monotonic()
    while over is None or data.poll(int(1000 * LAST_WORDS_S)):
        for socket in zmq.select([data, clock], [], [], 0.2)[0]:
            if socket is data:
                show(data.recv_multipart(), start)
            else:
                grant = time_pb2.Grant.FromString(clock.recv())
                if grant.phase in (time_pb2.PHASE_ENDED, time_pb2.PHASE_FAILED):
                    over = grant.phase
        if over is None and time.monotonic() - asked > 1.0:
            run = ask(master, address)
            asked = time.monotonic()
            if run.phase in (time_pb2.PHASE_ENDED, time_pb2.PHASE_FAILED):
                over = run.phase
    if over == time_pb2.PHASE_FAILED:
        sys.exit(f"the run failed{': ' + run.cause if run.cause else ''}")


def ask(master, address):
    """What the time-master says of the run."""
    master.send(node_pb2.NodeMessage(hello={}).SerializeToString())
    if not master.poll(int(1000 * ANSWER_WITHIN_S)):
        sys.exit(f"{address}: no time-master answers within {ANSWER_WITHIN_S:g} s")
    return time_pb2.MasterMessage.FromString(master.recv()).endpoints


def show(message, start):
    for d in detection_pb2.DetectionSet.FromString(message[2]).detections:
        # UTC, unless a leap second falls within the run: time_ns goes at the rate of TAI.
        when = start + datetime.timedelta(microseconds=d.time_ns // 1000) if start else None
        print(d.id, when.isoformat().replace("+00:00", "Z") if when else f"{d.time_ns / 1e9} s",
              d.ra_rad, d.dec_rad, "rad", d.magnitude, d.band, flush=True)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: subscriber.py MASTER_ADDRESS")
    try:
        main(sys.argv[1])
    except zmq.ZMQError as error:
        sys.exit(f"{sys.argv[1]}: {error}; an address is tcp://HOST:PORT")
    except KeyboardInterrupt:
        sys.exit(130)
