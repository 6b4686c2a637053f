#!/usr/bin/python3
"""A node of a run in Python: takes part in the clock and counts the detections of each tick.

Usage: PYTHONPATH=build/python node.py MASTER_ADDRESS NAME TOPIC...
NAME must be one of those that the time-master expects. docs/wire.md explains every step.
"""
import sys
import threading
import zmq
from dmise.v1 import detection_pb2, node_pb2, time_pb2

address, name, topics = sys.argv[1], sys.argv[2], sys.argv[3:]
context = zmq.Context()


def tell(socket, **body):
    socket.send(node_pb2.NodeMessage(run_id=welcome.run_id, **body).SerializeToString())


def heartbeats():
    socket = context.socket(zmq.DEALER)
    socket.connect(address)
    heartbeat = node_pb2.Heartbeat(name=name, incarnation=welcome.incarnation, token=welcome.heartbeat_token)
    while not over.wait(welcome.heartbeat_s):
        tell(socket, heartbeat=heartbeat)
        while socket.poll(0):
            socket.recv()  # the grant once more; this node trusts the published one
    socket.close(0)


# 1. Join.
master = context.socket(zmq.DEALER)
master.connect(address)
join = node_pb2.Join(name=name, consumes=topics)
master.send(node_pb2.NodeMessage(join=join).SerializeToString())
answer = time_pb2.MasterMessage.FromString(master.recv())
if answer.HasField("refuse"):
    sys.exit(answer.refuse.reason)
welcome = answer.welcome
over = threading.Event()
threading.Thread(target=heartbeats, daemon=True).start()

# 2. Connect to the clock, and to the data when all have joined.
ticks = context.socket(zmq.SUB)
ticks.connect(welcome.tick_endpoint)
ticks.subscribe("")
topology = time_pb2.MasterMessage.FromString(master.recv()).topology
data = context.socket(zmq.SUB)
data.set_hwm(0)
if topology.broker_password:  # without keys: only nodes of the run are told
    data.plain_username, data.plain_password = name.encode(), topology.broker_password.encode()
data.connect(topology.subscribe_endpoint)
for topic in topics:
    data.subscribe(topic)

# 3. Process a tick when it is granted and every topic is complete for it.
granted, next_tick, ready, heard_ticks = -1, 0, False, False
complete = {topic: None for topic in topics}  # last tick; None: not even a probe
found = {}                                    # detections by tick
phase = time_pb2.PHASE_CONNECTING
while phase not in (time_pb2.PHASE_ENDED, time_pb2.PHASE_FAILED):
    zmq.select([ticks, data], [], [])
    while ticks.poll(0):
        grant = time_pb2.Grant.FromString(ticks.recv())
        granted, phase, heard_ticks = max(granted, grant.tick), grant.phase, True
    while data.poll(0):
        frames = data.recv_multipart()
        topic, envelope = frames[0].decode(), node_pb2.Envelope.FromString(frames[1])
        if topic not in complete:
            continue  # only begins like one of ours
        if complete[topic] is None:
            complete[topic] = -1
        if envelope.kind == node_pb2.KIND_DETECTION_SET:
            count = len(detection_pb2.DetectionSet.FromString(frames[2]).detections)
            found[envelope.tick] = found.get(envelope.tick, 0) + count
        if envelope.last_of_tick:
            complete[topic] = envelope.tick
    if not ready and heard_ticks and None not in complete.values():
        tell(master, ready=node_pb2.Ready())
        ready = True
    while ready and next_tick <= min([granted, *complete.values()]):
        print("tick", next_tick, found.pop(next_tick, 0), "detections", flush=True)
        tell(master, done=node_pb2.Done(tick=next_tick))
        next_tick += 1

# 4. Leave.
tell(master, leave=node_pb2.Leave())
over.set()
master.close(1000)
sys.exit(0 if phase == time_pb2.PHASE_ENDED else grant.cause)
