"""An FMU of FMI 2.0: an object that the Earth pulls, and that a thrust pushes along what it is given."""
import os

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

GM = 3.986004415e14  # m^3/s^2


class Orbit(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.x, self.y, self.z = 7178112.401, -2810.113, 18581.004
        self.vx, self.vy, self.vz = -19.5088, -1114.308, 7368.021
        self.along_x = self.along_y = self.along_z = 0.0  # thrust acts along this
        self.gain = 0.0
        for name in ("x", "y", "z", "vx", "vy", "vz"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))
        for name in ("along_x", "along_y", "along_z"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        self.register_variable(Real("gain", causality=Fmi2Causality.parameter, variability=Fmi2Variability.tunable))

    def do_step(self, current_time, step_size):
        lives = os.environ.get("OWN_FMU_LIVES")
        if lives and current_time == 100 and not os.path.exists(lives):
            open(lives, "w").close()
            os.kill(os.getpid(), 9)
        pull = -GM / (self.x**2 + self.y**2 + self.z**2)**1.5
        self.vx += step_size * (pull * self.x + self.gain * self.along_x)
        self.vy += step_size * (pull * self.y + self.gain * self.along_y)
        self.vz += step_size * (pull * self.z + self.gain * self.along_z)
        self.x += step_size * self.vx
        self.y += step_size * self.vy
        self.z += step_size * self.vz
        return True
