"""Make ``density.csv``: mean densities over the equator by MSIS-86 and NRLMSISE-00.

The document's atmosphere, SPeAD-M86, is a piecewise exponential fit of MSIS-86 (Kedare and Ulrich,
"Design and Evaluation of a Semi-Empirical Piece-wise Exponential Atmospheric Density Model for
CubeSat Applications"); its coefficients are not at hand. MSIS-86 is that of IRBEM as it comes in
the wheel of spacepy, NRLMSISE-00, which the fit was compared with by its authors, that of pymsis.

No part of a build. In an environment of its own::

    python -m venv atmosphere && . atmosphere/bin/activate
    pip install pymsis==0.13.0 spacepy==0.7.0
    python data/accepted/slew/density.py
"""

import csv
import ctypes
import importlib.util
import os
from itertools import product
from pathlib import Path

import numpy as np
from pymsis import calculate

ALTITUDES_KM = np.arange(200.0, 801.0, 50.0)
# F10.7 of a solar minimum, of the mean, and of a strong maximum, both of the day and of its mean.
FLUXES = (70.0, 140.0, 230.0)
GEOMAGNETIC = 15.0
# Solstices and equinoxes, at each second hour of the day, at longitude and latitude nil.
DAYS = (80, 172, 264, 355)
SECONDS = np.arange(0.0, 86400.0, 7200.0)
YEAR = np.datetime64("2014-01-01")


def msis_86(library: ctypes.CDLL, day: int, second: float, altitude: float, flux: float) -> float:
    """Density, kg/m^3. In a process of its own: the library's second call gives no number."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        # It prints what it sums.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        integers = [np.array([value], dtype=np.int32) for value in (1, 1, day)]
        reals = [np.array([float(value)]) for value in (second, altitude, 0, 0, flux, flux)]
        found, temperatures = np.zeros(8), np.zeros(2)
        arguments = [*integers, *reals, np.full(7, GEOMAGNETIC), found, temperatures]
        library.msis86_(*(one.ctypes.data_as(ctypes.c_void_p) for one in arguments))
        os.write(writing, found[5:6].tobytes())
        os._exit(0)
    os.close(writing)
    (density,) = np.frombuffer(os.read(reading, 8))
    os.close(reading)
    os.waitpid(child, 0)
    return 1e3 * float(density)


def nrlmsise_00(altitude: float, flux: float) -> float:
    """Mean density, kg/m^3."""
    times = [
        YEAR + np.timedelta64(day - 1, "D") + np.timedelta64(int(second), "s")
        for day, second in product(DAYS, SECONDS)
    ]
    n = len(times)
    same = [np.full(n, value) for value in (0.0, 0.0, altitude, flux, flux)]
    found = calculate(np.array(times), *same, np.full((n, 7), GEOMAGNETIC), version=0)
    return float(found[:, 0].mean())


def main() -> None:
    """Write the table beside this file."""
    package = Path(importlib.util.find_spec("spacepy").origin).parent
    library = ctypes.CDLL(str(package / "irbempy" / "libirbem.so"))
    with (Path(__file__).parent / "density.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["altitude_km", "solar_flux", "msis_86_kg_m3", "nrlmsise_00_kg_m3"])
        for flux, altitude in product(FLUXES, ALTITUDES_KM):
            moments = product(DAYS, SECONDS)
            older = np.mean([msis_86(library, day, s, altitude, flux) for day, s in moments])
            row = (older, nrlmsise_00(altitude, flux))
            table.writerow([altitude, flux, *(f"{density:.4e}" for density in row)])


if __name__ == "__main__":
    main()
