#!/usr/bin/python3
"""Prints every detection of a run. Usage: PYTHONPATH=build/python subscriber.py MASTER_ADDRESS"""
import sys
import zmq
from dmise.v1 import detection_pb2, node_pb2, time_pb2

context = zmq.Context()
master = context.socket(zmq.DEALER)
master.connect(sys.argv[1])
broker = ""
while not broker:  # it may still be starting
    master.send(node_pb2.NodeMessage(hello=node_pb2.Hello()).SerializeToString())
    broker = time_pb2.MasterMessage.FromString(master.recv()).endpoints.observe_endpoint
detections = context.socket(zmq.SUB)
detections.connect(broker)
detections.subscribe("detection/")
while True:
    topic, envelope, payload = detections.recv_multipart()
    for d in detection_pb2.DetectionSet.FromString(payload).detections:
        print(d.id, d.time_ns / 1e9, "s", d.ra_rad, d.dec_rad, "rad", d.magnitude, d.band, flush=True)
