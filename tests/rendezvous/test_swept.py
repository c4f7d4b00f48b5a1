"""Impulse bits, rotation rates and elliptic orbits: what they are at the baseline's own values."""

import numpy as np
import pandas as pd
import pytest

from smallsat.statistics.random_streams import stream
from smallsat.studies.rendezvous.figures.beyond import SWEEPS, swept
from smallsat.studies.rendezvous.guidance.controller import memory_for, next_control
from smallsat.studies.rendezvous.guidance.law import settings
from smallsat.studies.rendezvous.model.columns import STATE
from smallsat.studies.rendezvous.model.truth import advance, pair_from_relative, relative_state
from smallsat.studies.rendezvous.monte_carlo import swept as tables
from smallsat.studies.rendezvous.monte_carlo.cases import (
    AS_DOCUMENTED,
    CLOHESSY_WILTSHIRE,
    UNDISTURBED,
    YAMANAKA_ANKERSEN,
    base,
    bit_case,
    cases,
    orbit_case,
    rotation_case,
)
from smallsat.studies.rendezvous.monte_carlo.initial_states import states_table
from smallsat.studies.rendezvous.monte_carlo.runs import simulate_cases
from smallsat.studies.rendezvous.simulation.closed_loop import simulate
from smallsat.studies.rendezvous.simulation.motion import COMMANDED


@pytest.fixture(scope="module")
def starts(section):
    """Two initial states outside the keep-out zone, as the groups have them."""
    table = states_table(section, 20, 11)
    far = table[table["distance_m"] > 2.0 * section.inferred.keep_out_m].head(2)
    return far[["sample", *STATE]].assign(run=np.int32(0))


@pytest.fixture(scope="module")
def by_name(section):
    """All cases of a group by their names."""
    return lambda group: {case.name: case for case in cases(section, group)}


def flown(section, case, starts):
    return simulate_cases(section, [case], [starts]).drop(columns="case")


@pytest.mark.parametrize(
    ("thrust", "baseline"), [("impulses", UNDISTURBED), ("disturbed", AS_DOCUMENTED)]
)
def test_no_bit_is_the_baseline(section, by_name, starts, thrust, baseline):
    """With a bit of zero, to the last bit, and not with a large one that is left out."""
    bits, others = by_name("impulse-bits"), by_name("robustness")
    expected = flown(section, others[baseline], starts)
    none = flown(section, bits[bit_case(thrust, "rounded", 0.0)], starts)
    pd.testing.assert_frame_equal(none, expected, check_exact=True)
    most = max(section.studies.impulse_bits.bits_mN_s)
    large = flown(section, bits[bit_case(thrust, "left out", most)], starts)
    assert not large["docking_delta_v_m_s"].equals(expected["docking_delta_v_m_s"])


def test_no_flown_impulse_is_below_the_bit(section, by_name, starts):
    """From one record to the next the velocity changes by nothing, or by the bit at least.

    Along the orbit's normal, where the motion over a step is known in closed form, but for a tenth
    of the bit: what the oblateness does in a step of half a minute.
    """
    bit = max(section.studies.impulse_bits.bits_mN_s)
    least = 1e-3 * bit / section.spacecraft.mass_kg
    case = by_name("impulse-bits")[bit_case("impulses", "rounded", bit)]
    start = starts[STATE].to_numpy()[:1] + np.array([0.0, 0.0, 20.0, 0.0, 0.0, 0.0])
    numbers = [stream(3, 0)]
    steps = simulate([case.law], start, (0, 0), case.motion, numbers, with_steps=True).record(0)
    n, ts = case.law.mean_motion, case.law.sample_times[0]
    z, after = steps.state[:-1, 2], steps.state[1:, 2]
    velocity = (after - z * np.cos(n * ts)) * n / np.sin(n * ts)
    change = np.abs(velocity - steps.state[:-1, 5])
    commanded = np.abs(steps.impulse[:-1, 2])
    assert (commanded < 0.4 * least).any() and (commanded > 0.6 * least).any()
    assert np.all((change < 0.1 * least) | (change > 0.9 * least))


def test_the_configured_rate_is_the_third_case_and_no_rate_the_first(section, by_name, starts):
    """To the last bit; the docking phase alone begins where it is told to."""
    rotation, domain = by_name("rotation"), by_name("domain")
    own = section.inferred.rotation_rate_rad_s
    for rate, case in ((own, "rotating"), (0.0, "v-bar")):
        found = rotation[rotation_case("all phases", abs(rate))]
        expected = simulate([base(section, case)], starts[STATE].to_numpy())
        turned = simulate([found.law], starts[STATE].to_numpy())
        for one, other in zip(turned[:12], expected[:12], strict=True):
            np.testing.assert_array_equal(one, other)
    assert rotation[rotation_case("docking alone", own)].phases == (2, 2)
    assert domain["baseline"].law.rotation_rate == 0.0


def test_without_eccentricity_the_elliptic_prediction_is_the_circular_one(section, starts, laws):
    """To rounding: first controls of all phases to 1e-9 of their bounds, and whole manoeuvres."""
    for law in laws.values():
        records = settings([law, law.with_(eccentricity=0.0, true_anomaly=1.0)])
        memory = memory_for(max(law.horizons))
        for phase, distance in enumerate((900.0, 100.0, 6.0)):
            state = np.array([0.02 * distance, distance, 0.01 * distance, 0.0, -0.01, 0.001])
            commands = np.zeros((2, 3))
            for record, command in zip(records, commands, strict=True):
                next_control(record, phase, state, 100.0, memory, command)
            bound = law.control_bounds[phase]
            np.testing.assert_allclose(commands[0], commands[1], atol=1e-6 * bound)
    law = base(section)
    circular, elliptic = (
        simulate([one], starts[STATE].to_numpy())
        for one in (law, law.with_(eccentricity=0.0, true_anomaly=2.0))
    )
    np.testing.assert_array_equal(elliptic.steps, circular.steps)
    np.testing.assert_allclose(elliptic.ends, circular.ends, atol=1e-5)


def test_the_elliptic_prediction_foresees_where_plans_end(section, by_name, starts):
    """Plans of the far range, flown without another look, on an ellipse: ten times nearer.

    What the first program plans for all its stages is given to the true motion at once.
    """
    e = max(section.studies.orbits.eccentricities)
    orbits, state = by_name("orbits"), np.ascontiguousarray(starts[STATE].to_numpy()[0])
    missed = {}
    for model in (CLOHESSY_WILTSHIRE, YAMANAKA_ANKERSEN):
        case = orbits[orbit_case(model, e, 90.0)]
        law, motion = case.law, case.motion
        assert motion.actuation == COMMANDED
        record = settings([law])[0]
        memory, command = memory_for(law.horizons[0]), np.zeros(3)
        next_control(record, 0, state, 0.0, memory, command)
        end = memory.together.work.states[law.horizons[0], :3, 0]
        planned = end * record["scales"][0, :3]
        missed[model] = np.linalg.norm(_flown_plan(law, motion, state, memory.plan) - planned)
    assert missed[YAMANAKA_ANKERSEN] < 0.1 * missed[CLOHESSY_WILTSHIRE]


def _flown_plan(law, motion, state, plan):
    """Relative position after all impulses of a plan."""
    pair, idle = pair_from_relative(motion.target, state), np.zeros(3)
    for impulse in plan:
        moved = relative_state(pair)
        moved[3:] += impulse
        pair = pair_from_relative(pair[0], moved)
        advance(pair, 0.0, law.sample_times[0], idle, idle, motion.environment)
    return relative_state(pair)[:3]


def test_tables_of_sweeps_count_what_was_flown(section, tmp_path, starts):
    """A row a variant and value; shares by hand; a miss only where a docking does not end."""
    few = section.with_(
        studies=section.studies.with_(
            rotation=section.studies.rotation.with_(rates_rad_s=(0.0, 0.02)), time_limit_min=60.0
        )
    )
    group = cases(few, "rotation")
    begun = starts.assign(x_m=0.0, y_m=8.0, z_m=0.0, vx_m_s=0.0, vy_m_s=0.0, vz_m_s=0.0)
    rows = simulate_cases(
        few, group, [starts if case.phases == (0, 2) else begun for case in group]
    )
    rows.to_parquet(tmp_path / "rotation.parquet")
    found = tables.rotation(few, tmp_path).set_index(["variant", "value"])
    assert len(found) == 6
    calm, wild = found.loc[("all phases", 0.0)], found.loc[("all phases", 0.02)]
    assert calm["docked_pct"] == 100.0 and np.isnan(calm["miss_m"])
    assert wild["docked_pct"] < 100.0
    whole = rows[rows["case"] == rotation_case("all phases", 0.0)]
    steps, softened = (
        sum(whole[f"{phase}_{name}"].sum() for phase in ("rendezvous", "approach", "docking"))
        for name in ("steps", "softened")
    )
    assert calm["whole_unsolvable_pct"] == pytest.approx(100.0 * softened / steps)
    assert calm["docking_change_pct"] == 0.0
    own = section.inferred.rotation_rate_rad_s
    turned = rows[rows["case"] == rotation_case("all phases", own)]
    ratio = turned["docking_delta_v_m_s"].to_numpy() / whole["docking_delta_v_m_s"].to_numpy()
    change = found.loc[("all phases", own), "docking_change_pct"]
    assert change == pytest.approx(100.0 * (np.median(ratio) - 1.0))
    figure, data = swept(found.reset_index(), SWEEPS["rotation"])
    assert len(figure.axes) == 4 and len(data) == 6


def test_a_sweep_of_which_nothing_docks_is_still_a_table_and_a_figure(section, tmp_path, starts):
    """No quantiles, no change; a group that no manoeuvre came to has no shares either."""
    group = cases(section, "rotation")
    late = section.with_(studies=section.studies.with_(time_limit_min=1.0))
    begun = [starts if case.phases == (0, 2) else starts.head(0) for case in group]
    rows = simulate_cases(late, cases(late, "rotation"), begun)
    rows.to_parquet(tmp_path / "rotation.parquet")
    found = tables.rotation(late, tmp_path)
    assert (found["docked_pct"].dropna() == 0.0).all() and found["docked_pct"].isna().any()
    assert found[["docking_delta_v_median_m_s", "whole_change_pct", "miss_m"]].isna().all(axis=None)
    figure, _ = swept(found, SWEEPS["rotation"])
    figure.canvas.draw()
