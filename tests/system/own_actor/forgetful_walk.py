"""The walk of walk.py without checkpoints: the program is run again from its first tick."""
import dmise
from walk import Walk


@dmise.actor()
class Forgetful:
    def __init__(self):
        self.walk = Walk.make()

    def __call__(self, t_s, world, options):
        return self.walk(t_s, world, options)


dmise.serve(Forgetful)
