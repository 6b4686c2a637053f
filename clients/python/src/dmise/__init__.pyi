from . import aio as aio, datasets as datasets, scenario as scenario
from .commands import check as check, score as score, survey as survey, tradeoff as tradeoff, visible as visible
from .dynamics import apparent_direction as apparent_direction, pole_of as pole_of
from .errors import EngineError as EngineError, InputError as InputError, NoAnswer as NoAnswer, Refused as Refused
from .errors import RunFailed as RunFailed, ScenarioError as ScenarioError
from .frame_images import Frame as Frame, Frames as Frames, frames as frames, read_frame as read_frame
from .injection import Injected as Injected, inject as inject
from .joint_period import PossiblePeriod as PossiblePeriod, possible_periods as possible_periods
from .message import Message as Message
from .node import Node as Node, Tick as Tick
from .orbit_fit import Orbit as Orbit, Triangulated as Triangulated, fit_orbit as fit_orbit, triangulate as triangulate
from .own_detector import Detector as Detector, Found as Found, SensorFrame as SensorFrame, detector as detector
from .own_node import Actor as Actor, World as World, actor as actor
from .own_sensor import Exposure as Exposure, Observer as Observer, Sighting as Sighting, Sightings as Sightings
from .own_sensor import sensor as sensor
from .own_socket import serve as serve
from .own_states import State as State
from .own_tracker import Point as Point, SearchedFrame as SearchedFrame, Sensor as Sensor, Tracker as Tracker
from .own_tracker import Tracks as Tracks, tracker as tracker
from .propagation import CatalogueStates as CatalogueStates, propagate as propagate
from .recorder import Recorded as Recorded, record as record
from .recording import Recording as Recording, open_recording as open_recording
from .records import ArrayLike as ArrayLike, Detection as Detection, FrameReport as FrameReport
from .records import LightCurve as LightCurve, LightPeriod as LightPeriod, Record as Record
from .records import Task as Task, Track as Track, Truth as Truth, Wcs as Wcs, WcsRefraction as WcsRefraction
from .replayer import Replay as Replay
from .runs import Run as Run, open_run as open_run
from .scenario_text import to_yaml as to_yaml
from .sight import LineOfSight as LineOfSight, line_of_sight as line_of_sight
from .simulation import SimulatedFrame as SimulatedFrame, Simulation as Simulation
from .solution import Solution as Solution, detect as detect, solve as solve
from .subscription import Gap as Gap, Subscription as Subscription, subscribe as subscribe
from .tables import Table as Table, to_pandas as to_pandas
from .world import EarthOrientation as EarthOrientation, EnvironmentState as EnvironmentState, ObjectInfo as ObjectInfo
from .world import ObjectRoster as ObjectRoster, ObjectStates as ObjectStates, SiteState as SiteState
from .world import SunTrackingPanel as SunTrackingPanel

__version__: str
