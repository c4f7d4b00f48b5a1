"""A share of the units of a step, which several jobs work through side by side."""

import re
from dataclasses import dataclass

from smallsat.errors import InputError


@dataclass(frozen=True)
class Shard:
    """One of several equal shares of the units of a step, numbered from 1."""

    number: int
    count: int

    @classmethod
    def parse(cls, text: str) -> "Shard":
        """Read ``2-of-4``.

        Raises
        ------
        InputError
            If the text is no such share.
        """
        found = re.fullmatch(r"([1-9]\d*)-of-([1-9]\d*)", text)
        if not found or int(found[1]) > int(found[2]):
            raise InputError(f"shard {text!r}: not allowed; from 1-of-N to N-of-N")
        return cls(int(found[1]), int(found[2]))

    @classmethod
    def all(cls, count: int) -> "list[Shard]":
        """Every shard of so many."""
        return [cls(number, count) for number in range(1, count + 1)]

    def __str__(self) -> str:
        return f"{self.number}-of-{self.count}"

    def units(self, total: int) -> range:
        """Numbers of its units, from 0: every so-manieth, so that shards take equally long."""
        return range(self.number - 1, total, self.count)


# Of a step that is not shared out.
WHOLE = Shard(1, 1)
