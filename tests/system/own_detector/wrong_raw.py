"""What no detector of the package says, by the messages themselves (docs/wire.md, Own nodes)."""
import json
import os
import threading

import zmq
from dmise.v1 import own_node_pb2

socket = zmq.Context().socket(zmq.PAIR)
socket.connect(os.environ["DMISE_OWN_NODE"])
FOUND = own_node_pb2.OwnNodeAnswer(found={}).SerializeToString()

while True:
    frames = socket.recv_multipart()
    request = own_node_pb2.OwnNodeRequest.FromString(frames[0])
    if request.HasField("end"):
        break
    if request.HasField("begin"):
        options = json.loads(request.begin.options_json)
        socket.send(own_node_pb2.OwnNodeAnswer(ready={}).SerializeToString())
        continue
    fault = options["fault"] if request.frame.frame == options.get("at", 2) else ""
    if len(frames) != 2 or len(frames[1]) != 2 * request.frame.rows * request.frame.columns:
        socket.send(own_node_pb2.OwnNodeAnswer(failed="the counts have another size").SerializeToString())
    elif fault == "rubbish":
        socket.send(b"\xff" * 1_000_000)
    elif fault == "two_frames":
        socket.send_multipart([FOUND, b"more"])
    elif fault == "ready":
        socket.send(own_node_pb2.OwnNodeAnswer(ready={}).SerializeToString())
    elif fault == "half_a_streak":
        source = {"centroid": {"x_px": 60, "y_px": 40, "var_x_px2": 1, "var_y_px2": 1}, "flux_e": 1, "snr": 1,
                  "end2": {"x_px": 1}}
        socket.send(own_node_pb2.OwnNodeAnswer(found={"sources": [source]}).SerializeToString())
    elif fault == "hangs_silently":
        threading.Event().wait()
    else:
        socket.send(FOUND)
