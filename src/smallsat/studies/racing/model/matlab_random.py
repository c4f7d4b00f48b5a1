"""MATLAB's default random stream: ``rng(seed)``, then ``rand`` and ``randn``.

The uniform numbers are those of the Mersenne twister with 53 bits. The normal ones are a ziggurat
of 256 layers on the same words; how MATLAB takes layer, sign and fraction from two words is not
documented, and was found here from published outputs of ``rng(0); randn``, which a test repeats.
"""

from functools import cache

import numpy as np
from scipy.optimize import brentq
from scipy.special import erfc

LAYERS = 256
# MATLAB's seed 0 is the twister's own default.
DEFAULT_SEED = 5489


class MatlabStream:
    """The stream after ``rng(seed)``."""

    def __init__(self, seed: int):
        self._state = np.random.RandomState(seed or DEFAULT_SEED)

    def random(self, size: int | None = None):
        """Uniform numbers in [0, 1): ``rand``."""
        return self._state.random_sample(size)

    def normal(self) -> float:
        """One normal number: ``randn``."""
        edges = ziggurat_edges()
        while True:
            high, low = (int(w) for w in self._state.randint(0, 2**32, size=2, dtype=np.uint32))
            fraction = ((high >> 5) * 2**26 + (low >> 6)) / 2**53
            layer = low >> 24
            value = (2.0 * fraction - 1.0) * edges[layer + 1]
            size = abs(value)
            if size < edges[layer]:
                return value
            if layer == LAYERS - 1:
                # The tail, beyond the last edge.
                x = -np.log(self.random()) / edges[LAYERS - 1]
                while -2.0 * np.log(self.random()) < x * x:
                    x = -np.log(self.random()) / edges[LAYERS - 1]
                return float(np.copysign(edges[LAYERS - 1] + x, value))
            outer, inner = np.exp(-0.5 * edges[layer + 1] ** 2), np.exp(-0.5 * edges[layer] ** 2)
            if outer + self.random() * (inner - outer) < np.exp(-0.5 * size**2):
                return value


@cache
def ziggurat_edges() -> tuple[float, ...]:
    """Right edges of the layers of equal area, from the top; the last is of the tail's layer."""

    def edges(last: float) -> list[float]:
        area = _area(last)
        x = [area / np.exp(-0.5 * last**2), last]
        while len(x) < LAYERS:
            height = area / x[-1] + np.exp(-0.5 * x[-1] ** 2)
            if height >= 1.0:
                break
            x.append(float(np.sqrt(-2.0 * np.log(height))))
        return x

    def closes(last: float) -> float:
        x = edges(last)
        if len(x) < LAYERS:
            return -1.0
        return float(1.0 - (_area(last) / x[-1] + np.exp(-0.5 * x[-1] ** 2)))

    last = brentq(closes, 3.0, 4.5, xtol=1e-14)
    return (0.0, *reversed(edges(last)))


def _area(last: float) -> float:
    return last * np.exp(-0.5 * last**2) + np.sqrt(np.pi / 2.0) * erfc(last / np.sqrt(2.0))
