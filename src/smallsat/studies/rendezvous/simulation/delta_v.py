"""Ways in which the velocity changes of a manoeuvre can be summed to one delta-v.

The document does not say which one it prints. All take velocity changes, shape (K, 3), m/s, in the
axes x radial, y along the orbit, z normal to it, and give one sum, m/s.
"""

import numpy as np

READINGS = ("2-norm", "1-norm", "resultant", "plane and normal")


def summed(changes: np.ndarray, reading: str) -> float:
    """Total delta-v by one of `READINGS`.

    2-norm
        Lengths of the velocity changes.
    1-norm
        Their components: what thrusters along the axes burn.
    resultant
        The length of the thrust, integrated over time, where the axes' equal thrusters start
        together and end one after the other.
    plane and normal
        The length in the orbit's plane plus the component normal to it.
    """
    size = np.abs(np.asarray(changes, dtype=float).reshape(-1, 3))
    if reading == "2-norm":
        return float(np.sqrt((size**2).sum(axis=1)).sum())
    if reading == "1-norm":
        return float(size.sum())
    if reading == "resultant":
        least, middle, most = np.sort(size, axis=1).T
        return float((np.sqrt(3.0) * least + np.sqrt(2.0) * (middle - least) + most - middle).sum())
    if reading == "plane and normal":
        return float((np.hypot(size[:, 0], size[:, 1]) + size[:, 2]).sum())
    raise ValueError(f"no reading {reading!r}")
