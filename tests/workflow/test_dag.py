"""The picture of the rules: condensed as it should be, and that of the rules that there are."""

import re
from graphlib import CycleError

import pytest

from smallsat.workflow.dag import Graph, Group, columns, condensed, grouping, rule_edges

MERMAID = """---
title: DAG
---
flowchart TB
\tid0[report]
\tid1[mars_flight]
\tid2[mars_fit]
\tid3[mars_curve]
\tid4[mars_verdicts]
\tstyle id0 fill:#57D9A0,stroke-width:2px
\tid1 --> id2
\tid2 --> id3
\tid1 --> id4
\tid4 --> id0
\tid3 --> id0
\tid1 --> id0
"""
STEPS, NOTEBOOKS, VERDICTS = (Group("mars", kind) for kind in ("steps", "notebooks", "verdicts"))
REPORT = Group("", "report")


@pytest.fixture
def graph():
    return condensed(*rule_edges(MERMAID), grouping(["mars"], ["mars_curve"]))


def test_rules_of_a_kind_are_one_node_and_what_follows_is_left_out(graph):
    """Two steps in one; the report rests on the steps through notebooks and verdicts."""
    assert graph.rules == {REPORT: 1, STEPS: 2, NOTEBOOKS: 1, VERDICTS: 1}
    assert graph.edges == {
        (STEPS, NOTEBOOKS),
        (STEPS, VERDICTS),
        (NOTEBOOKS, REPORT),
        (VERDICTS, REPORT),
    }


def test_columns_go_from_left_to_right(graph):
    assert columns(graph) == {STEPS: 0, NOTEBOOKS: 1, VERDICTS: 1, REPORT: 2}


def test_what_joins_the_studies_stands_right_of_all_of_them():
    """Also what only a short study feeds."""
    short, long, joint = Group("a", "steps"), Group("b", "tables"), Group("", "site")
    first = Group("b", "steps")
    graph = Graph(dict.fromkeys((short, long, joint, first), 1), {(first, long), (short, joint)})
    assert columns(graph)[joint] == 2


def test_kinds_that_feed_one_another_are_refused():
    edges = [("mars_flight", "mars_curve"), ("mars_curve", "mars_fit")]
    with pytest.raises(CycleError):
        condensed(
            ["mars_flight", "mars_fit", "mars_curve"], edges, grouping(["mars"], ["mars_curve"])
        )


def test_the_tracked_picture_is_of_the_rules_that_there_are(project, root):
    """It says in words what it shows; `make dag` draws it anew."""
    done = project.run(". .venv/bin/activate && make dag")
    assert done.returncode == 0, done.stdout + done.stderr
    said = [
        re.search("<dc:description>(.*?)</dc:description>", text, re.DOTALL)[1]
        for text in ((folder / "docs/dag.svg").read_text() for folder in (project.folder, root))
    ]
    assert said[0] == said[1] and "rendezvous verdicts (1): rendezvous steps" in said[0]
