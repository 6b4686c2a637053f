"""An actor that moves its object as an OEM says, by the arithmetic of core/orbit/oem_interpolation.cpp."""
import dmise
import mortal

KNOTS = 4  # for a polynomial of degree 7
_knots = []


def read(path):
    for line in open(path):
        time, *numbers = line.split()
        if not time.startswith("20") or len(numbers) != 6:
            continue
        hour, minute, second = map(int, time[11:].split(":"))
        values = [float(number) * 1000.0 for number in numbers]
        _knots.append((((hour * 60.0 + minute) * 60.0 + second + 0.0 - 0.0) / 86400.0, values))


def seconds_between(start, end):
    return (0.0 + (end - start)) * 86400.0


def interpolated(t_s):
    times = [seconds_between(_knots[0][0], day) for day, _ in _knots]
    interval = max(0, sum(time <= t_s for time in times) - 1)
    first = min(max(interval - (KNOTS - 1) // 2, 0), len(times) - KNOTS)
    position, velocity = [0.0] * 3, [0.0] * 3
    for k in range(first, first + KNOTS):
        value, slope, at_knot = 1.0, 0.0, 0.0
        for j in range(first, first + KNOTS):
            if j == k:
                continue
            distance = times[k] - times[j]
            slope = slope * ((t_s - times[j]) / distance) + value / distance
            value *= (t_s - times[j]) / distance
            at_knot += 1.0 / distance
        dt = t_s - times[k]
        square, square_slope, lever = value * value, 2 * value * slope, 1 - 2 * at_knot * dt
        for axis in range(3):
            p, v = _knots[k][1][axis], _knots[k][1][3 + axis]
            position[axis] += p * (lever * square) + v * (dt * square)
            velocity[axis] += p * (lever * square_slope - 2 * at_knot * square) + v * (square + dt * square_slope)
    return position, velocity


@dmise.actor("probe")
def follow(t_s, world, options):
    mortal.maybe_die(world.tick, options)
    if not _knots:
        read(options["file"])
    ns_of_day = (15 * 60 + 37) * 1_000_000_000 + world.time_ns
    position, velocity = interpolated(seconds_between(_knots[0][0], ns_of_day / 86_400_000_000_000.0))
    return dmise.State(position_m=position, velocity_m_per_s=velocity)


dmise.serve(follow)
