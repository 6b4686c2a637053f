"""A discrete-event simulation of a run's lock-step: time-master, orbit node, broker and sensor nodes
as queues of work on hosts with so many cores, joined by links with a speed and a delay.

Costs are processor seconds and bytes, as `dmise bench scaling` measures them (`Costs`). Left out:
heartbeats, threads of a process that overlap, caches, packets that are lost.
"""

import collections
import dataclasses
import heapq


@dataclasses.dataclass(frozen=True)
class Costs:
    """Processor time [s] and bytes of a tick."""
    master_s: float              # what the time-master takes
    master_per_node_s: float     # and for each node that reports to it
    broker_s: float              # what the broker takes
    broker_per_node_s: float     # and for each sensor node, with states that are empty
    orbit_s: float
    sensor_s: float
    node_bytes: float            # all that a sensor node and the others exchange, states empty
    state_bytes: float = 0.0     # the states, once
    copy_s: float = 0.0          # the broker, for each subscriber's copy of the states
    publish_s: float = 0.0       # the orbit node, for the states
    take_in_s: float = 0.0       # a sensor node, for the states


@dataclasses.dataclass(frozen=True)
class Network:
    sensors: int
    hosts: int = 1               # for sensors; with more than one, master, broker and orbit node have their own
    cores: int = 2
    agents: bool = False         # one a host: reports for its sensors, and takes one copy of the states
    bits_per_s: float = 10e9     # speed of each host's link
    delay_s: float = 50e-6       # from host to host
    window_ticks: int = 4
    tick_s: float = 0.0          # real time; 0: as fast as possible
    frame_s: float = 0.0         # processor time of a frame,
    frame_ticks: int = 4         # and each sensor makes one in so many ticks, in turn


@dataclasses.dataclass
class Outcome:
    ticks_per_s: float           # from the middle of the run on
    master_s: float              # processor time a tick
    broker_s: float
    broker_out_bytes: float      # a tick, over the link of the broker's host
    worst_lag_s: float           # among ticks not over when the next was due
    overruns: int


class Host:
    """Cores that work off jobs in the order in which they became ready."""

    def __init__(self, clock, cores, bits_per_s):
        self.clock, self.free, self.waiting = clock, cores, collections.deque()
        self.seconds_per_byte = 8 / bits_per_s
        self.out_free_s = self.in_free_s = self.out_bytes = 0.0

    def offer(self, process):
        self.waiting.append(process)
        self.run()

    def run(self):
        while self.free and self.waiting:
            self.free -= 1
            process = self.waiting.popleft()
            cost_s, then = process.jobs.popleft()
            process.spent_s += cost_s
            self.clock.after(cost_s, self.finish, process, then)

    def finish(self, process, then):
        self.free += 1
        process.busy = False
        then()
        process.wake()
        self.run()


class Process:
    """Does one job after the other."""

    def __init__(self, host):
        self.host, self.jobs, self.busy, self.spent_s = host, collections.deque(), False, 0.0

    def work(self, cost_s, then):
        self.jobs.append((cost_s, then))
        self.wake()

    def wake(self):
        if not self.busy and self.jobs:
            self.busy = True
            self.host.offer(self)


class Clock:
    def __init__(self):
        self.now_s, self.events, self.count = 0.0, [], 0

    def after(self, delay_s, call, *arguments):
        self.count += 1
        heapq.heappush(self.events, (self.now_s + delay_s, self.count, call, arguments))

    def run(self):
        while self.events:
            self.now_s, _, call, arguments = heapq.heappop(self.events)
            call(*arguments)


class Simulation:
    def __init__(self, costs, network, ticks):
        self.costs, self.network, self.ticks = costs, network, ticks
        self.clock = Clock()
        spread = network.hosts > 1
        hosts = [self.host() for _ in range(network.hosts)]
        self.master = Process(self.host() if spread else hosts[0])
        self.broker = Process(self.host() if spread else hosts[0])
        self.orbit = Process(self.host() if spread else hosts[0])
        self.sensors = [Process(hosts[i % network.hosts]) for i in range(network.sensors)]
        self.agents = [Process(host) for host in hosts] if network.agents else []
        self.of_agent = [[i for i in range(network.sensors) if i % network.hosts == a]
                         for a in range(network.hosts)] if network.agents else []
        self.granted = -1
        self.orbit_done = -1
        self.finished = [0] * (ticks + 1)        # reports of a tick at the master
        self.finished_at_agent = collections.Counter()
        self.slowest = -1
        self.at_sensor = [[-1, -1, -1] for _ in self.sensors]  # granted, states here, begun
        self.done_s = []
        self.overruns, self.worst_lag_s = 0, 0.0

    def host(self):
        return Host(self.clock, self.network.cores, self.network.bits_per_s)

    def send(self, source, target, size, then, *arguments):
        """A message of so many bytes from one process to another."""
        a, b = source.host, target.host
        if a is b:
            return self.clock.after(0.0, then, *arguments)
        time_s = size * a.seconds_per_byte
        a.out_free_s = max(a.out_free_s, self.clock.now_s) + time_s
        a.out_bytes += size
        b.in_free_s = max(a.out_free_s, b.in_free_s + time_s)
        self.clock.after(b.in_free_s + self.network.delay_s - self.clock.now_s, then, *arguments)

    # The time-master: half of what a node costs it is hearing it, half telling it.
    def reporters(self):
        return len(self.agents) or len(self.sensors)

    def tell(self):
        limit = self.slowest + self.network.window_ticks
        if self.network.tick_s > 0:
            limit = min(limit, int(self.clock.now_s / self.network.tick_s + 1e-9))
        grant = min(limit, self.ticks - 1)
        if grant <= self.granted:
            return
        self.granted = grant
        cost_s = self.costs.master_s + 0.5 * self.costs.master_per_node_s * self.reporters()
        self.master.work(cost_s, lambda: self.told(grant))

    def told(self, grant):
        share = self.costs.node_bytes / 4
        self.send(self.master, self.orbit, share, self.at_orbit)
        if self.agents:
            for a, agent in enumerate(self.agents):
                self.send(self.master, agent, share, self.agent_told, a, grant)
        else:
            for i, sensor in enumerate(self.sensors):
                self.send(self.master, sensor, share, self.sensor_hears, i, 0, grant)

    def heard(self, tick):
        self.finished[tick] += 1
        while self.slowest + 1 < self.ticks and self.finished[self.slowest + 1] == self.reporters() + 1:
            self.slowest += 1
            self.done_s.append(self.clock.now_s)
            lag_s = self.clock.now_s - (self.slowest + 1) * self.network.tick_s
            if self.network.tick_s > 0 and lag_s > 0:
                self.overruns += 1
                self.worst_lag_s = max(self.worst_lag_s, lag_s)
        self.tell()

    def report(self, process, tick):
        self.send(process, self.master, self.costs.node_bytes / 4, self.master.work,
                  0.5 * self.costs.master_per_node_s, lambda: self.heard(tick))

    # The orbit node and the broker.
    def at_orbit(self):
        if self.orbit_done < self.granted:
            self.orbit_done += 1
            tick = self.orbit_done
            self.orbit.work(self.costs.orbit_s + self.costs.publish_s, lambda: self.published(tick))

    def published(self, tick):
        size = self.costs.state_bytes + self.costs.node_bytes / 4
        copies = self.reporters()
        cost_s = self.costs.broker_s + copies * (self.costs.copy_s + 0.5 * self.costs.broker_per_node_s)
        self.send(self.orbit, self.broker, size, self.broker.work, cost_s, lambda: self.passed_on(tick, size))
        self.report(self.orbit, tick)
        self.at_orbit()

    def passed_on(self, tick, size):
        if self.agents:
            for a, agent in enumerate(self.agents):
                self.send(self.broker, agent, size, self.agent_has_states, a, tick)
        else:
            for i, sensor in enumerate(self.sensors):
                self.send(self.broker, sensor, size, self.sensor_hears, i, 1, tick)

    # Sensor nodes.
    def sensor_hears(self, i, what, tick):
        at = self.at_sensor[i]
        at[what] = max(at[what], tick)
        self.begin(i)

    def begin(self, i):
        at, sensor = self.at_sensor[i], self.sensors[i]
        if sensor.busy or sensor.jobs or at[2] >= min(at[0], at[1]):
            return
        at[2] += 1
        tick = at[2]
        frame_s = self.network.frame_s if (tick + i) % self.network.frame_ticks == 0 else 0.0
        sensor.work(self.costs.sensor_s + self.costs.take_in_s + frame_s, lambda: self.made(i, tick))

    def made(self, i, tick):
        sensor = self.sensors[i]
        if self.agents:
            a = i % self.network.hosts
            self.agents[a].work(0.5 * self.costs.master_per_node_s, lambda: self.agent_heard(a, tick))
        else:
            self.report(sensor, tick)
        self.send(sensor, self.broker, self.costs.node_bytes / 4, self.broker.work,
                  0.5 * self.costs.broker_per_node_s, lambda: None)
        self.clock.after(0.0, self.begin, i)

    # Agents: to the master a node that takes part, to the sensors of their host master and broker.
    def agent_told(self, a, grant):
        cost_s = self.costs.master_s + 0.5 * self.costs.master_per_node_s * len(self.of_agent[a])
        self.agents[a].work(cost_s, lambda: [self.sensor_hears(i, 0, grant) for i in self.of_agent[a]])

    def agent_has_states(self, a, tick):
        cost_s = self.costs.sensor_s + len(self.of_agent[a]) * self.costs.copy_s
        self.agents[a].work(cost_s, lambda: [self.sensor_hears(i, 1, tick) for i in self.of_agent[a]])

    def agent_heard(self, a, tick):
        self.finished_at_agent[a, tick] += 1
        if self.finished_at_agent[a, tick] == len(self.of_agent[a]):
            self.report(self.agents[a], tick)

    def run(self):
        if self.network.tick_s > 0:
            for k in range(self.ticks):
                self.clock.after(k * self.network.tick_s, self.tell)
        self.tell()
        self.clock.run()
        if self.slowest + 1 != self.ticks:
            raise RuntimeError(f"the simulated run stopped after tick {self.slowest}")
        half = self.ticks // 2
        return Outcome(ticks_per_s=(self.ticks - half) / max(1e-12, self.done_s[-1] - self.done_s[half - 1]),
                       master_s=self.master.spent_s / self.ticks, broker_s=self.broker.spent_s / self.ticks,
                       broker_out_bytes=self.broker.host.out_bytes / self.ticks,
                       worst_lag_s=self.worst_lag_s, overruns=self.overruns)


def simulate(costs, network, ticks=24):
    """Runs `ticks` ticks of the network; returns an Outcome."""
    return Simulation(costs, network, ticks).run()
