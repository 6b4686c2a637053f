"""Which topics a subscription is for."""
from __future__ import annotations

from collections.abc import Sequence


def is_wanted(wanted: Sequence[str], topic: str) -> bool:
    """Whether one of `wanted` stands for the topic: "detection/" is all that begins so, "" is all but truth."""
    return any(topic.startswith(each) if each.endswith("/") else topic == each or not each and not topic.startswith("truth/")
               for each in wanted)
