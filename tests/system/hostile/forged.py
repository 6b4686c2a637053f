"""Messages in the name of the run's nodes, sent to whatever port takes them: every kind on every topic."""

import time

import zmq

from harness import check
from hostile.case import case
from hostile.memory import title
from hostile.ports import listening
from hostile.wire import node_pb2, resealed, sealed, state_pb2, time_pb2

MOST_HEARD = 100  # at one look: the run's nodes pass on what is forged, so that the forger hears itself
KINDS = [value for name, value in node_pb2.Kind.items() if name != "KIND_UNSPECIFIED"]
FAR = 10**9


class Forger:
    """Speaks to all who publish or pass on, and hears what an observer may hear."""

    def __init__(self, target):
        self.target = target
        self.sockets = [target.socket(kind, f"tcp://127.0.0.1:{port}", title(pid), sndhwm=1000)
                        for pid, port in listening(target.run.living()) for kind in (zmq.PUB, zmq.XSUB)]
        self.heard = target.socket(zmq.SUB, target.endpoints.observe_endpoint, "broker")
        self.heard.subscribe("")
        self.last = target.endpoints.last_tick
        self.said = 0
        time.sleep(0.3)  # shakes hands; what is said before is lost, and said again

    def topics(self):
        """(publisher, topic) of the whole run."""
        return [(p, topic) for p in self.target.endpoints.publishers for topic in (*p.topics, *p.direct_topics)]

    def send(self, frames):
        for socket in self.sockets:
            try:
                socket.send_multipart(frames, zmq.NOBLOCK)
                self.said += 1
            except zmq.Again:
                pass  # nobody takes it there

    def forge(self, publisher, topic, payload=b"", **fields):
        tick = fields.get("tick", 0)
        facts = dict(run_id=self.target.endpoints.run_id, publisher=publisher.name, sequence=1,
                     incarnation=publisher.incarnation, time_ns=tick * self.target.endpoints.tick_ns)
        self.send(sealed(topic, payload, **(facts | fields)))

    def hear(self):
        """Messages that an observer has heard since, `MOST_HEARD` at most."""
        messages = []
        while len(messages) < MOST_HEARD and self.heard.poll(1):
            messages.append(self.heard.recv_multipart())
        return messages

    def while_running(self):
        """The tick that is granted, again and again until two thirds of the run are over."""
        while not self.target.ended():
            now = self.target.hello().granted_tick
            if now >= 2 * self.last // 3:
                return
            yield now
            time.sleep(0.02)

    def done(self):
        check(self.said > 0, f"{self.said} messages are forged")


@case("forged", keys=True)
def position_jump(target):
    """A POSITION far ahead and the watermark of the last tick, on each topic in its publisher's name."""
    forger = Forger(target)
    for now in forger.while_running():
        for publisher, topic in forger.topics():
            forger.forge(publisher, topic, kind=node_pb2.KIND_POSITION, sequence=FAR, tick=now + 1)
            forger.forge(publisher, topic, kind=node_pb2.KIND_WATERMARK, sequence=FAR, tick=forger.last,
                         last_of_tick=True)
    forger.done()


@case("forged", keys=True)
def every_kind(target):
    """Every kind on every topic, empty or with another's content, of past, present and future ticks and numbers."""
    forger = Forger(target)
    for now in forger.while_running():
        contents = {node_pb2.Envelope.FromString(m[1]).kind: m for m in forger.hear()}
        for publisher, topic in forger.topics():
            for kind in KINDS:
                for tick, sequence in ((now, now + 1), (now + 1, now + 2), (0, 1), (forger.last, FAR)):
                    content = contents.get(kind)
                    payload = content[2] if content else b""
                    forger.forge(publisher, topic, payload, kind=kind, tick=tick, sequence=sequence, last_of_tick=True)
    forger.done()


@case("forged", keys=True)
def other_content(target):
    """What was heard again under the next numbers and ticks, with objects and Sun elsewhere."""
    forger = Forger(target)
    for now in forger.while_running():
        for message in forger.hear():
            envelope = node_pb2.Envelope.FromString(message[1])
            for ahead in range(6):
                tick = min(envelope.tick + ahead, forger.last)
                fields = dict(tick=tick, time_ns=tick * target.endpoints.tick_ns, sequence=envelope.sequence + ahead)
                forger.send(resealed(moved(message, envelope, fields), **fields))
    forger.done()


def moved(message, envelope, fields):
    """The message with other numbers, where they can be changed and still be valid."""
    if envelope.kind != node_pb2.KIND_OBJECT_STATES:
        return message
    states = state_pb2.ObjectStates.FromString(message[2])
    for name in ("tick", "time_ns"):
        if hasattr(states, name):
            setattr(states, name, fields[name])
    arrays = bytearray(message[3])
    half = len(arrays) // 4
    arrays[:8 * (half // 8)] = bytes(8 * (half // 8))  # where the first objects are
    return [message[0], message[1], states.SerializeToString(), bytes(arrays)]


@case("forged", keys=True)
def control_on_data_sockets(target):
    """Grants, topologies, manifests and the ends of runs, sent to whoever listens to data."""
    forger = Forger(target)
    run_id = target.endpoints.run_id
    grant = time_pb2.Grant(run_id=run_id, tick=forger.last, phase=time_pb2.PHASE_ENDED)
    words = [grant.SerializeToString(),
             time_pb2.MasterMessage(grant=grant).SerializeToString(),
             time_pb2.MasterMessage(topology=time_pb2.Topology(running=True)).SerializeToString(),
             node_pb2.NodeMessage(run_id=run_id, failed=node_pb2.Failed(reason="forged")).SerializeToString(),
             node_pb2.ResendRequest(run_id=run_id, topic="env/common", catch_up=True).SerializeToString()]
    for _ in forger.while_running():
        for word in words:
            for frames in ([word], [b"env/common", word, b""], [b"", word]):
                forger.send(frames)
    forger.done()


@case("forged", keys=True)
def answers_nobody_asked_for(target):
    """What publishers have answered to a stranger's questions, and a roster of others, said again to everybody."""
    forger = Forger(target)
    sockets = [(p, topic, target.socket(zmq.DEALER, p.resend_endpoint, p.name))
               for p in target.endpoints.publishers if p.resend_endpoint for topic in p.topics]
    for _ in forger.while_running():
        for publisher, topic, socket in sockets:
            socket.send(node_pb2.ResendRequest(run_id=target.endpoints.run_id, topic=topic,
                                               catch_up=True).SerializeToString())
            while socket.poll(1):
                message = socket.recv_multipart()
                forger.send(message)
                envelope = node_pb2.Envelope.FromString(message[1])
                if envelope.kind == node_pb2.KIND_POSITION:
                    forger.send(resealed(message, sequence=envelope.sequence + 5))
        for publisher, topic in forger.topics():
            roster = state_pb2.ObjectRoster().SerializeToString()
            forger.forge(publisher, topic, roster, kind=node_pb2.KIND_OBJECT_ROSTER, tick=0, sequence=1)
    forger.done()
