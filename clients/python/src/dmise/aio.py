"""Observing a run in asyncio: `async for detection in dmise.aio.subscribe(address, "detection/")`."""
from __future__ import annotations

import asyncio
import concurrent.futures
import functools
from collections.abc import AsyncIterator
from typing import Any

from . import frame_images, subscription
from .message import Message


def subscribe(address: str, *topics: str, **options: Any) -> "AsyncSubscription":
    """As `dmise.subscribe`, whose options and errors it has; it connects when the iteration begins."""
    return AsyncSubscription(functools.partial(subscription.subscribe, address, *topics, **options))


async def frames(address: str | None, *sensors: str, **options: Any) -> AsyncIterator[frame_images.Frame]:
    """As `dmise.frames`, whose options and errors it has: `async for frame in dmise.aio.frames(address)`."""
    loop = asyncio.get_running_loop()
    with concurrent.futures.ThreadPoolExecutor(1, "dmise") as thread:  # sockets belong to one thread
        source = await loop.run_in_executor(thread, functools.partial(frame_images.frames, address, *sensors, **options))
        iterator = iter(source)
        try:
            while (frame := await loop.run_in_executor(thread, next, iterator, None)) is not None:
                yield frame
        finally:
            source.close()
            thread.submit(lambda: next(iterator, None))


class AsyncSubscription:
    """A `Subscription` in a thread of its own (`.subscription`, once it has begun)."""

    def __init__(self, begin: Any) -> None:
        self._begin = begin
        self.subscription: subscription.Subscription | None = None

    async def __aiter__(self) -> AsyncIterator[Any]:
        async for message in self.messages():
            for record in self.subscription.records_of(message):  # type: ignore[union-attr]
                yield record

    async def messages(self) -> AsyncIterator[Message]:
        """Messages with content, until the run is over."""
        loop = asyncio.get_running_loop()
        with concurrent.futures.ThreadPoolExecutor(1, "dmise") as thread:  # sockets belong to one thread
            source: subscription.Subscription = await loop.run_in_executor(thread, self._begin)
            self.subscription = source
            try:
                while not source.over:
                    message = await loop.run_in_executor(thread, source.receive, 1.0)
                    if message is not None and message.has_content:
                        yield message
                source.raise_failure()
            finally:
                source.close()
                thread.submit(source.receive, 0.0)
