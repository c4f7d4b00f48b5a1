"""Numbers as a reader sees them: digits chosen by how finely the document printed the value."""

import math
import re

from smallsat.evidence.printed import parse_printed

NOTHING = "—"
# Digits shown beyond the printed ones.
EXTRA_DIGITS = 2

_SCIENTIFIC = re.compile(r"[<+-]?\d+(?:\.(\d+))?e[+-]?\d+", re.IGNORECASE)


def computed_text(value: float, printed: str) -> str:
    """A computed value with two digits more than the printed literal has.

    Parameters
    ----------
    value
        The value; not finite where nothing was computed.
    printed
        The literal as printed, which sets the number of digits.
    """
    if not math.isfinite(value):
        return NOTHING
    literal = parse_printed(printed)
    if literal is None or literal.half_unit == 0:
        return significant_text(value, 6)
    decimals = -round(math.log10(2 * literal.half_unit))
    if scientific := _SCIENTIFIC.fullmatch(printed.strip()):
        return _plain(f"{value:.{len(scientific[1] or '') + EXTRA_DIGITS}e}")
    if decimals <= 0 and value == round(value):
        return f"{value:.0f}"
    return _plain(f"{value:.{max(decimals, 0) + EXTRA_DIGITS}f}")


def difference_text(difference: float, computed: float) -> str:
    """A signed difference with two significant digits; rounding noise of the value is 0."""
    if not math.isfinite(difference):
        return NOTHING
    if abs(difference) <= 1e-12 * abs(computed):
        return "0"
    return _plain(f"{difference:+.2g}")


def significant_text(value: float, digits: int) -> str:
    """A value with at most so many significant digits."""
    return _plain(f"{value:.{digits}g}") if math.isfinite(value) else NOTHING


def _plain(text: str) -> str:
    mantissa, mark, exponent = text.partition("e")
    if not float(mantissa):
        # No negative zero.
        return mantissa.lstrip("+-")
    return f"{mantissa}e{int(exponent)}" if mark else mantissa
