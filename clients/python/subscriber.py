#!/usr/bin/env python3
"""Prints every detection of a launched run, with its UTC, and ends with the run.

    subscriber.py MASTER_ADDRESS        tcp://HOST:PORT, from OUT/logs/master.address

Exit code 0 when the run is over, 1 when it failed, nobody answers or something is missing.
"""
import pathlib
import sys

PACKAGES = pathlib.Path(__file__).resolve().parents[2] / "build" / "python"
sys.path.insert(0, str(PACKAGES))
try:
    import google.protobuf  # noqa: F401
    import numpy  # noqa: F401
    import zmq  # noqa: F401
except ImportError as missing:
    sys.exit(f"{missing.name}: not installed; this needs pyzmq, protobuf and numpy: "
             "apt install python3-zmq python3-protobuf python3-numpy")
try:
    import dmise
except ImportError as missing:
    sys.exit(f"{missing}: the package dmise is made by ./dmise build, into {PACKAGES}")


def main(address):
    with dmise.Subscription(address, ("detection/",)) as subscription:
        for d in subscription:
            when = d.time_utc.isoformat().replace("+00:00", "Z") if d.start_utc_of_run else f"{d.time_ns / 1e9} s"
            print(d.id, when, d.ra_rad, d.dec_rad, "rad", d.magnitude, d.band, flush=True)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: subscriber.py MASTER_ADDRESS")
    try:
        main(sys.argv[1])
    except dmise.RunFailed as failure:
        sys.exit(f"the run failed: {failure}")
    except (dmise.NoAnswer, ValueError) as error:
        sys.exit(str(error))
    except KeyboardInterrupt:
        sys.exit(130)
