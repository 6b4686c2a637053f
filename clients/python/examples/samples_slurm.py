#!/usr/bin/env python3
"""Samples that each task of a Slurm array makes for itself: here it keeps how bright the brightest object of each frame is.

    sbatch --array=1-10 --wrap "python3 samples_slurm.py dataset.yaml 1 5000 out"
"""
import json
import os
import pathlib
import sys

from dmise.datasets import stream

scenario, first, last, out = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), pathlib.Path(sys.argv[4])
task, tasks = int(os.environ["SLURM_ARRAY_TASK_ID"]), int(os.environ["SLURM_ARRAY_TASK_COUNT"])
task -= int(os.environ["SLURM_ARRAY_TASK_MIN"])
found = {}
for sample in stream(scenario, range(first + task, last + 1, tasks)):
    found[sample.key] = max((it["snr"] for it in sample.objects), default=0.0), int(sample.image.max())
out.mkdir(parents=True, exist_ok=True)
(out / f"brightest-{task}.json").write_text(json.dumps(found))
