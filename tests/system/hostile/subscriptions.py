"""Subscriptions and other messages to sockets that publish: the broker's, the clock's, those for truth, the agents'."""

import time

import zmq

from hostile.case import case
from hostile.memory import title
from hostile.ports import listening
from hostile.raw import connect, pour

ATTACK_S = 3.0


def server_key_of(name):
    """Whose key a process proves itself by."""
    return {"broker": "broker", "time-master": "time-master"}.get(name, name)


def everywhere(target, kind, **options):
    """A socket of this kind connected to each port of the run."""
    return [target.socket(kind, f"tcp://127.0.0.1:{port}", server_key_of(title(pid)), **options)
            for pid, port in listening(target.run.living())]


def observed(target, kind, **options):
    return target.socket(kind, target.endpoints.observe_endpoint, "broker", **options)


def subscribe_and_go(sockets_of, size):
    """What a child does: subscribes to a long topic, and is gone."""
    def attack(target):
        for socket in sockets_of(target, zmq.SUB):
            socket.subscribe(b"x" * size)
        time.sleep(1.0)
    return attack


@case("subscriptions", keys=True)
def long_subscription(target):
    """Topics of 200 kB and 4 MB at the broker, and away: their removal walks the topic by recursion."""
    for size in (200_000, 4_000_000):
        target.in_child(subscribe_and_go(lambda *who: [observed(*who)], size))


@case("subscriptions", keys=True, growth_mib=100)
def long_subscription_everywhere(target):
    """Topics of 200 kB at every port of the run, and away."""
    target.in_child(subscribe_and_go(everywhere, 200_000))


@case("subscriptions", hosts=2, keys=True, growth_mib=100)
def long_subscription_at_agents(target):
    """Topics of 200 kB at every port of a run behind agents, and away."""
    target.in_child(subscribe_and_go(everywhere, 200_000))


@case("subscriptions", keys=True, growth_mib=150)
def many_subscriptions(target):
    """Topics of 200 bytes without end, to everybody who publishes."""
    sockets = everywhere(target, zmq.SUB)
    began, i = time.monotonic(), 0
    while time.monotonic() - began < ATTACK_S and not target.ended():
        for socket in sockets:
            for _ in range(100):
                socket.subscribe(f"{i:020d}".encode() + b"x" * 180)
                i += 1


@case("subscriptions", keys=True, growth_mib=150)
def messages_to_publishers(target):
    """Messages against the stream, to everybody who publishes: nobody hears them."""
    sockets = everywhere(target, zmq.XSUB, sndhwm=1000)
    began = time.monotonic()
    while time.monotonic() - began < ATTACK_S and not target.ended():
        for socket in sockets:
            for _ in range(100):
                socket.send(b"\x02" + b"x" * 900)
        time.sleep(0.001)


@case("subscriptions", growth_mib=200)
def endless_message_to_publishers(target):
    """One message of small frames without end to every port, from who says to be a subscriber."""
    ports = [port for _, port in listening(target.run.living())]
    sent, cut = pour([connect(port, b"SUB") for port in ports], ATTACK_S)
    print(f"{sent >> 20} MiB sent, {cut} connections cut")
