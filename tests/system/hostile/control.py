"""Strangers who talk to the time-master: in floods, without reading, without end, in the names of others."""

import contextlib
import os
import resource
import socket
import struct

import zmq

from harness import check, wait_until
from hostile.case import case
from hostile.wire import node_pb2, time_pb2

LOG_MOST_BYTES = 100_000  # log of the time-master, whatever strangers say


def spoken(run_id=0, **body):
    return node_pb2.NodeMessage(run_id=run_id, **body).SerializeToString()


HELLO = spoken(hello=node_pb2.Hello())


def clock_moves(target):
    """The clock has gone on since the attack began to count."""
    now = target.hello().granted_tick
    target.wait_for_tick(min(now + 1, target.endpoints.last_tick))


def short_log(target):
    size = (target.out / "logs/time-master.log").stat().st_size
    check(size <= LOG_MOST_BYTES, f"the time-master's log has {size} bytes")


def raw(address, kind):
    """A connection that has shaken hands by ZMTP 3.0 (RFC 23) and keeps to no manners from then on."""
    host, port = address.removeprefix("tcp://").rsplit(":", 1)
    connection = socket.create_connection((host, int(port)), timeout=10)
    connection.sendall(b"\xff" + bytes(8) + b"\x7f\x03\x00NULL" + bytes(48))
    ready = b"\x05READY" + b"\x0bSocket-Type" + struct.pack(">I", len(kind)) + kind + b"\x08Identity" + bytes(4)
    connection.sendall(b"\x04" + bytes([len(ready)]) + ready)
    return connection


def frame(body, more=False):
    return (bytes([more, len(body)]) if len(body) < 256 else bytes([2 | more]) + struct.pack(">Q", len(body))) + body


def pour(connection, data, times):
    """Sends until it is done, the connection is closed, or nobody has read for 2 s. Returns how often it did."""
    connection.settimeout(2)
    for count in range(times):
        try:
            connection.sendall(data)
        except OSError:
            return count
    return times


@case("control", keys=True, late_s=5)
def flood_of_hello(target):
    """400,000 questions over one connection, whose answers are read."""
    master = target.socket(zmq.DEALER, target.address, sndhwm=0, rcvhwm=0)
    for _ in range(400_000):
        master.send(HELLO)
    check(target.ended() or master.poll(10_000), "who floods is answered")
    if not target.ended():
        clock_moves(target)


@case("control", keys=True, late_s=5)
def flood_of_hello_by_many(target):
    """1,000 questions over each of 100 connections."""
    peers = [target.socket(zmq.DEALER, target.address, sndhwm=0, rcvhwm=0) for _ in range(100)]
    for _ in range(1000):
        for peer in peers:
            peer.send(HELLO)
    if not target.ended():
        clock_moves(target)


@case("control", growth_mib=32)
def unread_answers(target):
    """Questions without end over four connections that read no answer."""
    with contextlib.ExitStack() as stack:
        for _ in range(4):
            pour(stack.enter_context(raw(target.address, b"DEALER")), frame(HELLO) * 1000, 100)


@case("control", growth_mib=160)
def message_without_end(target):
    """A message of more and more frames of 1 MiB: 1 GiB, if it were taken.

    The bound of memory is what a peer can send between two looks at its connection on a busy machine.
    """
    with raw(target.address, b"DEALER") as peer:
        poured = pour(peer, frame(bytes(1 << 20), more=True), 1000)
    check(poured < 200, f"whose connection was closed after {poured} MiB")
    with raw(target.endpoints.tick_endpoint, b"SUB") as peer:
        pour(peer, frame(b"\x01" + bytes(200), more=True) * 5000, 1000)


@case("control", growth_mib=160)
def messages_of_many_frames(target):
    """Messages of 100,000 empty frames, and of frames of 1 MiB: 2.4 GiB, if they were taken.

    ZeroMQ keeps 64 bytes for an empty frame, which is 2 on the way. The bound is as for a message without
    end.
    """
    for body, count in ((b"", 100_000), (bytes(1 << 20), 3)):
        with raw(target.address, b"DEALER") as peer:
            pour(peer, frame(body, more=True) * count + frame(b""), 400)


@case("control", growth_mib=32)
def subscriptions_without_end(target):
    """Long subscriptions to the clock, and many short ones."""
    with raw(target.endpoints.tick_endpoint, b"SUB") as peer:
        pour(peer, frame(b"\x01" + os.urandom(200_000)), 100)
    with raw(target.endpoints.tick_endpoint, b"SUB") as peer:
        for _ in range(100):
            if pour(peer, b"".join(frame(b"\x01" + os.urandom(200)) for _ in range(100)), 1) == 0:
                break


@case("control", growth_mib=32)
def unread_grants(target):
    """200 who subscribe to the clock and read nothing."""
    with contextlib.ExitStack() as stack:
        for _ in range(200):
            stack.enter_context(raw(target.endpoints.tick_endpoint, b"SUB")).sendall(frame(b"\x01"))
        target.wait_for_tick(target.endpoints.last_tick)


def ask_to_observe(target, name, consumes=()):
    peer = target.socket(zmq.DEALER, target.address)
    peer.send(spoken(join=node_pb2.Join(name=name, observer=True, consumes=consumes)))
    return peer


def answer_to(target, peer):
    """What the time-master answers; None when the run is over before."""
    wait_until(lambda: target.ended() or peer.poll(50), "an answer", 20)
    return time_pb2.MasterMessage.FromString(peer.recv()) if peer.poll(0) else None


@case("control", keys=True, late_s=5)
def observers_who_come_and_go(target):
    """1,600 observers, one after the other: nobody is listed afterwards."""
    name = "stranger" if target.keys else "watcher-{}"
    for i in range(1600):
        peer = ask_to_observe(target, name.format(i))
        answer = answer_to(target, peer)
        if answer is None:
            break
        if answer.HasField("welcome"):
            peer.send(spoken(answer.welcome.run_id, leave=node_pb2.Leave()))
            peer.close(100)
        else:
            peer.close(0)
    if not target.ended():
        wait_until(lambda: target.ended() or not [n for n in target.hello().nodes if n.observer],
                   "observers to be forgotten", 10)
    short_log(target)


@case("control", late_s=5)
def observers_who_stay(target):
    """200 observers of all topics at once: 64 are let in, the others are told why not."""
    topics = [topic for p in target.endpoints.publishers for topic in p.topics]
    peers = [ask_to_observe(target, f"watcher-{i}", topics) for i in range(200)]
    answers = [a for a in (answer_to(target, peer) for peer in peers) if a is not None]
    refused = {a.refuse.reason for a in answers if a.HasField("refuse")}
    if not target.ended():
        check(sum(n.observer for n in target.hello().nodes) <= 64, "at most 64 are listed")
        check(refused == {"64 observers have joined already: another may join when one leaves"}, f"told: {refused}")
        check({p.name for p in target.hello().publishers} == {p.name for p in target.endpoints.publishers},
              "none of them is among those who publish")


@case("control", late_s=5)
def connections_beyond_the_limit(target):
    """1,500 connections to a time-master that may have 1,024 files."""
    resource.prlimit(target.run.node("time-master"), resource.RLIMIT_NOFILE, (1024, 1024))
    with contextlib.ExitStack() as stack:
        host, port = target.address.removeprefix("tcp://").rsplit(":", 1)
        for _ in range(1500):
            with contextlib.suppress(OSError):
                stack.enter_context(socket.create_connection((host, int(port)), timeout=2))
        if not target.ended():
            clock_moves(target)


@case("control", keys=True, late_s=5)
def bad_joins(target):
    """20,000 joins of a node that the run does not have, and of one that has joined."""
    peer = target.socket(zmq.DEALER, target.address, sndhwm=0, rcvhwm=0)
    for i in range(20_000):
        peer.send(spoken(join=node_pb2.Join(name="alpha" if i % 2 else f"nobody-{i}")))
    check(target.ended() or peer.poll(10_000), "who joins in vain is told")
    if not target.ended():
        clock_moves(target)
    short_log(target)


@case("control", late_s=5)
def wishes_for_another_run(target):
    """The clock is asked to pause and to abort, under the numbers of other runs."""
    peer = target.socket(zmq.DEALER, target.address)
    for run_id in (0, target.endpoints.run_id ^ 1):
        for action in (node_pb2.Control.ACTION_PAUSE, node_pb2.Control.ACTION_ABORT):
            peer.send(spoken(run_id, control=node_pb2.Control(action=action)))
    clock_moves(target)


@case("control", keys=True, late_s=5)
def every_message_in_the_name_of_others(target):
    """Each kind of message, 10,000 times, as if from each node and from an agent, in and out of turn."""
    run_id, names = target.endpoints.run_id, [n.name for n in target.endpoints.nodes]
    times = node_pb2.TimeSplit(compute_s=1e6, frames=10**9, detections=10**9)
    peer = target.socket(zmq.DEALER, target.address, sndhwm=0, rcvhwm=0)
    for turn in range(10_000):
        name, tick = names[turn % len(names)], turn % 200
        tally = node_pb2.TopicTally(topic="state/objects", tick=tick, messages=1, last_sequence=10**9, digest=1)
        beat = node_pb2.NodeBeat(name=name, done_tick=tick, times=times)
        for body in (
            dict(ready=node_pb2.Ready()),
            dict(done=node_pb2.Done(tick=tick, published=[tally])),
            dict(heartbeat=node_pb2.Heartbeat(name=name, incarnation=1, token=turn, times=times, nodes=[beat], holding=[name])),
            dict(leave=node_pb2.Leave(interrupted=True, times=times, nodes=[beat])),
            dict(failed=node_pb2.Failed(reason="a stranger says so")),
            dict(node_news=node_pb2.NodeNews(what=1 + turn % 3, name=name, incarnation=1, reason="gone", done_tick=tick)),
            dict(join=node_pb2.Join(name=name, produces=["state/objects"])),
            dict(join=node_pb2.Join(name=f"agent-{turn}", agent=True)),
            dict(join=node_pb2.Join(name=name, host="agent-0")),
            dict(join=node_pb2.Join(name="broker", broker=node_pb2.Broker(publish_endpoint="tcp://127.0.0.1:1"))),
        ):
            peer.send(spoken(run_id, **body))
    if not target.ended():
        clock_moves(target)
        counted = {n.name: n.times.frames for n in target.hello().nodes}
        check(max(counted.values()) < 1000, f"nobody's frames are counted by strangers: {counted}")
    short_log(target)
