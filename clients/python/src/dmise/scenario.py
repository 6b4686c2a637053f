"""Scenarios as typed mappings: keys, ranges and units as in docs/reference/scenario.md.

    night: Scenario = {"simulation": {"start": "2018-01-21T03:00:00Z", "duration_s": 60, "tick_s": 5}, "sensors": [west]}
    dmise.Simulation(night)

Written by clients/python/scenario_types.py from `dmise schema scenario`.
"""
from __future__ import annotations

import datetime
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypedDict

if TYPE_CHECKING:
    from typing import Required

Text = str | os.PathLike[str]
Utc = str | datetime.datetime
Switch = bool | Literal["on", "off", "yes", "no"]


class Scenario(TypedDict, total=False):
    """A scenario: when, what is in space, who watches it, and what is written."""

    simulation: Required[Simulation]
    """The run."""
    objects: Sequence[Catalogue | Constellation | Fragments | Debris | Object]
    """Catalogues of objects, and objects of one's own."""
    nodes: Sequence[Node]
    """Programs of one's own that take part in the run: they move objects, detect in the frames of sensors, are sensors, or
    make the tracks."""
    stars: Stars
    """The stars; without it there are none."""
    sensors: Required[Sequence[Sensor | OwnSensor]]
    """The sensors, at least one: cameras, and sensors of one's own."""
    accuracy: Literal["draft", "standard", "reference", "off"] | Accuracy
    """How accurate frames must be, for all sensors. Default: standard."""
    effects: Effects
    """Effects switched for all sensors."""
    detection: Switch
    """Whether moving objects are detected in the frames. Default: on."""
    fusion: Switch | Fusion
    """Tracks of what all sensors detect. Default: off."""
    environment: Environment
    """How often the environment is published."""
    network: Network
    """How processes work together."""
    output: Output
    """Files of every frame."""


class Simulation(TypedDict, total=False):
    """When the run begins, how long it lasts and in which steps."""

    start: Required[Utc]
    """UTC at which the run begins, not before 1972."""
    duration_s: Required[float]
    """Length of the run [s], a whole number of ticks."""
    tick_s: Required[float]
    """Time between ticks [s], at which the state of the world is published."""
    seed: int
    """Seed of all random numbers. Default: 1."""
    interpolation: Literal["3", 3, "5", 5, "7", 7]
    """Order of the polynomials that join objects between ticks. By default the lowest that the sensors' accuracy allows."""
    earth_orientation: Text
    """An IERS finals2000A file of UT1 - UTC and polar motion. Without it they are 0."""
    ellipsoid: Literal["WGS84", "WGS72", "GRS80"] | Ellipsoid
    """The figure of the Earth: of sites, heights, shadow and limb. Default: WGS84."""
    origin: Origin
    """The place of east, north and up, for motions, cameras and positions."""
    earth_albedo: float
    """Share of the light that the Earth returns, as a diffuse ellipsoid: of its disc and of earthshine. Default: 0.3."""


class Ellipsoid(TypedDict, total=False):
    """An ellipsoid of revolution about the Earth's axis."""

    a_m: Required[float]
    """Equatorial radius [m]."""
    f: Required[float]
    """Flattening."""


class Origin(TypedDict, total=False):
    """The place of the scenario's east, north and up."""

    latitude_deg: Required[float]
    """Geodetic latitude [deg]."""
    longitude_deg: Required[float]
    """Longitude, east [deg]."""
    height_m: float
    """Height above the ellipsoid [m]. Default: 0."""


class Catalogue(TypedDict, total=False):
    """Objects of a catalogue."""

    catalogue: Required[Text]
    """`demo` (979 objects of January 2018), or a file of TLE, 3LE, OMM or gpredict element sets beside the scenario."""
    facts: Text
    """A CSV file of sizes and albedos of known objects."""
    only: Sequence[Text]
    """Numbers or names of the objects to take; without it all are taken."""
    models: Text | Models
    """Models of families of objects: `shipped`, by the names that each model has, or patterns of names and numbers with their
    models. They are of the objects of all catalogues; the others are diffuse spheres."""
    radius_m: float
    """Radius of the diffuse sphere that is seen without a shape [m]. Default: 1."""
    albedo: float
    """Its albedo. Default: 0.2."""


# Models of objects of catalogues, the first that fits.
Models = Mapping[str, "Text"]


class Constellation(TypedDict, total=False):
    """Satellites of a constellation, or of one launch. `walker` or `train`."""

    walker: Walker
    """Its planes and satellites."""
    train: Train
    """Satellites behind each other."""
    name: Text
    """Unique, of 1 to 48 characters; its satellites are NAME-PLANE-PLACE, of a train NAME-PLACE. Default: `walker` or
    `train`."""
    models: Text | Models
    """Models of families of objects, as of a catalogue."""
    radius_m: float
    """Radius of the diffuse sphere that is seen without a shape [m]. Default: 1."""
    albedo: float
    """Its albedo. Default: 0.2."""


class Walker(TypedDict, total=False):
    """A constellation of circular orbits T/P/F (Walker 1984): mean elements for SGP4, without drag."""

    total: int
    """Satellites T; a multiple of the planes."""
    per_plane: int
    """Satellites in each plane, in place of the total."""
    planes: Required[int]
    """Planes P."""
    phasing: int
    """F, below P: a satellite is F * 360 deg / T ahead of the one in the plane to the west. Default: 0."""
    raan_spread_deg: float
    """Range over which the nodes are spread [deg]: 360 is a Walker delta, 180 a star. Default: 360."""
    height_m: float
    """Semi-major axis less 6378137 m [m]."""
    semi_major_axis_m: float
    """Semi-major axis [m], in place of the height."""
    inclination_deg: Required[float]
    """Inclination [deg]."""
    raan_deg: float
    """Right ascension of the first node [deg], in TEME of the epoch. Default: 0."""
    argument_of_latitude_deg: float
    """The first satellite's angle from its node [deg]. Default: 0."""
    epoch: Utc
    """UTC of the elements. Default: start of the run."""


class Train(TypedDict, total=False):
    """Satellites behind each other in one plane, as after a launch."""

    count: Required[int]
    """Satellites."""
    spacing_s: Required[float]
    """Time after which the next one passes the same latitude [s]."""
    height_m: float
    """Semi-major axis less 6378137 m [m]."""
    semi_major_axis_m: float
    """Semi-major axis [m], in place of the height."""
    inclination_deg: Required[float]
    """Inclination [deg]."""
    raan_deg: float
    """Right ascension of the first node [deg], in TEME of the epoch. Default: 0."""
    argument_of_latitude_deg: float
    """The first satellite's angle from its node [deg]. Default: 0."""
    epoch: Utc
    """UTC of the elements. Default: start of the run."""


class Fragments(TypedDict, total=False):
    """Pieces of an object that has broken up."""

    breakup: Required[Breakup]
    """What broke, when and how."""
    name: Text
    """Unique, of 1 to 48 characters; the fragments are NAME-NUMBER, the longest first. Default: breakup."""
    albedo: float
    """Albedo of the spheres that they are. Default: 0.175."""


class Breakup(TypedDict, total=False):
    """Pieces of an object that has exploded or collided, by NASA's standard breakup model (Johnson et al. 2001)."""

    parent: Required[Text | Motion]
    """The name or number of an object of the scenario, which stays in the scene, or a motion as of an object of one's own."""
    at: Utc
    """UTC of the breakup, at or before the start of the run. Default: start of the run."""
    kind: Required[Literal["explosion", "collision"]]
    """What broke it."""
    structure: Literal["upper_stage", "spacecraft"]
    """Which area-to-mass ratios pieces over 8 cm have. Default: `upper_stage` of an explosion, `spacecraft` of a
    collision."""
    mass_kg: Required[float]
    """Mass of the parent [kg]."""
    scale: float
    """S of an explosion: 1 is an upper stage of 600 to 1000 kg. Default: 1."""
    projectile_mass_kg: float
    """Mass of what hit it [kg]; needed of a collision."""
    relative_speed_m_per_s: float
    """Speed at which that hit it [m/s]; needed of a collision."""
    least_length_m: float
    """Characteristic length of the smallest pieces [m]. Default: 0.1."""
    seed: int
    """Seed of the pieces. Default: that of the scenario."""


class Motion(TypedDict, total=False):
    """How an object moves; one of these."""

    two_body: TwoBody
    """A conic about the Earth's centre."""
    oem: Text
    """A CCSDS OEM beside the scenario."""
    sp3: Text
    """An SP3-c or SP3-d beside the scenario."""
    satellite: Text
    """The satellite of the SP3, such as L71; needed if it has several."""
    numerical: Numerical
    """A state from which it flies by numerical integration."""
    forces: Forces
    """What acts on it; with `numerical` or `manoeuvres`."""
    manoeuvres: Sequence[Manoeuvre]
    """Changes of its velocity, in order; with numerical, two_body, sgp4, oem or sp3. From the first on the object flies by
    numerical integration."""
    fixed: Fixed
    """A constant place."""
    track: Text
    """A CSV file of time_s, latitude_deg, longitude_deg, height_m."""
    enu: EnuMotion
    """In east, north and up of the scenario's origin."""
    sgp4: Sgp4
    """One element set."""
    proximity: Proximity
    """Near another object."""
    node: Text
    """A node of `nodes` says where it is at every tick."""


class TwoBody(TypedDict, total=False):
    """A conic about the Earth's centre, in GCRS axes: by elements, or by position and velocity."""

    gm_m3_per_s2: float
    """Gravity of the centre [m^3/s^2]. Default: 3.986004415e14."""
    epoch: Utc
    """UTC of the elements. Default: start of the run."""
    position_m: Sequence[float]
    """Position at the epoch [m]."""
    velocity_m_per_s: Sequence[float]
    """Velocity at the epoch [m/s]."""
    semi_major_axis_m: float
    """Semi-major axis [m]; of a closed orbit."""
    periapsis_m: float
    """Least distance from the Earth's centre [m], in place of the axis."""
    eccentricity: float
    """Eccentricity; needed with elements."""
    inclination_deg: float
    """Inclination [deg]; needed with elements."""
    raan_deg: float
    """Right ascension of the ascending node [deg]. Default: 0."""
    argument_of_perigee_deg: float
    """Argument of perigee [deg]. Default: 0."""
    true_anomaly_deg: float
    """True anomaly [deg]. Default: 0."""
    mean_anomaly_deg: float
    """Mean anomaly [deg], in place of the true one."""


class Numerical(TypedDict, total=False):
    """A state in GCRS axes, by osculating elements or by position and velocity, from which the object flies by numerical
    integration."""

    epoch: Utc
    """UTC of the elements. Default: start of the run."""
    position_m: Sequence[float]
    """Position at the epoch [m]."""
    velocity_m_per_s: Sequence[float]
    """Velocity at the epoch [m/s]."""
    semi_major_axis_m: float
    """Semi-major axis [m]; of a closed orbit."""
    periapsis_m: float
    """Least distance from the Earth's centre [m], in place of the axis."""
    eccentricity: float
    """Eccentricity; needed with elements."""
    inclination_deg: float
    """Inclination [deg]; needed with elements."""
    raan_deg: float
    """Right ascension of the ascending node [deg]. Default: 0."""
    argument_of_perigee_deg: float
    """Argument of perigee [deg]. Default: 0."""
    true_anomaly_deg: float
    """True anomaly [deg]. Default: 0."""
    mean_anomaly_deg: float
    """Mean anomaly [deg], in place of the true one."""


class Forces(TypedDict, total=False):
    """What acts on an object that flies by numerical integration."""

    gravity_degree: int
    """Degree and order of the Earth's gravity, EGM2008; 0: a point mass. Default: 20."""
    sun_moon: Switch
    """Attraction of Sun and Moon, and of the tides that they raise in the solid Earth. Default: on."""
    area_to_mass_m2_per_kg: float
    """Cross-section over mass [m^2/kg]. Without it neither air nor sunlight acts."""
    drag: Switch
    """Drag of the air. Default: on."""
    drag_coefficient: float
    """Drag coefficient. Default: 2.2."""
    radiation: Switch
    """Pressure of sunlight outside the Earth's shadow. Default: on."""
    radiation_coefficient: float
    """Radiation pressure coefficient: 1 absorbs all light, 2 throws it straight back. Default: 1.3."""


class Manoeuvre(TypedDict, total=False):
    """A change of velocity at once, or a burn of constant thrust. Axes are radial (away from the Earth's centre), transverse
    (in the plane of the orbit, forwards) and normal."""

    at: Utc
    """UTC of the change, or of the start of the burn."""
    at_s: float
    """The same from the start of the run [s], in place of `at`."""
    delta_v_rtn_m_per_s: Sequence[float]
    """Change of velocity [m/s]: radial, transverse, normal."""
    thrust_n: float
    """Thrust [N], in place of it."""
    mass_kg: float
    """Mass of the object at the start of the burn [kg]; needed with thrust."""
    duration_s: float
    """Length of the burn [s]; needed with thrust."""
    direction_rtn: Sequence[float]
    """Direction of the acceleration: radial, transverse, normal, of any length. It turns with the axes; needed with
    thrust."""
    specific_impulse_s: float
    """Specific impulse [s], by which a burn uses mass. By default the mass stays."""


class Fixed(TypedDict, total=False):
    """A constant place: geodetic over the scenario's ellipsoid, or a vector."""

    latitude_deg: float
    """Geodetic latitude [deg]."""
    longitude_deg: float
    """Longitude, east [deg]."""
    height_m: float
    """Height above the ellipsoid [m]."""
    itrs_m: Sequence[float]
    """Place in ITRS, which turns with the Earth [m]."""
    gcrs_m: Sequence[float]
    """Place in GCRS, which does not [m]."""


class EnuMotion(TypedDict, total=False):
    """A place, a straight line or a track in east, north and up of `simulation.origin`. Either `position_m` or `track` is
    needed."""

    position_m: Sequence[float]
    """Place at the start of the run [m]."""
    velocity_m_per_s: Sequence[float]
    """Velocity [m/s]. Default: [0, 0, 0]."""
    track: Text
    """A CSV file of time_s, east_m, north_m, up_m."""


class Sgp4(TypedDict, total=False):
    """One element set."""

    line1: Required[Text]
    """First line of a TLE."""
    line2: Required[Text]
    """Second line of a TLE."""


class Proximity(TypedDict, total=False):
    """Motion near another object, the chief, in its radial (up), transverse (ahead) and normal axes. One of `natural`,
    `circumnavigation`, `hold_rtn_m`, `approach`."""

    of: Required[Text]
    """Name or number of the chief, an object of the scenario."""
    natural: Natural
    """Free motion from a state."""
    circumnavigation: Circumnavigation
    """Free motion on an ellipse about it."""
    hold_rtn_m: Sequence[float]
    """Stays at this place [m], forced."""
    approach: Approach
    """Moves on a straight line, forced."""


class Natural(TypedDict, total=False):
    """Free motion from a state at the start of the run, in the chief's radial, transverse and normal axes."""

    position_rtn_m: Required[Sequence[float]]
    """Place relative to the chief [m]."""
    velocity_rtn_m_per_s: Required[Sequence[float]]
    """Velocity seen in the axes, which turn with the chief [m/s]."""
    dynamics: Literal["two_body", "clohessy_wiltshire"]
    """`two_body`: difference of two conics, for any distance and eccentricity; `clohessy_wiltshire`: the first order of it
    about a circle. Default: two_body."""


class Circumnavigation(TypedDict, total=False):
    """An ellipse about the chief, twice as long along its orbit as it is high, once round in a revolution: free motion by
    Clohessy and Wiltshire."""

    radial_m: Required[float]
    """Semi-axis up and down [m]."""
    phase_deg: float
    """Phase at the start of the run [deg]: 0 is ahead of the chief, 90 above it. Default: 0."""
    normal_m: float
    """Semi-axis out of the orbit's plane [m]. Default: 0."""
    normal_phase_deg: float
    """Phase of that at the start of the run [deg]. Default: 0."""
    centre_transverse_m: float
    """Its centre ahead of the chief [m]. Default: 0."""


class Approach(TypedDict, total=False):
    """Holds a place, moves on a straight line to another, and holds that: forced, along V-bar, R-bar or any other line."""

    from_rtn_m: Required[Sequence[float]]
    """Place until the approach [m]."""
    to_rtn_m: Required[Sequence[float]]
    """Place after it [m]."""
    speed_m_per_s: Required[float]
    """Its speed [m/s]."""
    at_s: float
    """When it begins, since the start of the run [s]. Default: 0."""


class Debris(TypedDict, total=False):
    """Debris that no catalogue has, by its flux."""

    population: Required[Population]
    """Sizes, heights and number."""
    name: Text
    """Unique, of 1 to 48 characters; the objects are NAME-NUMBER, the largest first. Default: population."""
    albedo: float
    """Albedo of the spheres that they are. Default: 0.175."""


class Population(TypedDict, total=False):
    """Debris in low orbits, as many as NASA's engineering model has (Kessler et al. 1989, SSP 30425)."""

    min_size_m: Required[float]
    """Diameter of the smallest objects [m]."""
    max_size_m: float
    """Diameter of the largest objects [m]: a catalogue has those beyond. Default: 0.1."""
    min_height_m: float
    """Least semi-major axis less 6378137 m [m]. Default: 2e+05."""
    max_height_m: float
    """Greatest semi-major axis less 6378137 m [m]. Default: 2e+06."""
    inclinations: Text
    """`demo`, or a file of element sets, of which the objects at these heights give the distribution of inclinations.
    Default: demo."""
    year: float
    """Year of the flux, with its fraction: the model has growth from 1988 on. Default: that of the start of the run."""
    solar_flux_sfu: float
    """The Sun's flux at 10.7 cm, over the year before [10^-22 W/m^2/Hz]: 70 at its minimum, 200 at its maximum. Drag removes
    low objects where it is high. Default: 130."""
    scale: float
    """Factor of the number. Default: 1."""
    seed: int
    """Seed of the objects. Default: that of the scenario."""


class Object(TypedDict, total=False):
    """An object of the scenario's own."""

    name: Required[Text]
    """A unique name of 1 to 64 characters."""
    catalogue_number: int
    """Replaces the catalogue's object of this number. By default that of its element set, else 990000001 and onwards."""
    motion: Required[Motion]
    """How it moves."""
    attitude: Literal["nadir", "sun_tracking"] | Attitude
    """How it is turned: towards the Earth, the Sun, or as given."""
    panel: Panel
    """The panel of its geometry that faces the Sun."""
    geometry: Geometry
    """Its shape; needs an attitude."""
    reentry: Reentry
    """Light of its own by height, as it burns in the air; without a geometry."""
    model: Text
    """A shipped model (`dmise list models`) or a file of one, in place of geometry and panel. Its attitude holds unless the
    object has one."""
    radius_m: float
    """Radius of the diffuse sphere that is seen without a shape [m]. Default: 1."""
    albedo: float
    """Its albedo. Default: 0.2."""


class Attitude(TypedDict, total=False):
    """How an object is turned; one of these."""

    inertial: Inertial
    """Fixed relative to the stars."""
    spinning: Spinning
    """Turns about an axis of its own."""
    tumbling: Tumbling
    """Turns freely, without torque."""
    table: Text
    """A CSV file of time_s, w, x, y, z over the whole run."""
    node: Text
    """A node of `nodes` says how it is turned at every tick."""


class Inertial(TypedDict, total=False):
    """An attitude fixed relative to the stars."""

    gcrs_from_body: Required[Sequence[float]]
    """Unit quaternion [w, x, y, z]."""


class Spinning(TypedDict, total=False):
    """A body that turns about an axis of its own."""

    axis: Sequence[float]
    """Axis in body axes. Default: [0, 0, 1]."""
    rate_rpm: Required[float]
    """Rate [turns per minute]."""
    phase_deg: float
    """Rotation of the body at the start of the run [deg]. Default: 0."""
    gcrs_from_body: Sequence[float]
    """Unit quaternion [w, x, y, z] without the phase. Default: [1, 0, 0, 0]."""


class Tumbling(TypedDict, total=False):
    """A rigid body that turns freely, without torque. Its axes are its principal axes."""

    inertia_kg_m2: Required[Sequence[float]]
    """Moments of inertia about x, y, z [kg m^2], none beyond the sum of the others. Only their ratios count."""
    rate_deg_per_s: Required[Sequence[float]]
    """Angular velocity about x, y, z at the start of the run [deg/s]."""
    gcrs_from_body: Sequence[float]
    """Unit quaternion [w, x, y, z] at the start of the run. Default: [1, 0, 0, 0]."""


class Panel(TypedDict, total=False):
    """The part of the geometry that turns about its hinge to face the Sun: the wings of a box-wing, the array of a starlink-
    like satellite, or the objects and groups of an OBJ file whose names begin with `panel`. Without a geometry it changes no
    light and is only published."""

    hinge: Sequence[float]
    """The hinge in body axes; of a starlink-like satellite [1, 0, 0]. Default: [0, 1, 0]."""
    normal: Sequence[float]
    """The normal of the panel at rest, in body axes; of a starlink-like satellite [0, 1, 0]. Default: [0, 0, 1]."""
    hinge_m: Sequence[float]
    """A point of the hinge in body axes [m], not scaled by `scale`; of a starlink-like satellite by default at the array's
    edge at the chassis. Needs a geometry. Default: [0, 0, 0]."""


class Geometry(TypedDict, total=False):
    """The shape of an object: an OBJ file, or a model with its sizes and materials (`dmise list materials`)."""

    obj: Text
    """An OBJ file beside the scenario."""
    model: Literal["box", "plate", "sphere", "cylinder", "box-wing", "starlink-like"]
    """A model, in place of the file."""
    materials: Text
    """A file of materials. Default: the shipped library."""
    scale: float
    """Factor of all lengths. Default: 1."""
    yaw_deg: float
    """Turns the shape and its panel about z, from x to y [deg]. Default: 0."""
    size_m: Sequence[float]
    """Lengths of a box along x, y, z [m], or of a plate along x, y. Default: 1 each."""
    radius_m: float
    """Radius of a sphere or cylinder [m]. Default: 1."""
    length_m: float
    """Length of a cylinder [m]. Default: 2."""
    facets: int
    """Facets of a sphere, about. Default: 1280."""
    sides: int
    """Sides of a cylinder. Default: 48."""
    body_m: Sequence[float]
    """Lengths of the body of a box-wing [m]. Default: [1.8, 1.6, 2]."""
    wing_length_m: float
    """Length of each wing, along y [m]. Default: 5."""
    wing_width_m: float
    """Width of the wings, along x [m]. Default: 1.8."""
    gap_m: float
    """Between body and wing [m]. Default: 0.5."""
    material: Text
    """Material of a box, sphere or cylinder. Default: grey."""
    front: Text
    """Material of the side towards z of a plate, of wings and of an array. Default: by the model."""
    back: Text
    """Material of their other side. Default: by the model."""
    body: Text
    """Material of the body of a box-wing. Default: kapton."""
    body_z: Text
    """Material of the side of the body of a box-wing that faces z, the Earth in nadir attitude. Default: that of the body."""
    chassis: Text
    """Material of the chassis of a starlink-like satellite. Default: starlink-v1.5-chassis."""


class Reentry(TypedDict, total=False):
    """The light of an object that burns in the air, beside the Sun's."""

    height_m: Required[Sequence[float]]
    """Heights over the ellipsoid, ascending [m]. Above and below them there is no light."""
    magnitude: Required[Sequence[float]]
    """V magnitude at each height, seen from `range_m`; linear between them."""
    range_m: float
    """Distance from which the magnitudes are [m]. Default: 1e+05."""


class Node(TypedDict, total=False):
    """A program of one's own that takes part in the run."""

    name: Required[Text]
    """A unique name of letters, digits, - and _."""
    run: Sequence[Text]
    """Program and arguments. It runs in the directory of the scenario, and only with `--allow-programs` or in a trusted
    directory."""
    fmu: Text
    """A Functional Mock-up Unit (FMI 2.0 or 3.0, co-simulation) that moves or turns one object. The Python package runs it,
    with FMPy, and only with `--allow-programs` or in a trusted directory."""
    inputs: FmuInputs
    """What the FMU is given."""
    outputs: FmuOutputs
    """What the FMU says."""
    elsewhere: Switch
    """The program is started by whoever joins it, with `dmise join SCENARIO NAME --program`. Default: off."""
    period_ticks: int
    """Ticks between those for which the program is asked for states. Cubics join the others. Default: 1."""
    consumes: Sequence[Text]
    """Topics that a node which moves or turns objects hears: `detection/SENSOR`, `frame/SENSOR`, `track/fusion-node`,
    `task/SENSOR` and, with states as they are, `state/actor/NODE`; `detection/*` is all that begin so."""
    delay_ticks: int
    """Ticks after which it hears what is published on these topics. Default: 1."""
    options: NodeOptions
    """What the program is told as it begins; of an FMU the numbers with which its parameters and variables start."""


# Input variables of an FMU, and what each is given at the beginning of a step.
FmuInputs = Mapping[str, Literal["time_s", "position_x_m", "velocity_x_m_per_s", "sun_gcrs_x", "sun_body_x", "moon_gcrs_x",
    "moon_body_x", "earth_gcrs_x", "earth_body_x", "position_y_m", "velocity_y_m_per_s", "sun_gcrs_y", "sun_body_y",
    "moon_gcrs_y", "moon_body_y", "earth_gcrs_y", "earth_body_y", "position_z_m", "velocity_z_m_per_s", "sun_gcrs_z",
    "sun_body_z", "moon_gcrs_z", "moon_body_z", "earth_gcrs_z", "earth_body_z"]]


class FmuOutputs(TypedDict, total=False):
    """Output variables of an FMU that say where its object is."""

    position_m: Sequence[Text]
    """x, y, z of the position in GCRS [m]."""
    velocity_m_per_s: Sequence[Text]
    """x, y, z of the velocity in GCRS [m/s]."""
    gcrs_from_body: Sequence[Text]
    """w, x, y, z of the attitude, a unit quaternion."""
    rate_rad_per_s: Sequence[Text]
    """x, y, z of the angular velocity in GCRS [rad/s]."""


# What the program is told as it begins: keys of its own.
NodeOptions = Mapping[str, "float | Switch | str | Sequence[float | Switch | str]"]


class Stars(TypedDict, total=False):
    """The stars behind the objects."""

    catalogue: Text
    """`kstars` (V to 9), `tycho2` (that and Tycho-2, V to 11; `dmise catalogue fetch tycho2` makes it), or a file: HYG in
    CSV, Yale BSC5, kstars' own form, or an index that `dmise catalogue index` has made. Default: kstars."""
    variables: Text
    """The General Catalogue of Variable Stars (`gcvs5.txt`, or `gcvs_cat.dat` of CDS B/gcvs). Its stars then have the
    brightness of the instant. Without it all are constant."""
    faintest_mag: float
    """Faintest star of the catalogue that is drawn [V mag]. Default: 9.5."""
    synthetic_to: float | Literal["limit", "off"]
    """Where the catalogue ends, stars go on by counts to this magnitude [V mag]; `limit`: to the faintest that stands out of
    a frame's noise. Default: off."""


class Sensor(TypedDict, total=False):
    """A camera at a site or aboard an object. Either `site` or `platform` is needed."""

    name: Required[Text]
    """A unique name of 1 to 64 letters, digits, - and _. It names the directory of the sensor's products."""
    site: Text | Site
    """The place on the ground: a name (`dmise list sites`), a file, or coordinates."""
    platform: Text
    """Catalogue number or name of the object that carries the sensor."""
    camera: Required[Text | Camera]
    """The camera: a name (`dmise list cameras`), a file, or its keys."""
    pointing: Required[Literal["zenith"] | Pointing]
    """Where the camera points."""
    exposure_s: Required[float]
    """Length of an exposure [s], at most the cadence."""
    cadence_s: Required[float]
    """Time from the beginning of an exposure to that of the next [s]."""
    first_exposure_s: float
    """Beginning of the first exposure after the start of the run [s]. Default: 0."""
    detection: Switch | Detection
    """Whether moving objects are detected in the frames, or by what program. By default as the scenario says."""
    accuracy: Literal["draft", "standard", "reference", "off"] | Accuracy
    """How accurate frames must be. By default as the scenario says."""
    effects: Effects
    """Effects of this sensor, after the scenario's."""
    seeing: Seeing
    """Turbulence, for a camera with `psf: diffraction`."""
    malfunctions: Sequence[Malfunction]
    """What goes wrong with its devices in `dmise observatory`; nothing else is changed by it. On the ground."""
    mask_deg: float
    """Lowest elevation for `dmise visible` [deg], on the ground. Default: 0."""
    extinction_mag_per_airmass: float
    """Extinction at 550 nm: a short form of `atmosphere: {extinction: ..}`."""
    sky: float | Literal["urban", "suburban", "dark", "space"] | Sky
    """Light of the sky: one brightness everywhere [V mag/arcsec^2], a preset, or parts. Default: dark on the ground, space in
    orbit."""
    atmosphere: Atmosphere
    """The air, on the ground."""
    weather: Weather
    """The weather, on the ground."""
    clock_error: ClockError
    """The sensor's clock is wrong, and exposures begin when it reads their time."""
    pointing_error: PointingError
    """The camera points elsewhere than it is told to."""
    vibration: Vibration
    """The camera vibrates: exposures are displaced and blurred."""


class Site(TypedDict, total=False):
    """A place on the ground, with what surrounds it."""

    name: Text
    """Name of the site."""
    source: Text
    """Where the numbers come from. It is not used."""
    latitude_deg: Required[float]
    """Geodetic latitude [deg]."""
    longitude_deg: Required[float]
    """Longitude, east [deg]."""
    height_m: float
    """Height above the ellipsoid [m]. Default: 0."""
    sky: float | Literal["urban", "suburban", "dark", "space"] | Sky
    """Light of the sky: one brightness everywhere [V mag/arcsec^2], a preset, or parts. Default: dark on the ground, space in
    orbit."""
    atmosphere: Atmosphere
    """The air, on the ground."""
    weather: Weather
    """The weather, on the ground."""


class Sky(TypedDict, total=False):
    """The light of the sky: one brightness, or a preset with changes."""

    preset: Literal["urban", "suburban", "dark", "space"]
    """A sky to start from."""
    zenith_mag_per_arcsec2: float
    """Brightness of the zenith [V mag/arcsec^2]; alone, that of the whole sky."""
    parts: Parts
    """Parts switched on or off."""
    lamps: Lamps
    """The lamps that make the light pollution."""
    cities: Sequence[Cities]
    """Glows at the horizon."""
    airglow_zenith_mag_per_arcsec2: float
    """Brightness of the airglow at the zenith [V mag/arcsec^2]. Default: 22.4."""
    solar_flux_sfu: float
    """The Sun's flux at 10.7 cm, monthly mean [10^-22 W/m^2/Hz]: 70 at its minimum, 200 at its maximum. Airglow follows it.
    Default: 130."""


class Parts(TypedDict, total=False):
    """Parts of the sky's light, each switched on or off."""

    uniform: Switch
    """One brightness everywhere."""
    airglow: Switch
    """Light of the upper atmosphere."""
    zodiacal_light: Switch
    """Sunlight scattered by dust between the planets."""
    faint_starlight: Switch
    """Stars fainter than the catalogue's limit."""
    scattered_moonlight: Switch
    """Moonlight scattered by the air."""
    twilight: Switch
    """Sunlight scattered by the air after sunset."""
    daylight: Switch
    """Sunlight scattered by the air by day."""
    light_pollution: Switch
    """Light of lamps scattered by the air."""
    thermal_sky: Switch
    """Heat of the air, in bands beyond 1.9 um."""


class Lamps(TypedDict, total=False):
    """Shares of lamps in the light pollution; one must be above 0."""

    lps: float
    """Low-pressure sodium. Default: 0."""
    hps: float
    """High-pressure sodium. Default: 0."""
    led: float
    """White LED. Default: 0."""


class Cities(TypedDict, total=False):
    """The glow of a city at the horizon."""

    azimuth_deg: Required[float]
    """From north through east [deg]."""
    half_width_deg: float
    """Standard deviation in azimuth [deg]. Default: 40.1."""
    height_deg: float
    """Altitude at which the glow has fallen to 1/e [deg]. Default: 14.9."""
    horizon_over_zenith: float
    """Its peak, in units of the zenith's even light pollution. Default: 5."""


class Atmosphere(TypedDict, total=False):
    """What the air does to light."""

    extinction: float | str
    """A site's curve, or k at 550 nm [mag/airmass]. Default: 0.17."""
    refraction: Switch
    """Whether the air bends light. The plan decides if not given."""
    turbulence: Literal["hv57"] | Turbulence
    """Turbulence over the site, for scintillation."""
    aerosol_optical_depth: float
    """Optical depth of haze towards the zenith at 550 nm, for the day sky alone. Default: what `extinction` has beyond
    molecules and ozone."""
    angstrom_exponent: float
    """Haze's depth goes by the wavelength to minus this, for the day sky alone. Default: 1.3."""
    ground_albedo: float
    """Share of light that the ground reflects by day. Default: 0.2."""


class Turbulence(TypedDict, total=False):
    """The turbulence of the air, by height."""

    profile: Text
    """`hv57` (Hufnagel-Valley), or a CSV file of height_m, cn2."""
    high_wind_m_per_s: float
    """Rms wind at 5 to 20 km, of `hv57` [m/s]. Default: 21."""
    ground_cn2: float
    """Cn2 at the ground, of `hv57` [m^-2/3]. Default: 1.7e-14."""
    ground_wind_m_per_s: float
    """Wind at the ground [m/s]. Default: 5."""
    jet_wind_m_per_s: float
    """Wind of the jet stream [m/s]. Default: 30."""


class Weather(TypedDict, total=False):
    """The weather at the site. Without pressure a standard atmosphere by height is taken."""

    pressure_hpa: float
    """Air pressure [hPa]."""
    temperature_c: float
    """Air temperature [deg C]."""
    humidity: float
    """Relative humidity."""
    clouds: float | Clouds
    """Transmission of a veil, or clouds."""
    pwv_mm: float
    """Precipitable water [mm]; with it water vapour and oxygen absorb in their bands. Default: as measured in the extinction
    curve, to 1.1 um."""


class Clouds(TypedDict, total=False):
    """Clouds: a veil of one transmission, or patches that the wind carries."""

    cover: float
    """Share of the sky that patches cover. Without it: a veil."""
    transmission: float
    """Of a veil, or of the middle of a patch at the zenith. Default: 0.1."""
    patch_m: float
    """Size of the largest patches [m]. Default: 3000."""
    height_m: float
    """Height above the site [m]. Default: 3000."""
    wind_east_m_per_s: float
    """Wind towards east [m/s]. Default: 8."""
    wind_north_m_per_s: float
    """Wind towards north [m/s]. Default: 0."""
    seed: int
    """Seed of the pattern. Default: 1."""


class Camera(TypedDict, total=False):
    """A camera: its optics, its detector and its band."""

    name: Text
    """Name of the camera in products. Default: camera."""
    source: Text
    """Where the numbers come from. It is not used."""
    optics: Required[Optics]
    """The lens or telescope."""
    detector: Required[Detector]
    """The detector."""
    band: Required[Text | Band]
    """The band: the name of a filter (`dmise list filters`), a CSV file of its transmission, or a box."""
    filters: Sequence[Text | Band]
    """Further filters of its wheel, after `band`: bands that an observatory's software may choose (`dmise observatory`)."""
    magnitude_system: Literal["V-solar", "Vega", "AB"]
    """Of the magnitudes of detections and of the header's zero point: the V of a source of the Sun's colour that is as bright
    in the band, or the band's own. Default: V-solar."""
    exclusion: Exclusion
    """How near Sun, Moon and the Earth's limb may be to the optical axis."""


class Optics(TypedDict, total=False):
    """The lens or telescope and the geometry of its detector. Either `focal_length_m` or `field_of_view_deg` is needed."""

    projection: Literal["gnomonic", "equidistant", "equisolid", "stereographic", "kannala_brandt", "brown_conrady"]
    """How directions are imaged. Default: gnomonic."""
    distortion: Distortion
    """Coefficients of a projection that has some."""
    columns: Required[int]
    """Pixels along a row."""
    rows: Required[int]
    """Pixels along a column."""
    pixel_pitch_m: Required[float]
    """Distance between pixels [m]."""
    focal_length_m: float
    """Focal length [m]."""
    field_of_view_deg: float
    """Field across the columns [deg], in place of the focal length. The projection limits it further."""
    aperture_m: Required[float]
    """Diameter of the entrance pupil [m]."""
    obscuration: float
    """Diameter of the secondary in that of the primary. Default: 0."""
    transmission: float
    """Share of the light that passes the optics, without filter and obscuration. Default: 1."""
    psf: Literal["gaussian", "diffraction", "file"]
    """`gaussian` is a round blur of given width. `diffraction` follows from the pupil, its aberrations and the air. `file` is
    that of `psf_file`. Default: gaussian."""
    psf_file: Text | PsfFile
    """Images of a point source, with `psf: file`: a FITS file, or a map of it."""
    psf_fwhm_px: float
    """Full width at half maximum of the Gaussian [px], before diffraction. Default: 1.5."""
    spiders: Spiders
    """Vanes in the pupil, with `psf: diffraction`."""
    defocus_m: float
    """Distance of the detector from the focus [m], with `psf: diffraction`. Default: 0."""
    focus_distance_m: float
    """Range that is in focus [m]. Stars are then out of focus, as are objects at other ranges. Default: infinity."""
    jitter_px: float
    """Rms jitter of the pointing along an axis [px], with `psf: diffraction` or `file`. Default: 0."""
    jitter_arcsec: float
    """The same [arcsec]; one of both may be given. Default: 0."""
    zernike_nm: ZernikeNm
    """Aberrations of the whole field, with `psf: diffraction`."""
    field_nm: FieldNm
    """Aberrations that grow with the field; they need a `psf_grid`."""
    psf_grid: PsfGrid
    """Kernels over the field. Default: 1 x 1."""
    psf_field: PsfField
    """A point spread that changes with the distance from the axis."""
    focus_drift: FocusDrift
    """The focus drifts with time and temperature."""
    wavelengths: int
    """Wavelengths of the band at which diffraction is computed. Default: 1."""
    most_screens: int
    """Most phase screens of a short exposure through turbulence. Default: 32."""
    oversampling: int
    """Cells per pixel and axis of the kernel. Chosen from the pupil if not given."""
    support_px: int
    """Radius of the kernel [px]. Chosen from the pupil if not given."""
    method: Literal["auto", "deposit", "direct", "transform"]
    """How light is blurred: source by source with a Gaussian or a kernel, or the frame at once. Default: auto."""
    resampling: Literal["area", "bilinear"]
    """How cells of the kernel become pixels. `area` is exact. Default: area."""
    vignetting: Vignetting
    """Light lost away from the axis."""
    stray_light: StrayLight
    """Light of Sun, Moon and Earth beside the field on the focal plane."""
    emission: Emission
    """Heat of the telescope and the window, in bands beyond 1.9 um."""
    equivalent_aperture: Switch
    """Takes the aperture as a collecting area, which allows focal ratios below 0.5. Default: off."""
    ghost_fraction: float
    """Share of the light in the lens's ghost. Default: 0."""
    ghost_radius_px: float
    """Radius of the ghost of a point [px]. Default: 10."""


class Distortion(TypedDict, total=False):
    """Calibrated coefficients of a lens, by its projection."""

    k1: float
    """Of theta^3, -1000 to 1000 with `kannala_brandt`. Radial, of r^3, -10000 to 10000 with `brown_conrady`. Default: 0."""
    k2: float
    """Of theta^5, -1000 to 1000 with `kannala_brandt`. Radial, of r^5, -10000 to 10000 with `brown_conrady`. Default: 0."""
    k3: float
    """Of theta^7, -1000 to 1000 with `kannala_brandt`. Radial, of r^7, -10000 to 10000 with `brown_conrady`. Default: 0."""
    k4: float
    """Of theta^9, -1000 to 1000 with `kannala_brandt`. Default: 0."""
    p1: float
    """Tangential, -100 to 100 with `brown_conrady`. Default: 0."""
    p2: float
    """Tangential, -100 to 100 with `brown_conrady`. Default: 0."""


class PsfFile(TypedDict, total=False):
    """Images of a point source in a FITS file. The middle of an image is the place of the chief ray. Planes of a cube are of
    places of the frame (cards DET_YX0, ..: `(y, x)` in pixels), of wavelengths (WAVELN00, .. in metres), or of both."""

    path: Required[Text]
    """The file, beside this one."""
    samples_per_px: float
    """Pixels of an image in a pixel of the camera. Without it cards tell: OVERSAMP, PSF_SAMP (its inverse) or PIXELSCL
    [arcsec]."""
    with_pixel: Switch
    """The response of the camera's pixel is in the images, as in an effective point spread function (ePSF). Default: off."""


class Spiders(TypedDict, total=False):
    """Vanes that hold the secondary mirror."""

    count: Required[int]
    """Number of vanes, evenly spread."""
    width_m: Required[float]
    """Width of a vane [m], at most the aperture."""


# Aberrations of the whole field: the index of a Zernike term and its rms of optical path.
ZernikeNm = Mapping[str, float]


class FieldNm(TypedDict, total=False):
    """Aberrations that grow with the distance from the axis, as rms of optical path in a corner."""

    coma: float
    """Coma [nm]. Default: 0."""
    astigmatism: float
    """Astigmatism [nm]. Default: 0."""
    curvature: float
    """Curvature of field [nm]. Default: 0."""


class PsfGrid(TypedDict, total=False):
    """Kernels over the field, between which the point spread is interpolated."""

    columns: Required[int]
    """Kernels along a row."""
    rows: Required[int]
    """Kernels along a column."""


class PsfField(TypedDict, total=False):
    """A point spread that changes with the distance from the axis: widths with `psf: gaussian`, aberrations with `psf:
    diffraction`. Smooth and monotone between the radii, constant beyond their ends."""

    radius_deg: Sequence[float]
    """Angles from the boresight [deg], rising."""
    radius_px: Sequence[float]
    """Distances from the middle of the frame [px], in place of the angles."""
    fwhm_radial_px: Sequence[float]
    """Full width at half maximum along the radius [px], before diffraction; in place of `psf_fwhm_px`."""
    fwhm_tangential_px: Sequence[float]
    """The same across the radius; as along it if not given."""
    zernike_nm: FieldZernikeNm
    """Aberrations, in addition to those of the whole field."""


# Aberrations by the distance from the axis: the index of a Zernike term and its rms of optical path at each radius. Theta of
# a term is from the radius outwards.
FieldZernikeNm = Mapping[str, "Sequence[float]"]


class FocusDrift(TypedDict, total=False):
    """The detector leaves the focus with time and with the daily swing of the temperature. The blur is that of the defocus in
    the middle of each exposure."""

    start_um: float
    """Distance of the detector from the focus at the start of the run [um]. Default: 0."""
    um_per_hour: float
    """By which it grows with time [um/h]. Default: 0."""
    um_per_k: float
    """By which it grows with the temperature [um/K]. Default: 0."""
    swing_k: float
    """Between the lowest and the highest temperature of a day [K]. Default: 0."""
    warmest_h: float
    """From the start of the run to the highest temperature [h]. Default: 14."""


class Vignetting(TypedDict, total=False):
    """Light lost away from the axis."""

    natural: Switch
    """Applies the cosine of the pupil's projection. Default: off."""
    corner: float
    """Share of the light that reaches a corner. Default: 1."""
    power: float
    """Power of the distance from the axis with which light is lost. Default: 2."""
    radius_deg: Sequence[float]
    """Angles from the boresight [deg], rising."""
    radius_px: Sequence[float]
    """Distances from the middle of the frame [px], in place of the angles."""
    relative_illumination: Sequence[float]
    """A measured lens, in place of `natural`, `corner` and `power`: light at each radius, relative to that of the axis. It is
    smooth and monotone between, and constant beyond the ends."""


class StrayLight(TypedDict, total=False):
    """Point source transmittance of the optics, against the angle from the boresight."""

    angle_deg: Required[Sequence[float]]
    """Angles of a source from the boresight [deg], rising."""
    transmittance: Required[Sequence[float]]
    """Irradiance of the focal plane over that of the aperture, at each angle."""


class Emission(TypedDict, total=False):
    """Heat of the telescope and the window as the detector sees it: behind a cold stop, the beam alone."""

    emissivity: float
    """Emissivity of all mirrors and lenses together, before the transmission. Default: 0."""
    temperature_c: float
    """Their temperature [deg C]. Default: the air's; needed in space."""
    window_emissivity: float
    """Emissivity of the camera's window. Default: 0."""
    window_temperature_c: float
    """Its temperature [deg C]. Default: the air's; needed in space."""


class Detector(TypedDict, total=False):
    """The detector, from electrons to counts."""

    quantum_efficiency: float | str
    """Photo-electrons a photon, mean over the band. Default: 1."""
    dark_e_per_s: float
    """Dark current at dark_reference_c [e-/s]. Default: 0."""
    dark_reference_c: float
    """Where dark currents are known [deg C]. Default: 0."""
    temperature_c: float
    """Of the detector [deg C]. Default: dark_reference_c."""
    dark_doubling_k: float
    """Warming that doubles dark current [K]. Default: 0."""
    read_noise_e: float
    """Rms [e-]. Default: 0."""
    full_well_e: Required[float]
    """That a pixel holds [e-]."""
    gain_e_per_dn: Required[float]
    """In [e-/DN]."""
    bias_dn: float
    """Count of no electron [DN]. Default: 0."""
    prnu_rms: float
    """Rms of the pixels' responses, relative. Default: 0."""
    hot_pixel_fraction: float
    """Share of hot pixels. Default: 0."""
    hot_pixel_e_per_s: float
    """Mean extra dark current of hot pixels [e-/s]. Default: 0."""
    column_noise_e: float
    """Rms offset of a column [e-]. Default: 0."""
    nonlinearity: float
    """Relative loss of signal at full well. Default: 0."""
    interpixel_coupling: float
    """Share of signal seen by each neighbour. Default: 0."""
    persistence_fraction: float
    """Share of the charge that is trapped. Default: 0."""
    persistence_s: float
    """Time constant of trapped charge [s]. Default: 0."""
    cosmic_rays_per_px_s: float
    """Hits by charged particles [1/s/px]. Default: 0."""
    cosmic_ray_e_per_px: float
    """Left in a pixel pitch of track [e-]. Default: 1000."""
    cosmic_ray_depth_px: float
    """Depth of the sensitive layer [px]. Default: 1."""
    adc_bits: int
    """Bits of the ADC. Default: 16."""
    reference_px: int
    """Border without light [px]. Default: 0."""
    blooming: Switch
    """Charge above the full well runs along columns. Default: off."""
    row_time_us: float
    """A row is exposed later than the one before [us]. Default: 0."""
    frame_transfer_s: float
    """Shift of the image under the mask [s]. Default: 0."""
    brighter_fatter_per_e: float
    """Boundaries move by a pixel's own charge [px/e-]. Default: 0."""
    parallel_cti: float
    """Charge left behind a transfer along columns. Default: 0."""
    serial_cti: float
    """Charge left behind a transfer along rows. Default: 0."""
    cti_release_px: float
    """Until traps release it, exponential [transfers]. Default: 0."""
    em_gain: float
    """Mean gain of the multiplication register. Default: 1."""
    em_stages: int
    """Stages of the register. Default: 536."""
    clock_induced_e: float
    """Mean clock-induced charge of a pixel [e-]. Default: 0."""
    ramp_reads: int
    """Reads up the ramp; 0: none. Default: 0."""
    fowler_reads: int
    """Reads at either end (Fowler); 0: a line. Default: 0."""
    reset_noise_e: float
    """Rms noise of the reset [e-]. Default: 0."""
    read_noise_spread: float
    """Deviation of the logarithm of the pixels' rms. Default: 0."""
    pixel_gain_rms: float
    """Rms of the pixels' gains, relative. Default: 0."""
    column_gain_rms: float
    """Rms of the columns' gains, relative. Default: 0."""
    pixel_offset_e: float
    """Rms of the pixels' fixed offsets [e-]. Default: 0."""
    column_offset_e: float
    """Rms of the columns' fixed offsets [e-]. Default: 0."""


class Band(TypedDict, total=False):
    """The band of the camera: a filter, or a box of given centre and width."""

    filter: Text
    """A filter (`dmise list filters`), or a CSV file of its transmission."""
    name: Text
    """Name of the band in products. By default the filter's."""
    centre_m: float
    """Middle of the box [m]; needed without a filter."""
    width_m: float
    """Width of the box [m], at most twice its centre; needed without a filter."""


class Exclusion(TypedDict, total=False):
    """How near bright bodies may be to the optical axis, and what happens in exposures in which one is nearer. It takes one
    angle or more."""

    sun_deg: float
    """Least angle of the optical axis from the Sun's centre [deg]."""
    moon_deg: float
    """Least angle of the optical axis from the Moon's centre [deg]."""
    earth_limb_deg: float
    """Least angle of the optical axis above the nearest point of the Earth's limb [deg], in orbit."""
    action: Literal["flag", "close_shutter"]
    """flag: the frame, its report and its detections say so. close_shutter: the frame is dark. Default: flag."""


class Pointing(TypedDict, total=False):
    """Where the camera points: by azimuth and elevation, by right ascension and declination, at a target, fixed to the
    platform's body or to east, north and up, scanning, or cued. One of these may be given; without any it points up."""

    azimuth_deg: float
    """From north through east [deg], on the ground."""
    elevation_deg: float
    """Above the horizon [deg], on the ground."""
    azimuth_rate_deg_per_s: float
    """Rate of the azimuth [deg/s]. Default: 0."""
    elevation_rate_deg_per_s: float
    """Rate of the elevation [deg/s]. Default: 0."""
    ra_deg: float
    """Right ascension, ICRS [deg]."""
    dec_deg: float
    """Declination, ICRS [deg]."""
    ra_rate_deg_per_s: float
    """Rate of the right ascension [deg/s]. Default: 0."""
    dec_rate_deg_per_s: float
    """Rate of the declination [deg/s]. Default: 0."""
    target: Text
    """Catalogue number or name of the object to point at."""
    place: Literal["apparent", "geometric"]
    """Whether the target's apparent direction is pointed at, or the straight line. Default: apparent."""
    offset_deg: Sequence[float]
    """Place of the target's image from the boresight [deg], along columns and rows. Default: [0, 0]."""
    body: Body
    """Fixed to the body of the platform."""
    enu: Enu
    """Fixed to east, north and up of the origin."""
    scan: Scan
    """Turns uniformly about an axis."""
    cued: Switch | Cued
    """Observes what the fusion node tells it to."""
    tracking: Literal["fixed", "sidereal", "target", "moving"]
    """What the camera follows during an exposure. By default what its pointing suggests."""
    roll_deg: float
    """Turns the image's up, which is north or the zenith, towards east [deg]. Default: 0."""


class Body(TypedDict, total=False):
    """A camera fixed to the body of its platform. Either `boresight` or `body_from_camera` is needed."""

    boresight: Sequence[float]
    """Direction in body axes."""
    up: Sequence[float]
    """Direction in body axes that is up in the image. Default: z, or y if the boresight is near z."""
    body_from_camera: Sequence[float]
    """Unit quaternion [w, x, y, z] in place of both."""


class Enu(TypedDict, total=False):
    """A camera in east, north and up of `simulation.origin`, wherever the sensor is. Either `look` or `look_at_m` is
    needed."""

    look: Sequence[float]
    """Direction to look along."""
    look_at_m: Sequence[float]
    """Place to look at [m]."""
    up: Sequence[float]
    """Direction that is up in the image. Default: [0, 0, 1], or north along the vertical."""


class Scan(TypedDict, total=False):
    """A camera that turns uniformly about an axis. It begins at an azimuth and elevation, or at a right ascension and
    declination."""

    azimuth_deg: float
    """From north through east [deg], on the ground."""
    elevation_deg: float
    """Above the horizon [deg], on the ground."""
    ra_deg: float
    """Right ascension, ICRS [deg]."""
    dec_deg: float
    """Declination, ICRS [deg]."""
    axis: Required[Sequence[float]]
    """Axis of the turn: in GCRS, or east, north, up for a start by azimuth."""
    rate_deg_per_s: Required[float]
    """Rate, right-handed about the axis [deg/s]."""


class Cued(TypedDict, total=False):
    """A sensor that observes what the fusion node tells it to."""

    park: Park
    """Where it looks without a task. Default: azimuth 180, elevation 60."""
    slew_deg_per_s: float
    """Fastest turn of the mount [deg/s]. Default: 5."""
    slew_deg_per_s2: float
    """Acceleration of the mount [deg/s^2]. 0: it has its speed at once. Default: 0."""
    mount: Literal["great_circle", "altazimuth"]
    """Whether the mount slews along a great circle, or about azimuth and elevation. Default: great_circle."""
    azimuth_deg_per_s: float
    """Fastest turn in azimuth [deg/s], of an altazimuth mount. Default: slew_deg_per_s."""
    azimuth_deg_per_s2: float
    """Acceleration in azimuth [deg/s^2], of an altazimuth mount. 0: it has its speed at once. Default: slew_deg_per_s2."""
    azimuth_range_deg: Sequence[float]
    """Least and greatest azimuth that cables allow [deg], of an altazimuth mount. Default: [-270, 270]."""
    settle_s: float
    """Time to settle after a slew [s]. Default: 2."""
    least_elevation_deg: float
    """Lowest elevation that it observes at [deg]. Default: 20."""
    greatest_elevation_deg: float
    """Highest elevation that it observes at [deg], above the lowest. Default: 90."""
    sun_exclusion_deg: float
    """Least angle from the Sun [deg]. Default: 30."""
    moon_exclusion_deg: float
    """Least angle from the Moon [deg]. Default: 5."""
    exposures: int
    """Most exposures of one task. Default: 3."""
    sigma_arcsec: float
    """Expected error of a detection along each axis [arcsec]. Default: 1."""
    limiting_magnitude: float
    """Faintest magnitude that it detects. Default: 14."""
    least_gain_nats: float
    """Least information that a task must promise [nats]. Default: 0.1."""


class Park(TypedDict, total=False):
    """Where a cued sensor looks without a task."""

    azimuth_deg: Required[float]
    """From north through east [deg]."""
    elevation_deg: Required[float]
    """Above the horizon [deg]."""


class Detection(TypedDict, total=False):
    """Detection by a program of one's own, or with light curves."""

    node: Text
    """One of `nodes`, which is asked for each frame."""
    light_curves: Switch
    """Whether detections of streaks have their light over time and its period. Not of a program of one's own. Default:
    off."""


class Accuracy(TypedDict, total=False):
    """How accurate frames must be, or how long one may take. A plan leaves out what this does not call for."""

    seconds_per_frame: float
    """Time that a frame may take [s], in place of errors."""
    photometry_mag: float
    """Greatest error of the brightness of a source [mag]. Default: 0.01."""
    position_px: float
    """Greatest error of the position of a source [px]. Default: 0.05."""
    background_sigma: float
    """Greatest error of the background between sources, in its noise [sigma]. Default: 0.1."""
    noise: float
    """Greatest error of the noise of a pixel [relative]. Default: 0.01."""


class Effects(TypedDict, total=False):
    """Effects switched on or off, or set to a level. What is not named is left to the plan."""

    clock_error: Switch
    """The sensor's clock is wrong, and exposures begin when it reads their time. Left out: the error times the rate: up to 1
    deg a second in a low orbit, 15 arcsec a second for stars. Default: by the plan."""
    pointing_error: Switch
    """The camera points elsewhere than it is told to. Left out: bias, drift and jitter as they are given; the drift smears
    what the shutter sees of it. Default: by the plan."""
    vibration: Switch
    """The camera vibrates: exposures are displaced and blurred. Left out: its rms: frequencies below that of exposures
    displace them, those above blur. Default: by the plan."""
    proper_motion: Switch
    """Stars move from their catalogue's epoch to the date. Left out: up to 10.4 arcsec a year (Barnard's star). Default: by
    the plan."""
    parallax: Switch
    """Stars seen from the Earth's place on its orbit. Left out: up to 0.77 arcsec. Default: by the plan."""
    light_deflection: Switch
    """The Sun's gravity bends starlight. Left out: 4 mas at 90 deg from the Sun. Default: by the plan."""
    annual_aberration: Switch
    """The Earth's motion displaces stars. Left out: up to 20.5 arcsec. Default: by the plan."""
    diurnal_aberration: Switch
    """The observer's geocentric motion displaces everything. Left out: 0.32 arcsec on the ground, 5.2 in a low orbit.
    Default: by the plan."""
    light_time: Switch
    """Objects are seen where they were when the light left. Left out: up to 5.2 arcsec; the Sun 20.5. Default: by the
    plan."""
    refraction: Switch
    """The atmosphere lifts what is seen from the ground. Left out: 58 arcsec at 45 deg elevation, 5.3 arcmin at 10. Default:
    by the plan."""
    sky: Switch
    """Sky background. Left out: no background and no noise of it. Default: by the plan."""
    sky_grid: Literal["2%", "0.5%", "0.1%", "0.02%", "pixel"]
    """The sky between the pixels at which it is looked at. Left out: an error of 0.5 % of the sky; every pixel at the
    reference. Default: by the plan."""
    airglow: Switch
    """Light of the upper atmosphere. Left out: 22.4 mag/arcsec2 at the zenith. Default: by the plan."""
    zodiacal_light: Switch
    """Sunlight scattered by dust between the planets. Left out: 23.3 mag/arcsec2 at the ecliptic poles, 22 and brighter near
    the ecliptic. Default: by the plan."""
    faint_starlight: Switch
    """Stars below the catalogue's limit. Left out: 22.2 to 24.5 mag/arcsec2. Default: by the plan."""
    scattered_moonlight: Switch
    """Moonlight scattered by the air. Left out: up to 18 mag/arcsec2 at full Moon. Default: by the plan."""
    twilight: Switch
    """Sunlight scattered by the air with the Sun below the horizon. Left out: 18 mag/arcsec2 with the Sun 10 deg down.
    Default: by the plan."""
    daylight: Switch
    """Sunlight scattered by the air by day. Left out: 3 to 5 mag/arcsec2 in V, 5 to 8 in J, H and K. Default: by the plan."""
    light_pollution: Switch
    """Light of lamps scattered by the air. Left out: 18 mag/arcsec2 in a city. Default: by the plan."""
    thermal_sky: Switch
    """Heat of the air, in bands that reach beyond 1.9 um. Left out: beyond 3 um nearly all light of the sky: 2e6 times the
    airglow of V at 10 um. Default: by the plan."""
    stray_light: Switch
    """Light of Sun, Moon and Earth beside the field, scattered by the optics. Left out: no background of it: 1e-6 of the
    Sun's light is 1e4 times the night sky's. Default: by the plan."""
    thermal_optics: Switch
    """Heat of the telescope and the window, in bands that reach beyond 1.9 um. Left out: beyond 3 um, at 280 K and an
    emissivity of 0.1, as much background as the sky's. Default: by the plan."""
    sun_disc: Switch
    """The Sun's disc, where it is in the field. Left out: no Sun in the field. Default: by the plan."""
    moon_disc: Switch
    """The lit part of the Moon's disc, where it is in the field. Left out: no Moon in the field. Default: by the plan."""
    planets: Switch
    """Mercury to Neptune, where one is in the field. Left out: no planets in the field. Default: by the plan."""
    earth_disc: Switch
    """The lit Earth, where a camera in space has it in the field. Left out: a dark Earth. Default: by the plan."""
    limb_air: Switch
    """Sunlit air over the Earth's limb, seen from space. Left out: a sharp limb without air. Default: by the plan."""
    limb_airglow: Switch
    """Airglow over the Earth's limb and before its disc, seen from space. Left out: no airglow: 17.9 mag/arcsec2 in V at its
    brightest. Default: by the plan."""
    objects: Switch
    """Space objects. Left out: no objects. Default: by the plan."""
    resolved_shapes: Literal["1px", "0.5px", "0.2px", "0.05px", "0.01px"]
    """From which radius on objects with a shape are no points. Left out: a point is displaced or broadened by up to its
    radius. Default: by the plan."""
    shadow: Literal["sharp", "limb", "air"] | Switch
    """Objects are dimmed by the Earth's penumbra and umbra. Left out: objects in shadow are drawn fully lit; sharp: 3 mag too
    bright at its edge in a low orbit, 0.5 in a geosynchronous one. Default: by the plan."""
    earthshine: Switch
    """Sunlight that the Earth throws on objects (off unless asked for). Left out: up to 0.4 of full sunlight on what faces
    the Earth; all that there is in its shadow. Default: off."""
    moonlight: Switch
    """Moonlight on objects (off unless asked for). Left out: 2.5e-6 of full sunlight at full Moon: all that there is in the
    Earth's shadow but for earthshine. Default: off."""
    thermal_emission: Switch
    """Objects with a shape radiate by their warmth. Left out: at 300 K 1e-3 of the sunlight that a reflectance of 0.3 returns
    at 2.5 um, 7 times it at 5 um. Default: by the plan."""
    glints: Switch
    """Small parts of objects glint and fade as they turn. Left out: 0.1 to 0.2 mag within a minute for OneWeb and Iridium
    NEXT. Default: by the plan."""
    stars: Literal["v0", "v1", "v2", "v3", "v4", "v5", "v6", "v7", "v8", "v9", "v10", "v11", "v12", "v13", "v14", "v15", "all"] | Switch
    """Star background. Left out: no stars. Default: by the plan."""
    synthetic_stars: Literal["v10", "v11", "v12", "v13", "v14", "v15", "v16", "v17", "v18", "v19", "v20", "v21", "all"] | Switch
    """Stars that no catalogue has, where it ends (to `stars.synthetic_to`). Left out: they are in the smooth starlight; a
    pixel of 10 arcsec in the Milky Way has 0.8 to V = 21. Default: by the plan."""
    earth_occultation: Switch
    """The Earth hides what is behind it. Left out: objects and stars behind it are drawn. Default: by the plan."""
    limb_extinction: Switch
    """Air over the Earth's limb dims what is behind it, seen from space. Left out: 1.8 mag at a tangent height of 20 km, 3
    mag at 10 km in V. Default: by the plan."""
    extinction: Switch
    """The atmosphere dims what is seen from the ground. Left out: 0.1 to 0.4 mag an airmass. Default: by the plan."""
    gas_absorption: Switch
    """Water vapour and oxygen absorb (with weather: {pwv_mm}). Left out: 0.02 to 0.2 mag in I, J, H and K; all of the light
    at 1.4 and 1.9 um. Default: by the plan."""
    clouds: Switch
    """Clouds dim what is above them. Left out: as if the sky were clear. Default: by the plan."""
    scintillation: Switch
    """Turbulence makes point sources scintillate (Young). Left out: 4 % for 0.3 m and 0.1 s at an airmass of 1.5. Default: by
    the plan."""
    moving_scintillation: Switch
    """Scintillation averages by the source's own motion (off unless asked for). Left out: sources that move by 0.3 deg a
    second scintillate 2 times too much. Default: off."""
    dispersion: Literal["mean", "1px", "0.3px", "0.1px"] | Switch
    """The atmosphere spreads a point into a spectrum along the vertical (off unless asked for). Left out: 0.7 arcsec across V
    at 45 deg elevation, 1.4 across B, 1.7 from 0.4 to 0.9 um. Default: off."""
    vignetting: Switch
    """Lenses lose light off the axis. Left out: corners too bright: 0.16 mag at 30 deg by the pupil alone. Default: by the
    plan."""
    occlusion: Switch
    """Objects with a shape hide what is behind them. Left out: stars, sky and farther objects shine through an object of many
    pixels. Default: by the plan."""
    psf: Switch
    """Blur of the optics. Left out: light falls on a point of no size. Default: by the plan."""
    turbulence: Literal["long", "short"] | Switch
    """Turbulence blurs points: by its mean, or as in a short exposure. Left out: 1 arcsec of width with r0 = 0.11 m; by its
    mean no motion and no speckle. Default: by the plan."""
    psf_wavelengths: Literal["1", 1, "2", 2, "3", 3, "5", 5, "9", 9]
    """Wavelengths of the band for which the blur is computed. Left out: with one, 0.02 mag x width / wavelength in an
    aperture of the blur. Default: by the plan."""
    psf_field: Literal["3x3", "5x5", "9x9"] | Switch
    """The blur changes over the field, by a table (kernels at N x N places, linear between). Left out: every place has the
    blur of the centre. Default: by the plan."""
    focus_drift: Switch
    """The focus drifts with time and temperature. Left out: the focus stays: a disc of defocus / focal ratio is missing.
    Default: by the plan."""
    range_defocus: Literal["10%", "3%", "1%", "0.3%"] | Switch
    """Objects are out of focus by their range (share of their light that may be misplaced). Left out: objects are as sharp as
    stars: a disc of aperture / range is missing. Default: by the plan."""
    lens_ghost: Switch
    """Reflections between lens surfaces add a faint mirrored copy of the image. Left out: no ghosts: 1e-5 to 1e-3 of bright
    sources. Default: by the plan."""
    rolling_shutter: Switch
    """Each row is exposed a row time later than the one before. Left out: sources are displaced by their rate times the delay
    of their row. Default: by the plan."""
    frame_transfer: Switch
    """The image is still exposed while it is shifted under the mask. Left out: no smear: the light of the rows passed, times
    a row's time over the exposure. Default: by the plan."""
    prnu: Switch
    """Pixel response non-uniformity. Left out: a fixed pattern: 0.01 of the light in a usual camera. Default: by the plan."""
    photon_noise: Literal["gaussian", "exact"] | Switch
    """Photons arrive at random (Poisson). Left out: expected electrons instead of a draw. Default: by the plan."""
    brighter_fatter: Switch
    """Charge moves the boundaries of its pixel, and bright sources are wider. Left out: widths of sources near the full well
    too small by about 1 %. Default: by the plan."""
    dark_current: Switch
    """Thermally generated electrons. Left out: none. Default: by the plan."""
    hot_pixels: Switch
    """Some pixels have far more dark current than others. Left out: no false points. Default: by the plan."""
    cosmic_rays: Switch
    """Charged particles leave tracks. Left out: no false points and streaks. Default: by the plan."""
    reference_pixels: Switch
    """Border pixels without light and dark current. Left out: the border collects light as the rest does. Default: by the
    plan."""
    persistence: Switch
    """Charge trapped in one exposure appears in the next ones. Left out: no ghosts: 1e-3 to 1e-2 of what was collected.
    Default: by the plan."""
    full_well: Switch
    """Limit of electrons per pixel. Left out: no saturation before the ADC. Default: by the plan."""
    blooming: Switch
    """Charge above the full well flows along columns. Left out: it is lost. Default: by the plan."""
    charge_transfer: Switch
    """Charge is left behind when it is transferred. Left out: no trails: transfers times the inefficiency of every source,
    0.01 to 0.1 of an old detector. Default: by the plan."""
    em_gain: Switch
    """A register multiplies electrons at random. Left out: shot noise smaller by up to the root of 2; no clock-induced
    charge. Default: by the plan."""
    nonlinearity: Switch
    """The amplifier's gain falls with the signal. Left out: a straight response. Default: by the plan."""
    interpixel_coupling: Switch
    """Part of a pixel's signal appears in its neighbours. Left out: noise of neighbours uncorrelated; shot noise looks 1 - 8
    times the coupling smaller with it. Default: by the plan."""
    ramp: Switch
    """The signal is fitted to many reads up the ramp of charge. Left out: one read noise; shot noise smaller by up to 10 %.
    Default: by the plan."""
    column_noise: Switch
    """Random offset of every column, new in each frame. Left out: none. Default: by the plan."""
    read_noise: Switch
    """Noise of the read-out amplifier. Left out: none. Default: by the plan."""
    fixed_pattern: Switch
    """Amplifiers of pixels and columns differ in gain and offset. Left out: a fixed pattern: 0.01 of the signal and 1 to 10
    e- in a usual CMOS camera. Default: by the plan."""
    quantisation: Switch
    """Gain, bias, ADC range and rounding. Left out: one DN an electron, no bias, 16 bits. Default: by the plan."""
    aberration: Switch
    """Annual and diurnal aberration together."""
    integration: Literal["analytic", "snapshots"]
    """How trails are drawn: exactly, or as a sum of snapshots. Default: analytic."""
    snapshots: int
    """Snapshots of an exposure, with `integration: snapshots`. Default: 16."""
    evaluator: Literal["analytic", "opengl"]
    """What draws the snapshots. Default: analytic."""


class Seeing(TypedDict, total=False):
    """Turbulence as a camera with `psf: diffraction` sees it: `r0_m`, or a profile over height."""

    r0_m: float
    """Fried's parameter at 500 nm in the direction of the camera [m]; needed without a profile."""
    outer_scale_m: float
    """Outer scale [m]. Default: infinite."""
    wind_m_per_s: float
    """Wind that carries the turbulence past the pupil [m/s]. Default: 10."""
    wind_direction_deg: float
    """Direction of the wind across the image [deg]. Default: 0."""
    profile: Text
    """`hv57` (Hufnagel-Valley), or a CSV file of height_m, cn2."""
    high_wind_m_per_s: float
    """Rms wind at 5 to 20 km, of `hv57` [m/s]. Default: 21."""
    ground_cn2: float
    """Cn2 at the ground, of `hv57` [m^-2/3]. Default: 1.7e-14."""
    ground_wind_m_per_s: float
    """Wind at the ground [m/s]. Default: 5."""
    jet_wind_m_per_s: float
    """Wind of the jet stream [m/s]. Default: 30."""


class Malfunction(TypedDict, total=False):
    """Something that goes wrong with the devices of a sensor while an observatory's software commands them. An exposure has
    what holds when it begins."""

    kind: Required[Literal["lost_link", "slow_download", "stuck_shutter", "stopped_mount", "wrong_gain"]]
    """lost_link: its devices do not answer. slow_download: images come later. stuck_shutter: it stays closed. stopped_mount:
    the axis stands still, and the telescope tells that it moves. wrong_gain: it is told wrong."""
    at_s: Required[float]
    """When it begins, after the start of the run [s]."""
    for_s: Required[float]
    """How long it lasts [s]."""
    download_s: float
    """From the end of an exposure to its image [s]; of slow_download, which needs it."""
    gain_e_per_dn: float
    """The gain that is told [e-/DN]; of wrong_gain, which needs it."""


class ClockError(TypedDict, total=False):
    """The sensor's clock is wrong, and exposures begin when it reads their time."""

    offset_ms: float
    """Time by which the clock is fast at the start of the run [ms]. Default: 0."""
    drift_ppm: float
    """Rate by which it gains [1e-6]. Default: 0."""
    jitter_ms: float
    """Rms error of each reading [ms]. Default: 0."""


class PointingError(TypedDict, total=False):
    """The camera points elsewhere than it is told to."""

    bias_deg: Sequence[float]
    """Constant error of the pointing [deg]: right, down, roll."""
    bias_arcsec: Sequence[float]
    """The same [arcsec]; one of both may be given."""
    drift_arcsec_per_s: Sequence[float]
    """Growth of the error [arcsec/s]: right, down, roll."""
    jitter_arcsec: float | Sequence[float]
    """Rms error of each exposure [arcsec]: right, down, roll, or one number for the first two."""


class Vibration(TypedDict, total=False):
    """The camera vibrates: exposures are displaced and blurred."""

    psd_hz: Sequence[float]
    """Frequencies of the power spectral density [Hz], rising."""
    psd_arcsec2_per_hz: Sequence[float]
    """One-sided density of an axis there [arcsec2/Hz]; straight between, none outside."""
    sine_hz: Sequence[float]
    """Frequencies of sinusoids [Hz]."""
    sine_rms_arcsec: Sequence[float]
    """Their rms along an axis [arcsec]."""


class OwnSensor(TypedDict, total=False):
    """A sensor of one's own: a program that says what it observes. Either `site` or `platform` is needed."""

    name: Required[Text]
    """A unique name of 1 to 64 letters, digits, - and _. It names the directory of the sensor's products."""
    node: Required[Text]
    """One of `nodes`, which is asked at each exposure."""
    site: Text | Site
    """The place on the ground: a name (`dmise list sites`), a file, or coordinates."""
    platform: Text
    """Catalogue number or name of the object that carries the sensor."""
    exposure_s: Required[float]
    """Length of an exposure [s], at most the cadence."""
    cadence_s: Required[float]
    """Time from the beginning of an exposure to that of the next [s]."""
    first_exposure_s: float
    """Beginning of the first exposure after the start of the run [s]. Default: 0."""
    truth: Switch
    """Whether the program is told the true positions and velocities of all objects. Default: off."""
    half_angle_deg: float
    """Half angle of the cone about its boresight that contains its field [deg]. Default: 180."""


class Fusion(TypedDict, total=False):
    """A node that makes tracks of the detections of all sensors."""

    node: Text
    """Node of `nodes` whose program makes the tracks, instead of the fusion node's own filters. Of the other keys it takes
    `detection_probability`, `cue_delay_ticks`, `catalogue`, `age_days` and `not_in_catalogue`."""
    catalogue: Text
    """File of element sets beside the scenario (TLE, 3LE, OMM) that the node knows instead of those with which the objects
    move."""
    age_days: float
    """Least age at the start of the run of the element sets of `catalogue` [days]: of each object the newest that is so old
    is known."""
    catalogue_sigma_m: Sequence[float]
    """Errors of the catalogue at its epoch [m]: radial, along the track, across it."""
    catalogue_sigma_m_per_day: Sequence[float]
    """Growth of these errors [m per day]."""
    gate_d2: float
    """Greatest squared distance of a detection from a track, as chi-square of 2 degrees of freedom. 18.4 misses 1 in 10,000.
    Default: 18.4."""
    detection_probability: float
    """Probability that an object well above the limit is detected. Default: 0.9."""
    false_alarms_per_frame: float
    """Expected false alarms in a frame. Default: 1."""
    lost_after_s: float
    """Time without a detection after which a confirmed track is lost [s]. Default: 900."""
    tentative_s: float
    """The same for a tentative track [s]. Default: 120."""
    start_window_s: float
    """Greatest time between the detections that start a track [s]. Default: 60."""
    simultaneous_s: float
    """Greatest time between detections of two sites that give a position [s]. Default: 0.5."""
    arc_window_s: float
    """Greatest time between the exposures of one site that begin a track [s]. Default: 240."""
    arc_exposures: int
    """Least exposures of one site that begin a track. 0: one site begins none; else 4 or more. Default: 4."""
    acceleration_noise_m2_per_s3: float
    """Process noise of the filter [m^2/s^3]. Default: 1e-06."""
    pointing_sigma_arcsec: float
    """Error of a frame's directions that its detections do not know [arcsec]: jitter, bias, drift. Default: 0."""
    confirm_catalogued: int
    """Detections that confirm a track of a catalogued object. Default: 3."""
    confirm_unknown: int
    """Detections that confirm a track of an unknown object, which begins with four. Default: 6."""
    confirm_arc: int
    """Further detections that confirm a track that one site began. Default: 4."""
    keep_orbits: Switch
    """Keep the orbits of objects from arc to arc of their detections by numerical forces, find manoeuvres and breakups, and
    write `orbits.jsonl` and `breakups.jsonl`. Runs of at most 18 days. Default: off."""
    cue_delay_ticks: int
    """Ticks between the decision for a task and its beginning. Default: 2."""
    not_in_catalogue: Sequence[Text]
    """Names or numbers of objects that the fusion node does not know beforehand."""


class Environment(TypedDict, total=False):
    """How often the environment node publishes."""

    common_every_s: float
    """Interval of Sun, Moon and Earth [s]. 0: every tick. Default: 0."""
    site_every_s: float
    """Interval of each site's weather [s]. Default: 60."""


class Network(TypedDict, total=False):
    """How the processes of a launched run work together."""

    window_ticks: int
    """Ticks by which a node may run ahead of the slowest. Default: 4."""
    on_silent_node: Literal["fail", "wait", "drop", "restart"]
    """What is done about a node that does not answer. Default: fail."""
    silent_after_s: float
    """Time without an answer after which a node is silent [s]. Default: 5."""
    restarts: int
    """Most restarts of a node, with `on_silent_node: restart`. Default: 5."""
    real_time: float
    """Simulated seconds per second of wall-clock time. 0: as fast as possible. Default: 0."""
    join_within_s: float
    """Time within which all nodes must have joined [s]. Default: 30."""
    publish_states: Switch
    """Publishes states of all objects for subscribers that are not nodes of the scenario. Default: on."""
    sensors_propagate: Switch
    """Sensors propagate the objects in their field. Off: they take published states. Default: on."""


class Output(TypedDict, total=False):
    """Files of every frame."""

    fits: Switch | Fits
    """Whether each frame is written as FITS. Default: on."""
    saturation: Switch
    """Writes flags of saturated pixels as a second image of the FITS file. Default: off."""
    png: Switch
    """Whether previews are written, plain and marked. Default: on."""
    truth: Switch
    """Whether `truth.jsonl` says what was drawn into each frame. Default: on."""
    star_truth: Switch
    """Writes `frame-NNNNNN.stars.csv` with every star and planet that was drawn. Default: off."""
    preview_width_px: int
    """Greatest width of a preview [px]. Wider frames are shrunk. Default: 1663."""
    radiance_exr: Switch | RadianceExr
    """Writes `frame-NNNNNN-radiance.exr`, the light at the aperture. Default: off."""
    planes: Sequence[Literal["sources", "background", "noise"]]
    """Writes these expectations of each frame as `frame-NNNNNN-PLANE.fits`."""
    positions: Sequence[Literal["csv", "jsonl", "oem"]]
    """Writes positions of cameras, platforms, own objects, Sun and Moon at every tick in these formats."""
    positions_frame: Literal["gcrs", "enu"]
    """Axes of the tables of positions: GCRS, or east, north and up of the origin. Default: gcrs."""


class Fits(TypedDict, total=False):
    """How FITS files are written."""

    compression: Required[Literal["none", "rice"]]
    """`rice` compresses without loss, to about half the size."""


class RadianceExr(TypedDict, total=False):
    """A map of radiance beside each frame."""

    bands: Required[int]
    """Parts of the band, each a channel of its own. 1 writes the whole band alone."""
