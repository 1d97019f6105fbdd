"""What softland raises."""

from __future__ import annotations


class InvalidInput(ValueError):
    """What was given breaks a rule. The message names value and rule, of a scene file line and key as well, in the words of the program.

    Attributes: `message`; `key`, its path ("gap.contact"); `file` and `line` of a scene file; None where they are not known.
    """

    def __init__(self, message: str, key: str | None = None, file: str | None = None, line: int | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.key = key
        self.file = file
        self.line = line


class WrongType(InvalidInput, TypeError):
    """An argument of a function has the wrong type: the message names the argument (`key`), the type that is due and the value."""
