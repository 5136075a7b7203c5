"""Stands for the kernel of a notebook: the frames of a session as lines of base64 on the standard
output; lines of the standard input are messages of notebook.js."""

import base64
import json
import sys

import heliograph
from heliograph.widget import LiveFrames


def show(frame):
    print(base64.b64encode(frame.data).decode(), flush=True)


live = LiveFrames(heliograph.connect(sys.argv[1]), show)
for line in sys.stdin:
    live.receive(json.loads(line))
live.close()
