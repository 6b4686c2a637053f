"""What no sensor of the package says, by the messages themselves (docs/wire.md, Own nodes)."""
import json
import os
import threading

import zmq
from dmise.v1 import environment_pb2, own_node_pb2, state_pb2

socket = zmq.Context().socket(zmq.PAIR)
socket.connect(os.environ["DMISE_OWN_NODE"])


def observed(frame, **more):
    return own_node_pb2.OwnNodeAnswer(observed={"frame": frame, **more}).SerializeToString()


while True:
    frames = socket.recv_multipart()
    request = own_node_pb2.OwnNodeRequest.FromString(frames[0])
    if request.HasField("end"):
        break
    if request.HasField("begin"):
        options = json.loads(request.begin.options_json)
        observing = request.begin.observing
        roster = state_pb2.ObjectRoster.FromString(frames[1])
        right = observing.truth and observing.sensor.name == "ranger" and observing.sensor.HasField("site") and len(frames) == 3
        if not right or [one.name for one in roster.objects] != ["newcomer", "watcher"]:
            socket.send(own_node_pb2.OwnNodeAnswer(failed=f"it is told something else: {observing}").SerializeToString())
            break
        socket.send(own_node_pb2.OwnNodeAnswer(ready={}).SerializeToString())
        continue
    asked = request.observe
    fault = options["fault"] if asked.frame == 2 else ""
    environment = environment_pb2.EnvironmentState.FromString(frames[1])
    states = state_pb2.ObjectStates.FromString(frames[2])
    if len(frames) != 4 or environment.time_ns != asked.middle_ns or states.count != 2 or states.time_ns != asked.middle_ns:
        socket.send(own_node_pb2.OwnNodeAnswer(failed="the states are others").SerializeToString())
    elif fault == "rubbish":
        socket.send(b"\xff" * 1_000_000)
    elif fault == "two_frames":
        socket.send_multipart([observed(asked.frame), b"more"])
    elif fault == "ready":
        socket.send(own_node_pb2.OwnNodeAnswer(ready={}).SerializeToString())
    elif fault == "another_frame":
        socket.send(observed(7))
    elif fault == "half_a_covariance":
        socket.send(observed(asked.frame, sightings=[{"time_ns": asked.middle_ns, "covariance_rad2": [1e-9, 1e-9]}]))
    elif fault == "no_boresight":
        socket.send(observed(asked.frame, boresight_dec_rad=float("nan")))
    elif fault == "hangs_silently":
        threading.Event().wait()
    else:
        socket.send(observed(asked.frame))
