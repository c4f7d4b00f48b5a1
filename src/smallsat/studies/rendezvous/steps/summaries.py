"""What the variants and sweeps change, and what the docking distance decides."""

from smallsat.dynamics.units import HOUR
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import MonteCarlo
from smallsat.studies.rendezvous.model.actuation_noise import readings_table, sampling
from smallsat.studies.rendezvous.monte_carlo import summaries, swept
from smallsat.studies.rendezvous.simulation.disturbances import thrust_noise

# Duration, step and number of the sample paths in Figure 5.1.
PATH_S, PATH_STEP_S, PATHS = 12.0 * HOUR, 120.0, 20


def run(step: Step[MonteCarlo]) -> Tables:
    """Summarise them."""
    section, folder = step.section, step.results / "studies"
    robustness = section.studies.robustness
    noise, reading = thrust_noise(robustness.thrust_error), robustness.thrust_error.reading
    tables = {
        "variants": summaries.variants(section, folder),
        "bounce": summaries.bounce(folder),
        "deviations": summaries.deviations(folder),
        "infeasible": summaries.infeasible(folder),
        "impulse-bits": swept.impulse_bits(section, folder),
        "rotation": swept.rotation(section, folder),
        "orbits": swept.orbits(section, folder),
        "thrust-readings": readings_table(noise),
        "thrust-errors": sampling(noise, reading, PATH_S, PATH_STEP_S, PATHS, robustness.seed),
    }
    return {f"studies/{name}.csv": table for name, table in tables.items()}
