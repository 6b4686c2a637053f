"""What no tracker of the package says, by the messages themselves (docs/wire.md, Own nodes)."""
import json
import os
import threading

import zmq
from dmise.v1 import own_node_pb2, track_pb2

socket = zmq.Context().socket(zmq.PAIR)
socket.connect(os.environ["DMISE_OWN_NODE"])
TRACKED = own_node_pb2.OwnNodeAnswer(tracked={}).SerializeToString()

while True:
    frames = socket.recv_multipart()
    request = own_node_pb2.OwnNodeRequest.FromString(frames[0])
    if request.HasField("end"):
        break
    if request.HasField("begin"):
        wanted = json.loads(request.begin.options_json)["fault"]
        socket.send(own_node_pb2.OwnNodeAnswer(ready={}).SerializeToString())
        continue
    tick, time_ns = request.track.tick, request.track.time_ns
    fault = wanted if tick == 3 else ""
    if len(frames) % 2 != 0:
        socket.send(own_node_pb2.OwnNodeAnswer(failed="reports and detections are not in pairs").SerializeToString())
    elif fault == "rubbish":
        socket.send(b"\xff" * 1_000_000)
    elif fault == "one_frame":
        socket.send(TRACKED)
    elif fault == "ready":
        socket.send(own_node_pb2.OwnNodeAnswer(ready={}).SerializeToString())
    elif fault == "no_tracks":
        socket.send_multipart([TRACKED, b"\xff" * 1000])
    elif fault == "past":
        socket.send_multipart([TRACKED, track_pb2.TrackSet(tick=2, time_ns=2_000_000_000).SerializeToString()])
    elif fault == "hangs_silently":
        threading.Event().wait()
    else:
        socket.send_multipart([TRACKED, track_pb2.TrackSet(tick=tick, time_ns=time_ns).SerializeToString()])
