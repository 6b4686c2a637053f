"""Messages that are sent to the broker in the name of one of the run's nodes."""

import zmq

from hostile.case import case
from hostile.wire import node_pb2, sealed


def forger(target):
    """A socket that publishes to the broker, if the broker lets it."""
    socket = target.socket(zmq.PUB, target.endpoints.broker.publish_endpoint, "broker", sndhwm=0)
    target.connected(socket)
    return socket


def envelope_of(target, publisher, **fields):
    known = target.publisher(publisher)
    facts = dict(run_id=target.endpoints.run_id, publisher=publisher, incarnation=known.incarnation)
    tick = fields.get("tick", 0)
    return facts | dict(time_ns=tick * target.endpoints.tick_ns) | fields


@case("forged", plain=False, keys=True)
def position_jump(target):
    """A POSITION far ahead and the watermark of the last tick, on env/common in the environment node's name."""
    socket, last = forger(target), target.endpoints.last_tick
    far = 10**9
    while not target.ended():
        now = target.hello().granted_tick
        socket.send_multipart(sealed("env/common", **envelope_of(
            target, "environment-node", kind=node_pb2.KIND_POSITION, sequence=far, tick=now + 1)))
        socket.send_multipart(sealed("env/common", **envelope_of(
            target, "environment-node", kind=node_pb2.KIND_WATERMARK, sequence=far, tick=last, last_of_tick=True)))
        if target.run.process.poll() is not None or now >= last // 2:
            break
