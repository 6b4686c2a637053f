"""Takes part in runs of DMISE, and reads what they leave.

    for detection in dmise.subscribe("tcp://127.0.0.1:7660", "detection/"):
        print(detection.id, detection.time_utc, detection.ra_rad, detection.dec_rad)

`subscribe` observes a run, `aio.subscribe` does so in asyncio, `Node` takes part in its clock, `open_run` reads the
directory of a run that is over. Units are in the names of fields; directions are ICRS, positions GCRS.
"""

try:
    import google.protobuf  # noqa: F401
    import numpy  # noqa: F401
    import zmq  # noqa: F401
except ImportError as missing:
    raise ImportError(f"{missing.name}: not installed; dmise needs pyzmq, protobuf and numpy: "
                      "apt install python3-zmq python3-protobuf python3-numpy, or pip install pyzmq protobuf numpy",
                      name=missing.name) from None

from . import aio
from .errors import NoAnswer, Refused, RunFailed
from .message import Message
from .node import Node, Tick
from .records import ArrayLike, Detection, FrameReport, Record, Truth, Wcs, WcsRefraction
from .runs import Run, open_run
from .sight import LineOfSight, line_of_sight
from .subscription import Gap, Subscription, subscribe
from .tables import to_pandas
from .world import (EarthOrientation, EnvironmentState, ObjectInfo, ObjectRoster, ObjectStates, SiteState,
                    SunTrackingPanel)

__all__ = ["ArrayLike", "Detection", "EarthOrientation", "EnvironmentState", "FrameReport", "Gap", "LineOfSight",
           "Message", "NoAnswer", "Node", "ObjectInfo", "ObjectRoster", "ObjectStates", "Record", "Refused", "Run",
           "RunFailed", "SiteState", "Subscription", "SunTrackingPanel", "Tick", "Truth", "Wcs", "WcsRefraction",
           "aio", "line_of_sight", "open_run", "subscribe", "to_pandas"]
__version__ = "0.1.0"
