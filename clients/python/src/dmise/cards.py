"""Cards of FITS headers as values."""
from __future__ import annotations

import re
from collections.abc import Iterable

CardValue = bool | int | float | str


def values_of(cards: Iterable[str]) -> dict[str, CardValue]:
    """Values by keyword of cards of 80 characters, of those that have one."""
    return dict(_value_of(card) for card in cards if card[8:10] == "= ")


def _value_of(card: str) -> tuple[str, CardValue]:
    key, text = card[:8].strip(), card[10:].strip()
    if quoted := re.match("'((?:[^']|'')*)'", text):
        return key, quoted[1].replace("''", "'").rstrip()
    word = text.split("/")[0].strip()
    if word in ("T", "F"):
        return key, word == "T"
    try:
        return key, int(word)
    except ValueError:
        return key, float(word)
