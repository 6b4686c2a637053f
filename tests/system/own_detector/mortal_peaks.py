"""The detector of the examples, which ends itself in frames of `options`, each once: what it lived through is in a file."""
import os
import pathlib
import signal

import detector
import dmise


@dmise.detector
def find(frame, options):
    lives = pathlib.Path(f"{options['lives']}-{frame.sensor}")
    lives.touch()
    lived = len(lives.read_text())
    if lived < len(options["ends"]) and frame.number == options["ends"][lived]:
        lives.write_text((lived + 1) * "x")
        os.kill(os.getpid(), getattr(signal, options["how"][lived]))
    return detector.find(frame, options)


dmise.serve(find)
