"""What may go wrong."""
import re


class NoAnswer(ConnectionError):
    """No time-master answers at the address."""


class Refused(ConnectionError):
    """The time-master refuses a node; the text is its reason."""


class RunFailed(RuntimeError):
    """The run has failed; the text is its cause."""


class InputError(ValueError):
    """Input that is not valid; the text is as on the command line, `file:line:column: key: reason, got value`.

    `file`, `line`, `column` and `key` are what of this it names, else None.
    """

    _PLACE = re.compile(r"(?P<file>[^\n]*?):(?P<line>\d+):(?P<column>\d+): (?:(?P<key>[\w\[\]]+(?:\.[\w\[\]]+)*): )?")

    def __init__(self, text: str) -> None:
        super().__init__(text)
        place = self._PLACE.match(text)
        self.file: str | None = place["file"] if place else None
        self.line: int | None = int(place["line"]) if place else None
        self.column: int | None = int(place["column"]) if place else None
        self.key: str | None = place["key"] if place else None


class ScenarioError(InputError):
    """A scenario that is not valid, or one of its files."""


class EngineError(RuntimeError):
    """What was asked for cannot be done; the text is the reason."""
