"""Which rows of a tracked table a new series of builds takes the place of."""

import pandas as pd

from tests.determinism.run import Series, kept


def test_a_series_replaces_itself_and_its_parts(tmp_path):
    """Not another configuration, nor a series that has a study more."""
    path = tmp_path / "table.csv"
    for configuration, studies, value in (
        ("quick", "mars slew", "of two"),
        ("full", "mars", "of another configuration"),
        ("quick", "mars", "of a part"),
        ("quick", "racing", "of another study"),
        ("quick", "slew mars", "of two, anew"),
    ):
        kept(path, ["value"], Series(configuration, studies), [{"value": value}])
    table = pd.read_csv(path)
    assert list(table.columns) == ["configuration", "studies", "value"]
    assert list(table["value"]) == ["of another configuration", "of another study", "of two, anew"]
