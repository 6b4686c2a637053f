"""Which topics a subscription is for."""
from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence

KINDS = ("state/", "env/", "frame/", "detection/", "track/", "task/", "truth/")  # topics of DMISE's own nodes


def is_wanted(wanted: Sequence[str], topic: str) -> bool:
    """Whether one of `wanted` stands for the topic: "detection/" is all that begins so, "" is all but truth."""
    return any(topic.startswith(each) if each.endswith("/") else topic == each or not each and not topic.startswith("truth/")
               for each in wanted)


def did_you_mean(word: str, names: Iterable[str]) -> str:
    """", did you mean 'NAME'?" with the nearest name, for the end of a message; "" if none is near."""
    near = difflib.get_close_matches(word, sorted(names), 1)
    return f", did you mean {near[0]!r}?" if near else ""


def check_published(wanted: Sequence[str], published: Iterable[str]) -> None:
    """Raises ValueError with a suggestion for a topic that is neither published nor a kind that a run may lack."""
    topics = set(published)
    for each in wanted:
        if not each or each in KINDS or any(is_wanted([each], topic) for topic in topics):
            continue
        known = {*KINDS, *topics, *(topic[:topic.rindex("/") + 1] for topic in topics if "/" in topic)}
        raise ValueError(f"topic {each!r}: nobody publishes it{did_you_mean(each, known)}")
