"""What may go wrong with a run."""


class NoAnswer(ConnectionError):
    """No time-master answers at the address."""


class Refused(ConnectionError):
    """The time-master refuses a node; the text is its reason."""


class RunFailed(RuntimeError):
    """The run has failed; the text is its cause."""
