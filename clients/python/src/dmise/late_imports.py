"""Imports that are made when their names are used.

A process that is forked while another thread imports a module would wait for that thread, which it does not have:
    with importing:
        from .engine import core
lets a fork wait until the import has ended.
"""
import os
import threading

importing = threading.RLock()

if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=importing.acquire, after_in_parent=importing.release, after_in_child=importing.release)
