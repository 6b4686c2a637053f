"""A satellite that the Sun's light pushes, as an FMU: `python3 -m pythonfmu build -f sailor.py` makes Sailor.fmu for sailor.yaml."""
from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

GM = 3.986004415e14  # m^3/s^2


class Sailor(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.x, self.y, self.z = 7178112.401, -2810.113, 18581.004
        self.vx, self.vy, self.vz = -19.5088, -1114.308, 7368.021
        self.sun_x = self.sun_y = self.sun_z = 0.0
        self.push_m_per_s2 = 0.0
        for name in ("x", "y", "z", "vx", "vy", "vz"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))
        for name in ("sun_x", "sun_y", "sun_z"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        self.register_variable(Real("push_m_per_s2", causality=Fmi2Causality.parameter, variability=Fmi2Variability.tunable))

    def do_step(self, current_time, step_size):
        pull = -GM / (self.x**2 + self.y**2 + self.z**2)**1.5
        for axis in "xyz":
            speed = getattr(self, "v" + axis) + step_size * (
                pull * getattr(self, axis) - self.push_m_per_s2 * getattr(self, "sun_" + axis))
            setattr(self, "v" + axis, speed)
            setattr(self, axis, getattr(self, axis) + step_size * speed)
        return True
