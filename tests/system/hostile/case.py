"""What a case is: a function that attacks a run, and what must hold of the run."""

import dataclasses
from collections.abc import Callable
from typing import ClassVar


@dataclasses.dataclass(frozen=True)
class Case:
    """One attack on one kind of run."""
    name: str
    group: str
    attack: Callable      # attack(target); returns when it is over; a Failure fails the case
    keys: bool            # a run with keys: the stranger holds a key that may come in, and nothing else
    hosts: int            # > 0: sensors behind so many agents
    growth_mib: float     # most that a process may grow from the attack on
    may_fail: bool        # the run may end with an exit code other than 0 that names its cause
    wall_s: float         # time of the undisturbed run
    late_s: float         # most that the attack may delay its end
    all: ClassVar[list] = []


def case(group, plain=True, keys=False, hosts=0, growth_mib=64.0, may_fail=False, wall_s=6.0, late_s=30.0):
    """Registers an attack under its own name, and with "-with-keys" after it for a run with keys."""
    def register(attack):
        name = attack.__name__.replace("_", "-")
        for with_keys in [False] * plain + [True] * keys:
            Case.all.append(Case(name + "-with-keys" * with_keys, group, attack, with_keys, hosts, growth_mib,
                                 may_fail, wall_s, late_s))
        return attack
    return register
