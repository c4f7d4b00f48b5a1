"""Names in files of the project that would lead out of it, or be words of a shell."""

import pytest

from smallsat.errors import InputError
from smallsat.workflow.figures import NotebookRun
from smallsat.workflow.names import check_names

NAMES = (
    "../../../etc/x.svg",
    "/tmp/x.svg",
    "figures/mars/../../x.svg",
    "figures/mars",
    "figures/slew/x.svg",
    "figures/mars/$(touch x).svg",
    "figures/mars/x;touch y.svg",
    "figures/mars/a b.svg",
    "figures/mars/.x.svg",
    "figures/mars/-rf.svg",
    "figures/mars/x\n.svg",
    "figures/mars/<script>.svg",
)


@pytest.mark.parametrize("name", NAMES)
def test_targets_and_extras_lie_in_their_study(name):
    for artefacts, beyond in (
        ([{"target": name}], []),
        ([], [{"table": name}]),
        ([], [{"figures": [name]}]),
    ):
        with pytest.raises(InputError, match="is not allowed") as caught:
            check_names("mars", artefacts, beyond, [])
        assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize(
    "name", ["..", "../x", "/x", "$(touch x)", "a b", "x'", "`x`", "x\ny", "-x"]
)
def test_names_of_figures_films_runs_and_tables_are_plain(name):
    for run in (
        NotebookRun("mars", name, "flight"),
        NotebookRun("mars", "run", "flight", {name: None}),
        NotebookRun("mars", "run", "flight", film=name),
        NotebookRun("mars", "run", "flight", makes=(name,)),
    ):
        with pytest.raises(InputError, match=r"figures\.yaml: .* is not allowed"):
            check_names("mars", [], [], [run])


@pytest.mark.parametrize("study", ["x;touch y", "$(x)", "Mars", "../mars", ""])
def test_a_study_has_a_plain_name(study):
    with pytest.raises(InputError, match="no name of a study"):
        check_names(study, [], [], [])


def test_what_is_plain_is_allowed():
    run = NotebookRun("mars", "scene-5", "scenes", {"fig-05": None}, makes=("light.csv",))
    artefacts = [{"target": "figures/mars/fig-5.svg"}, {"target": ""}]
    check_names("mars", artefacts, [{"table": "data/results/mars/light.csv"}], [run])
