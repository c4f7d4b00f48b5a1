"""Predicates of what parts of the algorithm are for, on made-up manoeuvres: each can fail."""

import numpy as np
import pandas as pd
import pytest
import synthetic

from smallsat.evidence.claims import judge_claims
from smallsat.results import write_table
from smallsat.strict_yaml import read_yaml
from smallsat.studies.rendezvous.evidence import ensemble
from smallsat.studies.rendezvous.monte_carlo import cases

COUNT = 80
MODULE = "smallsat.studies.rendezvous.evidence.ablation_claims:"


@pytest.fixture
def outcomes(root, grounds, section, monkeypatch, tmp_path):
    """Outcomes of the claims on these tables; the ensemble is the made-up run itself."""
    monkeypatch.setattr(ensemble, "members", lambda given: [given])
    entries = read_yaml(root / "data/published/rendezvous/claims.yaml")
    chosen = [entry for entry in entries if entry["predicate"].startswith(MODULE)]

    def judge(**tables):
        states = synthetic.states(COUNT)
        states["x_m"], states["y_m"] = 0.0, 1000.0
        for name, table in {"initial_states": states, **tables}.items():
            write_table(table, tmp_path / f"studies/{name.replace('_', '-')}.parquet")
        found = judge_claims(chosen, grounds("rendezvous", section, tmp_path), "claims.yaml")
        return dict(zip(found["id"], found["outcome"], strict=True))

    return judge


def made_up(name, **columns):
    """Manoeuvres of a case with a scatter of 5 %, which completes."""
    noise = np.exp(0.05 * np.random.default_rng(len(name)).standard_normal(COUNT))
    scattered = {
        key: value * noise if key.endswith(("_s", "_m")) else value
        for key, value in columns.items()
    }
    return synthetic.manoeuvres(name, COUNT, **scattered)


def world(section, *, sense):
    """All tables: as the document says where `sense` is true, else the other way round."""

    def pick(said, other):
        return said if sense else other

    studies = section.studies
    r1 = section.inferred.keep_out_m
    whole = {
        "rendezvous_steps": 30, "rendezvous_time_s": 900.0, "rendezvous_delta_v_m_s": 9.0,
        "rendezvous_softened": pick(0, 9), "rendezvous_iterations": 400,
        "approach_time_s": pick(250.0, 300.0), "approach_delta_v_m_s": 3.0,
        "docking_time_s": 300.0, "docking_delta_v_m_s": 0.2, "closest_m": pick(1.1, 0.5) * r1,
    }  # fmt: skip
    first, *_, last = studies.docking.sample_times_s
    horizon = section.phases.final.horizon
    lost = np.arange(COUNT) < pick(0, 40)
    free = whole | {"rendezvous_time_s": pick(950.0, 2900.0)}
    ablations = [
        made_up(cases.NO_PENALTY, **whole).assign(completed=~lost),
        made_up(cases.NO_ZONE, **whole | {"closest_m": pick(0.2, 1.2) * r1}),
        made_up(cases.NO_SET_POINT_NO_ZONE, **free),
        *(
            made_up(cases.planes_case(rate), **whole | {"rendezvous_softened": pick(6, 0)})
            for rate in studies.ablations.plane_rates
        ),
        made_up(cases.NO_REFERENCE, approach_time_s=pick(300.0, 250.0), approach_delta_v_m_s=3.0),
        made_up(cases.corridor_case(first), docking_time_s=300.0),
        made_up(cases.corridor_case(last), docking_time_s=pick(310.0, 500.0)),
        made_up(cases.LP_DISTURBED, rendezvous_delta_v_m_s=pick(12.0, 8.0)),
        made_up(cases.LP_UNDISTURBED, rendezvous_delta_v_m_s=8.0),
    ]
    sweep = studies.rendezvous
    return {
        "domain": pd.concat([
            made_up(cases.BASELINE, **whole),
            made_up(cases.NO_SET_POINT, **whole | {"rendezvous_time_s": 3000.0}),
        ]),
        "ablations": pd.concat(ablations),
        "robustness": pd.concat([
            made_up(cases.AS_DOCUMENTED, rendezvous_delta_v_m_s=9.9),
            made_up(cases.UNDISTURBED, rendezvous_delta_v_m_s=9.0),
        ]),
        "docking_sweep": pd.concat([
            made_up(cases.sweep_case(horizon, first), docking_time_s=300.0),
            made_up(cases.sweep_case(horizon, last), docking_time_s=400.0),
        ]),
        "delay": pd.concat([
            made_up(cases.delay_case(delay, known), **whole | {
                "rendezvous_delta_v_m_s": pick(9.1, 8.5) if known else pick(12.0, 8.0)})
            for delay in studies.delay.delays_s for known in (False, True)
        ]),
        "rendezvous_sweep": pd.concat([
            made_up(cases.sweep_case(n, t), rendezvous_iterations=pick(400 + n, 400 // n))
            for n in sweep.horizons for t in sweep.sample_times_s
        ]),
        "weights": pd.concat([
            made_up(cases.weight_case(f, "rendezvous"),
                    rendezvous_iterations=pick(400, int(300 * f)))
            for f in studies.weights.factors
        ]),
    }  # fmt: skip


def test_each_claim_holds_where_the_part_does_what_is_said(section, outcomes):
    """Eleven claims on manoeuvres that were made so."""
    found = outcomes(**world(section, sense=True))
    assert len(found) == 11
    assert found == dict.fromkeys(found, "holds")


def test_each_claim_fails_where_the_part_does_the_contrary(section, outcomes):
    """The same tables the other way round."""
    found = outcomes(**world(section, sense=False))
    assert found == dict.fromkeys(found, "fails")


def test_claims_wait_for_cases_that_were_left_out(section, outcomes):
    """Without the ablations nothing is decided but what the other groups show."""
    tables = world(section, sense=True)
    tables["ablations"] = tables["ablations"].iloc[:0]
    found = outcomes(**tables)
    shown = {"plane-limit", "sampling-costs-more", "delay-effect", "delay-cured"}
    assert {name for name, outcome in found.items() if outcome == "holds"} == shown
    assert all(found[name] == "undecided" for name in found.keys() - shown)
