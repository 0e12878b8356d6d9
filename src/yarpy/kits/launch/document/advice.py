"""Advice about words that are not known.

Rules: pure; the answer ends a sentence.
"""

from __future__ import annotations

from difflib import get_close_matches


def advice(word: str, known: tuple[str, ...] | list[str], likeness: float = 0.6) -> str:
    """Return what a word may have meant, as the end of a sentence; "" for no idea. `likeness`: of
    the two words, from 0 to 1, below which it was hardly meant."""
    if (lower := word.lower()) in known and word != lower:
        return f': write it in lower case, "{lower}"'
    near = get_close_matches(word.lower(), known, n=1, cutoff=likeness)
    return f': did you mean "{near[0]}"?' if near else ""
