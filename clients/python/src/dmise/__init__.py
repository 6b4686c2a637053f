"""Takes part in runs of DMISE, and reads what they leave.

    for detection in dmise.subscribe("tcp://127.0.0.1:7660", "detection/"):
        print(detection.id, detection.time_utc, detection.ra_rad, detection.dec_rad)

`subscribe` observes a run, `aio.subscribe` does so in asyncio, `Node` takes part in its clock, `actor` and `serve` move objects
in it, `detector` finds sources in its frames, `tracker` makes the tracks, `open_run` reads the directory of a run that is over,
`datasets` labelled frames for training; `record` writes all that is on the wire into a file, `open_recording` reads it and
`Replay` plays it to observers.
Units are in the names of fields; directions are ICRS, positions GCRS.
"""

try:
    import google.protobuf  # noqa: F401
    import numpy  # noqa: F401
    import zmq  # noqa: F401
except ImportError as missing:
    import sys
    raise ImportError(f"{missing.name}: not installed for {sys.executable}; dmise needs pyzmq, protobuf and numpy: "
                      "apt install python3-zmq python3-protobuf python3-numpy, or pip install pyzmq protobuf numpy",
                      name=missing.name) from None

from . import aio, datasets
from .dynamics import apparent_direction, pole_of, propagate
from .errors import NoAnswer, Refused, RunFailed
from .frame_images import Frame, Frames, frames, read_frame
from .message import Message
from .node import Node, Tick
from .own_detector import Detector, Found, SensorFrame, detector
from .own_node import Actor, World, actor, serve
from .own_states import State
from .own_tracker import Point, SearchedFrame, Sensor, Tracker, Tracks, tracker
from .orbit_fit import Orbit, Triangulated, fit_orbit, triangulate
from .recorder import Recorded, record
from .recording import Recording, open_recording
from .records import ArrayLike, Detection, FrameReport, Record, Task, Track, Truth, Wcs, WcsRefraction
from .replayer import Replay
from .runs import Run, open_run
from .sight import LineOfSight, line_of_sight
from .subscription import Gap, Subscription, subscribe
from .tables import to_pandas
from .world import (EarthOrientation, EnvironmentState, ObjectInfo, ObjectRoster, ObjectStates, SiteState,
                    SunTrackingPanel)

__all__ = ["Actor", "ArrayLike", "Detection", "Detector", "EarthOrientation", "EnvironmentState", "Found", "Frame",
           "FrameReport", "Frames", "Gap", "LineOfSight", "Message", "NoAnswer", "Node", "ObjectInfo", "ObjectRoster",
           "ObjectStates", "Orbit", "Point", "Record", "Recorded", "Recording", "Refused", "Replay", "Run", "RunFailed",
           "SearchedFrame", "Sensor", "SensorFrame", "SiteState", "State", "Subscription", "SunTrackingPanel", "Task", "Tick",
           "Track", "Tracker", "Tracks", "Triangulated", "Truth", "Wcs", "WcsRefraction", "World", "actor", "aio",
           "apparent_direction", "datasets", "detector", "fit_orbit", "frames", "line_of_sight", "open_recording", "open_run",
           "pole_of", "propagate", "read_frame", "record", "serve", "subscribe", "to_pandas", "tracker", "triangulate"]
__version__ = "1.0.0"
