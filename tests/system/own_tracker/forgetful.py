"""As follow.py, without checkpoints: it is told all ticks again."""
import dmise
from follow import Follow

dmise.serve(dmise.tracker(Follow))
