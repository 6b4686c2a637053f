"""Questions to the resend endpoints of publishers: too many, too long, without an end, and answers that nobody reads."""

import time

import zmq

from hostile.case import case
from hostile.raw import connect, pour
from hostile.wire import frame_pb2, node_pb2

ATTACK_S = 3.0


def askers(target, **options):
    """(topic, a socket connected to who publishes it and answers for it), for each publisher."""
    return [(topic, target.socket(zmq.DEALER, p.resend_endpoint, p.name, **options))
            for p in target.endpoints.publishers if p.resend_endpoint for topic in list(p.topics)[:1]]


def question(target, topic, **fields):
    return node_pb2.ResendRequest(run_id=target.endpoints.run_id, topic=topic, **fields).SerializeToString()


@case("questions", keys=True, growth_mib=100)
def unread_answers(target):
    """Asks everybody for all that they keep, time and again, and reads nothing."""
    sockets = askers(target, rcvhwm=1, rcvbuf=4096)
    began = time.monotonic()
    while time.monotonic() - began < ATTACK_S and not target.ended():
        for topic, socket in sockets:
            for _ in range(10):
                socket.send(question(target, topic, catch_up=True))
        time.sleep(0.001)


@case("questions", keys=True, growth_mib=100)
def flood_of_questions(target):
    """Asks as fast as it can, for topics that are there and for others."""
    sockets = askers(target, sndhwm=1000)
    began, i = time.monotonic(), 0
    while time.monotonic() - began < ATTACK_S and not target.ended():
        for topic, socket in sockets:
            for _ in range(50):
                i += 1
                try:
                    socket.send(question(target, topic if i % 2 else f"no/{i}", from_sequence=1), zmq.NOBLOCK)
                except zmq.Again:
                    break
        time.sleep(0.0005)


@case("questions", growth_mib=200)
def endless_question(target):
    """One message of small frames without end, to each publisher."""
    ports = [int(p.resend_endpoint.rsplit(":", 1)[1]) for p in target.endpoints.publishers if p.resend_endpoint]
    sent, cut = pour([connect(port, b"DEALER") for port in ports], ATTACK_S)
    print(f"{sent >> 20} MiB sent, {cut} connections cut")


@case("questions", keys=True)
def long_question(target):
    """Questions of 1 MB, and what is no question."""
    sockets = askers(target)
    for size in (1_000_000, 4_000, 3):
        for topic, socket in sockets:
            socket.send(question(target, topic, from_sequence=1) + b"\xff" * size)
            socket.send(question(target, "x" * size, from_sequence=1))
            socket.send_multipart([b"x" * min(size, 4000)] * 20)
    time.sleep(1.0)


def frame_readers(target, **options):
    return [target.socket(zmq.DEALER, p.frames_endpoint, p.name, **options)
            for p in target.endpoints.publishers if p.frames_endpoint]


def frame_request(target, **which):
    return frame_pb2.FrameRequest(run_id=target.endpoints.run_id, **which).SerializeToString()


@case("questions", keys=True, growth_mib=100)
def unread_frames(target):
    """Asks sensors for frames, over many connections time and again, and reads nothing."""
    sockets = [socket for _ in range(20) for socket in frame_readers(target, rcvhwm=1, rcvbuf=4096, sndhwm=1000)]
    began, i = time.monotonic(), 0
    while time.monotonic() - began < ATTACK_S and not target.ended():
        for socket in sockets:
            i += 1
            try:
                socket.send(frame_request(target, frame=1 + i % 20), zmq.NOBLOCK)
                socket.send(frame_request(target, latest_after=0), zmq.NOBLOCK)
            except zmq.Again:
                pass
        time.sleep(0.001)


@case("questions", growth_mib=100)
def rubbish_for_frames(target):
    """What is no request for a frame: bytes, long ones, many frames, and one without an end."""
    sockets = frame_readers(target)
    for size in (1_000_000, 4_000, 3):
        for socket in sockets:
            socket.send(b"\xff" * size)
            socket.send(frame_request(target, frame=0) + b"\xff" * size)
            socket.send_multipart([b"x" * min(size, 4000)] * 20)
    ports = [int(p.frames_endpoint.rsplit(":", 1)[1]) for p in target.endpoints.publishers if p.frames_endpoint]
    sent, cut = pour([connect(port, b"DEALER") for port in ports], ATTACK_S)
    print(f"{sent >> 20} MiB sent, {cut} connections cut")
