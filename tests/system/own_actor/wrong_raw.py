"""What no program of the package says, by the messages themselves (docs/wire.md, Own nodes)."""
import json
import os
import time

import numpy as np
import zmq
from dmise.v1 import own_node_pb2, state_pb2

socket = zmq.Context().socket(zmq.PAIR)
socket.connect(os.environ["DMISE_OWN_NODE"])


def stepped(step, fault):
    tick = step.tick - 1 if fault == "past" else step.tick
    time_ns = (tick - 10 * (fault == "late")) * 1_000_000_000
    count = 2 if fault == "two_objects" else 1
    states = state_pb2.ObjectStates(tick=tick, time_ns=time_ns, count=count)
    arrays = b""
    place = np.array([[7178112.0], [-2810.0], [18581.0 + 7368.0 * tick]]).repeat(count, 1)
    speed = np.array([[0.0], [0.0], [7368.0]]).repeat(count, 1)
    values = {"position_m": place, "slope_m_per_s": speed, "velocity_m_per_s": speed, "code": np.zeros(count, np.uint8)}
    if fault == "turned":
        values |= {"attitude_object": np.zeros(1, np.uint32), "gcrs_from_body": np.array([[1.0], [0.0], [0.0], [0.0]]),
                   "attitude_rate_rad_per_s": np.zeros((3, 1))}
    for name, array in values.items():
        states.arrays.add(name=name, type=str(array.dtype), shape=array.shape, offset_bytes=len(arrays))
        arrays += array.tobytes()
    frames = [own_node_pb2.OwnNodeAnswer(stepped={}).SerializeToString(), states.SerializeToString(), arrays]
    return frames[:2] if fault == "two_frames" else frames


while True:
    request = own_node_pb2.OwnNodeRequest.FromString(socket.recv_multipart()[0])
    if request.HasField("end"):
        break
    if request.HasField("begin"):
        options = json.loads(request.begin.options_json)
        socket.send(own_node_pb2.OwnNodeAnswer(ready={}).SerializeToString())
        continue
    fault = options["fault"] if request.step.tick == options.get("at", 3) else ""
    if fault == "rubbish":
        socket.send(np.random.default_rng(1).bytes(1_000_000))
    if fault == "hangs_silently":
        time.sleep(60)
    socket.send_multipart(stepped(request.step, fault))
