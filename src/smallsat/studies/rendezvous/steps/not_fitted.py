"""The sets of the ensemble against what the searches did not look at."""

from typing import Any

import pandas as pd

from smallsat.evidence.ledger import Ledger
from smallsat.results import read_table
from smallsat.step import Step, Tables
from smallsat.studies.rendezvous.configuration import Configuration
from smallsat.studies.rendezvous.inference.not_fitted import cells, failures
from smallsat.studies.rendezvous.inference.parameter_set import ParameterSet


def run(step: Step[Configuration]) -> Tables:
    """Compare them; a row a set, and a row a set and case of Section 4.2."""
    ledger = Ledger.read(step.published / "values.csv")
    rows, cases = list[dict[str, Any]](), list[pd.DataFrame]()
    for number in range(1, step.section.inference.ensemble.sets + 1):
        folder = step.results / f"ensemble/{number:02d}"
        own: Any = read_table(folder / "set.csv").to_dict("records")[0]
        section = ParameterSet.of_row(own).put_into(step.section)
        failed = failures(section, read_table(folder / "studies/rendezvous-sweep.parquet"), ledger)
        cases.append(failed.assign(set=number))
        printed = failed["printed"] > 0
        term = float((failed["residual"] ** 2).sum())
        rows.append(
            {
                "set": number,
                "misfit": own["misfit"],
                "failures": term,
                "with_failures": own["misfit"] + term,
                "failed_where_printed": int(failed.loc[printed, "failed"].sum()),
                "failed_elsewhere": int(failed.loc[~printed, "failed"].sum()),
                **cells(section, read_table(folder / "truth.csv"), ledger).add_prefix("cells_"),
            }
        )
    return {
        "not-fitted.csv": pd.DataFrame(rows),
        "failures.csv": pd.concat(cases, ignore_index=True),
    }
