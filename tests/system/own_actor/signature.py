"""An actor with a wrong signature."""
import dmise

@dmise.actor("probe")
def orbit(t_s):
    return dmise.State([7e6, 0, 0], [0, 7e3, 0])


dmise.serve(orbit)
