"""Random numbers that belong to a sample: the same in any batch, shard or order."""

import numpy as np


def stream(seed: int, sample: int) -> np.random.Generator:
    """Generator of one sample of a study, for Python and for compiled code.

    Philox is a counter-based generator, whose sequences for two keys have nothing in common.

    Parameters
    ----------
    seed, sample
        Seed of the study, and number of the sample in it; integers from 0 on.
    """
    return np.random.Generator(np.random.Philox(key=np.array([seed, sample], dtype=np.uint64)))
