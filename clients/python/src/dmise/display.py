"""What notebooks show of frames, tables and runs, and bars of progress."""
from __future__ import annotations

import html
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, TypeVar

import numpy as np

MOST_ROWS = 10
Item = TypeVar("Item")


def table_html(names: Sequence[str], rows: Iterable[Sequence[Any]], caption: str = "") -> str:
    """An HTML table, which scrolls if it is wide. All texts are escaped."""
    head = "".join(f"<th>{html.escape(name)}</th>" for name in names)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(text_of_value(value))}</td>" for value in row) + "</tr>" for row in rows)
    below = f"<p>{html.escape(caption)}</p>" if caption else ""
    return f'<div style="overflow-x: auto"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>{below}'


def text_of_value(value: Any) -> str:
    """Seven digits of a number, each of a list."""
    if isinstance(value, (float, np.floating)):
        return f"{value:.7g}"
    if isinstance(value, np.ndarray):
        return ", ".join(map(text_of_value, value.ravel()))
    return str(value)


def with_progress(items: Iterator[Item], total: int) -> Iterator[Item]:
    """The items, with a bar of tqdm that ends with them."""
    try:
        from tqdm.auto import tqdm
    except ImportError:
        raise ImportError("tqdm: not installed; progress=True needs it: pip install tqdm", name="tqdm") from None
    return _counted(items, tqdm(total=total, unit="frame"))


def _counted(items: Iterator[Item], bar: Any) -> Iterator[Item]:
    with bar:
        for item in items:
            bar.update()
            yield item
