"""What is done to whom and when: drawn at random, the same again for the same seed and number."""

import dataclasses
import random

from disturbance.scene import EVERYBODY, NODES, SENSORS, SILENT_AFTER_S

WALL_S = 4.0  # the undisturbed run takes so long
POLICIES = ("fail", "wait", "restart", "drop")
FOR_EVER = float("inf")


@dataclasses.dataclass(frozen=True)
class Fault:
    at_s: float  # after the first frame; of early ones, after the start
    kind: str  # kill, stop, slow, cut, narrow
    victim: str
    lasts_s: float = 0.0  # how long a stop, a slowing, a cut or a narrowing lasts; a kill, until another is started by hand

    def __str__(self):
        lasts = "" if not self.lasts_s else " for ever" if self.lasts_s == FOR_EVER else f" for {self.lasts_s:.2f} s"
        return f"{self.kind} {self.victim} at {self.at_s:.2f} s{lasts}"

    @property
    def silence_s(self):
        """Longest time for which nothing is heard of the victim."""
        return {"kill": FOR_EVER, "stop": self.lasts_s, "cut": 2 * self.lasts_s}.get(self.kind, 0.0)

    @property
    def fatal(self):
        """Surely longer silent than the network bears."""
        return self.kind == "kill" or (self.kind in ("stop", "cut") and self.lasts_s > SILENT_AFTER_S + 1.0)

    @property
    def borne(self):
        """Surely shorter; a link that was cut is silent until the next try of TCP, up to twice as long."""
        return self.silence_s < SILENT_AFTER_S - 1.0


@dataclasses.dataclass(frozen=True)
class Schedule:
    seed: int
    number: int
    where: str  # launch: by dmise launch on one host; spread: each process on a host of its own
    policy: str
    early: bool  # the first moments are those of the start
    wall_s: float
    faults: tuple

    def __str__(self):
        early = ", from the start" if self.early else ""
        return f"{self.seed}/{self.number} {self.where} {self.policy}{early}: {'; '.join(map(str, self.faults))}"


def draw(seed, number, where=None):
    """`where`: launch or spread; None: one in four is spread."""
    rng = random.Random(f"{seed}/{number}")
    drawn = "spread" if rng.random() < 0.25 else "launch"
    where = where or drawn
    policy = rng.choices(POLICIES if where == "launch" else ("fail", "wait", "drop"),
                         (4, 3, 6, 3) if where == "launch" else (4, 4, 3))[0]
    early = rng.random() < 0.15
    faults = sorted((one(rng, where, policy, early) for _ in range(rng.choice((1, 1, 2, 3)))),
                    key=lambda f: f.at_s)
    if policy == "drop":  # one who is lost, so that the others can be judged
        faults = [f for i, f in enumerate(faults) if i == 0 or f.borne]
    return Schedule(seed, number, where, policy, early, rng.choice((WALL_S, WALL_S, 0.0)), tuple(faults))


def one(rng, where, policy, early):
    kinds = {"launch": ("kill", "kill", "stop", "stop", "slow"),
             "spread": ("cut", "cut", "narrow", "kill", "stop")}[where]
    kind = rng.choice(kinds)
    victim = rng.choice(EVERYBODY)
    if policy == "drop":
        victim = rng.choice((*SENSORS, *SENSORS, "positions-node", *NODES))
    if where == "launch" and rng.random() < 0.12:
        victim = rng.choice(("time-master", "dmise"))
        kind = rng.choice(("kill", "stop"))
    at_s = rng.uniform(0.0, 1.5 if early else WALL_S - 0.5)
    short, long = rng.uniform(0.1, 0.9), rng.uniform(SILENT_AFTER_S + 1.1, SILENT_AFTER_S + 2.5)
    between = rng.uniform(1.0, SILENT_AFTER_S + 1.0)
    lasts_s = {"kill": rng.uniform(0.0, 2.0),
               "stop": rng.choice((short, between, long, long)),
               "cut": rng.choice((short / 2, between, long)),
               "slow": rng.uniform(0.5, 3.0),
               "narrow": rng.uniform(0.5, 4.0)}[kind]
    if policy != "wait" and kind in ("stop", "cut") and victim != "dmise" and rng.random() < 0.3:
        lasts_s = FOR_EVER
    return Fault(at_s, kind, victim, lasts_s)
