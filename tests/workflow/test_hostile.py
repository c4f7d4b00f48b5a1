"""Hostile names and values: nothing that a person or a file says is run, or written elsewhere."""

import ast
import json
import shlex

import nbformat
import pytest
from jinja2 import Environment, FileSystemLoader, StrictUndefined

from smallsat.config import as_json, overlaid_config, parse_entry, run_folder
from smallsat.errors import InputError
from smallsat.strict_yaml import parse_yaml
from smallsat.workflow.notebook import main as run_notebook

COLUMNS = ("locator", "quantity", "case", "printed", "computed", "unit")
TEXTS = (
    "$(touch pwned)",
    "`touch pwned`",
    "'; touch pwned; '",
    '"; open("pwned", "w"); "',
    "')\nopen('pwned', 'w')\n#",
    "\\'; open('pwned', 'w') #",
    "{0.__class__} {{ 7 * 7 }} {wildcards.x} %s",
    "<script>alert(1)</script>",
    '"><img src=x onerror=alert(1)>',
    "a\x1b[31m\u2028b\\",
)


@pytest.mark.parametrize(
    "name", ["..", "../x", "/tmp/x", "a/b", "a b", "$(x)", "x;y", "x\n", "é", ".", "a'b"]
)
def test_a_run_has_a_plain_name_and_so_its_folder_lies_in_runs(config, name):
    """Given on the command line or in a file."""
    with pytest.raises(InputError, match="config key 'run'") as caught:
        overlaid_config(config, [], [f"run={name}"])
    assert len(str(caught.value).splitlines()) == 1


def test_a_run_without_a_name_lies_in_runs_too(config):
    folder = run_folder(overlaid_config(config, [], ["mars={visibility_deg: 40}"]), config)
    assert folder.startswith("runs/") and folder.removeprefix("runs/").isalnum()


@pytest.mark.parametrize(
    "text",
    [
        "!!python/object/apply:os.system ['touch pwned']",
        "!!python/object/new:subprocess.Popen [[touch, pwned]]",
        "a: !!python/name:os.system",
        "a: !!python/module:os",
        "a: !include /etc/passwd",
    ],
)
def test_yaml_makes_no_objects(text, tmp_path, monkeypatch):
    """A tag of Python's is refused, in a file and on the command line."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match="not valid YAML"):
        parse_yaml(text, "my.yaml")
    with pytest.raises(InputError, match="not valid YAML"):
        parse_entry(f"mars={text}")
    assert not list(tmp_path.iterdir())


# What runs what it reads: modules, functions, methods of others, and a keyword of NumPy's.
RUNS_IT = {
    "module": {"pickle", "dill", "cloudpickle", "joblib", "shelve", "marshal"},
    "function": {"eval", "exec"},
    "method": {"read_pickle", "unsafe_load", "full_load"},
    "keyword": {"allow_pickle"},
}


def used(tree):
    """Sort and name of every module that a source imports, and of whatever it calls."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (("module", alias.name.split(".")[0]) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield "module", (node.module or "").split(".")[0]
        elif isinstance(node, ast.Call):
            yield from (("keyword", keyword.arg) for keyword in node.keywords)
            if isinstance(node.func, ast.Name):
                yield "function", node.func.id
            elif isinstance(node.func, ast.Attribute):
                yield "method", node.func.attr


def test_no_source_reads_a_pickle_or_runs_a_text(root):
    files = [*root.glob("src/**/*.py"), *root.glob("flight/**/*.py")]
    assert len(files) > 200
    for path in files:
        for sort, name in used(ast.parse(path.read_text(encoding="utf-8"))):
            assert name not in RUNS_IT[sort], f"{path}: {name}"


def test_a_pickle_would_be_noticed():
    text = "import pickle\nnp.load(x, allow_pickle=True)\npd.read_pickle(x)\neval(x)"
    assert sum(name in RUNS_IT[sort] for sort, name in used(ast.parse(text))) == 4


def test_parameters_of_a_notebook_arrive_as_the_texts_that_they_are(tmp_path, monkeypatch):
    """Whatever stands in them: papermill writes them into a cell, which runs no more than them."""
    monkeypatch.chdir(tmp_path)
    cells = [
        nbformat.v4.new_code_cell("texts = []", metadata={"tags": ["parameters"]}),
        nbformat.v4.new_code_cell(
            "import json\nfrom pathlib import Path\nPath('got.json').write_text(json.dumps(texts))"
        ),
    ]
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    notebook = nbformat.v4.new_notebook(cells=cells, metadata={"kernelspec": kernel})
    nbformat.write(notebook, tmp_path / "in.ipynb")
    given = {"texts": [*TEXTS, {text: text for text in TEXTS}]}

    class Arguments:
        notebook = tmp_path / "in.ipynb"
        executed = tmp_path / "out.ipynb"
        parameters = given

    run_notebook(Arguments)
    assert json.loads((tmp_path / "got.json").read_text()) == given["texts"]
    assert not (tmp_path / "pwned").exists()


def test_a_configuration_is_one_word_of_a_shell(tmp_path):
    """As Snakemake quotes what a rule says is quoted; no other way leads it into a command."""
    from snakemake.utils import format as snakemake_format

    line = snakemake_format("python {given:q} > log", given=as_json({"course": list(TEXTS)}))
    words = shlex.split(line)
    assert len(words) == 4 and json.loads(words[1])["course"] == list(TEXTS)


def test_every_rule_quotes_what_a_person_gave(root):
    """Whole configurations, parts of it, lists of cases: ``{params.…:q}`` in each rule."""
    given = ("config", "default", "parameters", "left_out")
    found = 0
    for path in sorted(root.glob("rules/*.smk")):
        text = path.read_text()
        for name in given:
            assert f"{{params.{name}}}" not in text, path
            found += text.count(f"{{params.{name}:q}}")
    assert found >= 6


def test_pages_show_hostile_texts_to_the_letter(root):
    """The comparison of runs, and the table of all values."""
    pages = Environment(
        loader=FileSystemLoader(root / "report/site"), autoescape=True, undefined=StrictUndefined
    )
    for text in TEXTS[-3:]:
        row = dict.fromkeys((*COLUMNS, "study", "id", "kind", "verdict"), text)
        shown = pages.get_template("values.html.j2").render(
            page="values.html", studies=[], up="", rows=[row], whole=True, pdf="report.pdf"
        )
        one = {
            "study": text,
            "subject": text,
            "built": True,
            "runs": [text],
            "settings": [{"key": text, "before": text, "now": [text]}],
            "outcomes": [{"name": text, "about": text, "before": text, "now": [text]}],
            "values": [],
            "figures": [{"name": text, "drawn": [(text, text)]}],
            "unsolved": {text: [text]},
        }
        shown += pages.get_template("comparison.html.j2").render(studies=[one], style="")
        assert text not in shown or "<" not in text
        assert "<script>alert" not in shown and "<img src=x" not in shown
        assert 'class="verdict "><' not in shown
