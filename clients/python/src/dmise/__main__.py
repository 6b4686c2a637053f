"""python -m dmise record | replay: recordings of runs (docs/clients.md, Record and replay)."""
from __future__ import annotations

import argparse
import logging
import pathlib
import signal
import sys

from .errors import NoAnswer
from .recorder import Recorder
from .replayer import MAX_SPEED, Replay


def _speed(text: str) -> float:
    try:
        speed = MAX_SPEED if text == "max" else float(text)
    except ValueError:
        speed = 0.0
    if not speed > 0.0:
        raise argparse.ArgumentTypeError(f"must be > 0 or max, got {text}")
    return speed


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m dmise", description="records runs of DMISE and replays them")
    commands = parser.add_subparsers(dest="command", required=True, metavar="record | replay")
    recording = commands.add_parser("record", help="write everything that is on the wire of a run into an MCAP file")
    recording.add_argument("address", help="tcp://HOST:PORT of the time-master, from the run's logs/master.address")
    recording.add_argument("file", type=pathlib.Path, help="the recording, FILE.part until the run is over")
    recording.add_argument("--topics", default="", help="detection/,frame/alpha: these alone; default: all but truth")
    recording.add_argument("--truth", action="store_true", help="truth as well")
    recording.add_argument("--keys", help="directory of dmise keygen")
    recording.add_argument("--name", default="operator", help="the own key in it (%(default)s)")
    recording.add_argument("--force", action="store_true", help="replace the file if there is one")
    playing = commands.add_parser("replay", help="be the time-master of a recorded run for those who observe it")
    playing.add_argument("file", type=pathlib.Path)
    playing.add_argument("--speed", type=_speed, default=1.0, metavar="X|max",
                         help="seconds of the simulation per second (1), or as fast as observers read")
    playing.add_argument("--listen", default="tcp://127.0.0.1:0", metavar="tcp://HOST:PORT",
                         help="address of the time-master (%(default)s: any port)")
    playing.add_argument("--observers", type=int, default=1, metavar="N",
                         help="begin when so many have subscribed (%(default)s; 0: at once)")
    return parser


def _stop_signals() -> list[int]:
    """Without a hang-up that is ignored (nohup)."""
    return [number for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
            if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN]


def _record(options: argparse.Namespace) -> int:
    if options.file.exists() and not options.force:
        raise ValueError(f"{options.file}: exists; --force replaces it")
    topics = [topic for topic in options.topics.split(",") if topic]
    recorder = Recorder(options.address, options.file, *topics, truth=options.truth, keys=options.keys, name=options.name)
    for number in _stop_signals():
        signal.signal(number, lambda *_: recorder.close())
    print(recorder.record(), file=sys.stderr)
    return 1 if recorder.gaps else 0


def _replay(options: argparse.Namespace) -> int:
    replay = Replay(options.file, options.speed, options.listen, options.observers)
    for number in _stop_signals():
        signal.signal(number, lambda *_: replay.close())
    print(replay.address, flush=True)
    replay.run()
    print(f"{options.file}: {replay.messages} messages replayed", file=sys.stderr)
    return 0


def main() -> int:
    options = _parser().parse_args()
    logging.basicConfig(format="%(message)s", level=logging.WARNING)
    try:
        return _record(options) if options.command == "record" else _replay(options)
    except (NoAnswer, ValueError, ImportError) as error:
        print(error, file=sys.stderr)
    except OSError as error:
        print(f"{error.filename or options.file}: {error.strerror or error}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
