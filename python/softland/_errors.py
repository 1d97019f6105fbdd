"""Exceptions of softland."""

from __future__ import annotations


class InvalidInput(ValueError):
    """Invalid input. The message names value and rule; for a scene file also line and key.

    message: text of the exception.
    key: path of the key, such as "gap.contact"; None if not known.
    file: name of the scene file; None if not known.
    line: line of the scene file; None if not known.
    """

    def __init__(self, message: str, key: str | None = None, file: str | None = None, line: int | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.key = key
        self.file = file
        self.line = line


class WrongType(InvalidInput, TypeError):
    """An argument of a function has the wrong type: the message names the argument (`key`), the expected type and the value."""
