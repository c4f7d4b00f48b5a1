"""Answering a target that no rule makes with what there is."""

import difflib
from collections.abc import Collection
from pathlib import PurePath


def refusal(
    target: str, files: Collection[str], words: Collection[str], studies: Collection[str]
) -> str:
    """One line for an unknown target.

    Parameters
    ----------
    target
        What was asked for.
    files, words
        Everything that can be asked for: files that rules make, and names of rules without files.
    studies
        Names of the studies that are built.
    """
    if "/" not in target:
        others = ", ".join(sorted(set(words) - set(studies)))
        allowed = f"studies: {', '.join(studies)}; also {others}"
    else:
        wanted = PurePath(target)
        beside = sorted(
            path.name
            for path in map(PurePath, files)
            if path.parent == wanted.parent and path.suffix == wanted.suffix
        )
        some = ", ".join(beside[:3])
        allowed = (
            f"{wanted.parent} has {some}, ... {beside[-1]}"
            if beside
            else "nothing of that kind is made in that folder"
        )
    close = difflib.get_close_matches(target, files if "/" in target else words, n=1)
    hint = f"did you mean '{close[0]}'?" if close else "`snakemake --list` names all rules"
    return f"target '{target}': unknown; {allowed}; {hint}"
