"""Cases of hostile use, one file for each group; a new file is listed in `load`."""

from hostile.case import Case, case  # noqa: F401


def load():
    """All cases, by name."""
    from hostile import control, forged, questions, subscriptions  # noqa: F401  each registers its cases

    return {c.name: c for c in Case.all}
