# The orbit-transfer study: solved cases, observations, figures.

TRANSFER = "data/results/transfer"
TRANSFER_CONFIG = as_json(config["transfer"])
TRANSFER_SHARDS = [1, *config["transfer"]["intervals"]]

STUDY_RESULTS["transfer"] = [
    f"{TRANSFER}/{name}.csv"
    for name in (
        "observations",
        "indirect",
        "as-published",
        "converged",
        "continuous",
        "multistart",
        "early-stopping",
    )
] + [f"{TRANSFER}/indirect.parquet"]


# Cases, trajectories and seconds of each run.
CASE_FILES = {
    name: [f"{TRANSFER}/{name}{suffix}" for suffix in (".csv", ".parquet", "-seconds.csv")]
    for name in (
        "indirect",
        "as-published",
        "converged",
        "continuous",
        "multistart",
        *[f"as-published-k{k}" for k in TRANSFER_SHARDS],
    )
}


# Cases of ours that nothing solved.
UNSOLVED = {
    name: f"{TRANSFER}/{name}-not-converged.csv"
    for name in ("indirect", "converged", "continuous", "multistart", "collocation")
}


for experiment in ("indirect", "converged", "continuous"):

    rule:
        name:
            f"transfer_{experiment}"
        input:
            sources("smallsat.studies.transfer.solve"),
        output:
            CASE_FILES[experiment],
            UNSOLVED[experiment],
        log:
            f"logs/transfer/{experiment}.log",
        benchmark:
            f"logs/transfer/{experiment}.benchmark.tsv"
        params:
            experiment=experiment,
            config=TRANSFER_CONFIG,
        message:
            f"transfer: solve the {experiment} cases"
        shell:
            "python -m smallsat.studies.transfer.solve {params.experiment} --config {params.config:q}"
            f" --results {TRANSFER} > {{log}} 2>&1"


rule transfer_multistart:
    input:
        sources("smallsat.studies.transfer.solve"),
    output:
        CASE_FILES["multistart"],
        f"{TRANSFER}/multistart-starts.csv",
        UNSOLVED["multistart"],
    log:
        "logs/transfer/multistart.log",
    benchmark:
        "logs/transfer/multistart.benchmark.tsv"
    params:
        config=TRANSFER_CONFIG,
    message:
        "transfer: search the best single polynomials from many starts"
    shell:
        "python -m smallsat.studies.transfer.solve multistart --config {params.config:q}"
        f" --results {TRANSFER} > {{log}} 2>&1"


# One shard for each number of intervals.
for intervals in TRANSFER_SHARDS:

    rule:
        name:
            f"transfer_as_published_k{intervals}"
        input:
            sources("smallsat.studies.transfer.solve"),
        output:
            CASE_FILES[f"as-published-k{intervals}"],
        log:
            f"logs/transfer/as-published-k{intervals}.log",
        benchmark:
            f"logs/transfer/as-published-k{intervals}.benchmark.tsv"
        # The largest shard decides when the study is done: start it first.
        priority: intervals
        params:
            intervals=intervals,
            config=TRANSFER_CONFIG,
        message:
            f"transfer: solve as published, K = {intervals}"
        shell:
            "python -m smallsat.studies.transfer.solve as-published --config {params.config:q}"
            " --intervals {params.intervals}"
            f" --results {TRANSFER} > {{log}} 2>&1"


rule transfer_gather:
    input:
        sources("smallsat.studies.transfer.observe"),
        shards=[CASE_FILES[f"as-published-k{k}"] for k in TRANSFER_SHARDS],
        ledger=project("data/published/values.csv"),
    output:
        CASE_FILES["as-published"],
        f"{TRANSFER}/early-stopping.csv",
    log:
        "logs/transfer/gather.log",
    benchmark:
        "logs/transfer/gather.benchmark.tsv"
    params:
        intervals=as_json(TRANSFER_SHARDS),
    message:
        "transfer: gather the as-published cases, compare with Table 4"
    shell:
        "python -m smallsat.studies.transfer.observe gather --intervals {params.intervals:q}"
        f" --results {TRANSFER} > {{log}} 2>&1"


rule transfer_collocation:
    input:
        sources("smallsat.studies.transfer.solve"),
    output:
        f"{TRANSFER}/collocation.csv",
        f"{TRANSFER}/collocation-seconds.csv",
        UNSOLVED["collocation"],
    log:
        "logs/transfer/collocation.log",
    benchmark:
        "logs/transfer/collocation.benchmark.tsv"
    params:
        config=TRANSFER_CONFIG,
    message:
        "transfer: solve by collocation"
    shell:
        "python -m smallsat.studies.transfer.solve collocation --config {params.config:q}"
        f" --results {TRANSFER} > {{log}} 2>&1"


rule transfer_observations:
    input:
        sources("smallsat.studies.transfer.observe"),
        cases=[
            CASE_FILES[name]
            for name in ("indirect", "as-published", "converged", "multistart", "continuous")
        ],
        unsolved=UNSOLVED.values(),
        ledger=project("data/published/values.csv"),
    output:
        f"{TRANSFER}/observations.csv",
        f"{TRANSFER}/not-converged.csv",
        f"{TRANSFER}/timings.csv",
    log:
        "logs/transfer/observations.log",
    benchmark:
        "logs/transfer/observations.benchmark.tsv"
    params:
        published=lambda w, input: os.path.dirname(input.ledger),
    message:
        "transfer: observe the published values"
    shell:
        "python -m smallsat.studies.transfer.observe values --published {params.published}"
        f" --results {TRANSFER} > {{log}} 2>&1"


# --- figures -------------------------------------------------------------------------------------

# The document's own cases, in the order of its figures 5 to 64: two figures a case.
DOCUMENT_DEGREES, DOCUMENT_INTERVALS = range(2, 7), (2, 4, 8, 16)
TRANSFER_FIGURES = [
    ("indirect", 0, 1),
    *[("indirect", 0, k) for k in DOCUMENT_INTERVALS],
    *[("direct", n, 1) for n in DOCUMENT_DEGREES],
    *[("direct", n, k) for n in DOCUMENT_DEGREES for k in DOCUMENT_INTERVALS],
]


# Trajectories of a case, the document's kind of run first.
TRAJECTORIES = {
    ("indirect", 1): [f"{TRANSFER}/indirect.parquet"],
    ("direct", 1): [f"{TRANSFER}/as-published-k1.parquet", f"{TRANSFER}/multistart.parquet"],
}
for k in DOCUMENT_INTERVALS:
    TRAJECTORIES["indirect", k] = [f"{TRANSFER}/indirect.parquet"]
    TRAJECTORIES["direct", k] = [
        f"{TRANSFER}/as-published-k{k}.parquet",
        f"{TRANSFER}/converged.parquet",
    ]


for place, (method, degree, intervals) in enumerate(TRANSFER_FIGURES):
    stems = [f"figures/transfer/fig-{5 + 2 * place + i:02d}" for i in range(2)]
    # A what-if run may leave out cases of the document; their figures are left out with them.
    if (degree and degree not in config["transfer"]["degrees"]) or (
        intervals > 1 and intervals not in config["transfer"]["intervals"]
    ):
        LEFT_OUT += [f"{stem}.svg" for stem in stems]
        continue
    case = f"{method}-n{degree}-k{intervals}"

    rule:
        name:
            f"transfer_figures_{case}".replace("-", "_")
        input:
            notebook=project("notebooks/transfer/case.ipynb"),
            sources=NOTEBOOK_SOURCES
            + sources("smallsat.studies.transfer.figures.cases", "smallsat.drawing.figure"),
            trajectories=TRAJECTORIES[method, intervals],
        output:
            figure_files(*stems),
            notebook=f"{TRANSFER}/notebooks/{case}.ipynb",
        log:
            f"logs/transfer/figures-{case}.log",
        benchmark:
            f"logs/transfer/figures-{case}.benchmark.tsv"
        params:
            parameters=as_json(
                {
                    "method": method,
                    "degree": degree,
                    "intervals": intervals,
                    "trajectories": TRAJECTORIES[method, intervals],
                    "states_stem": stems[0],
                    "control_stem": stems[1],
                }
            ),
        message:
            f"transfer: draw states and control of {case}"
        shell:
            NOTEBOOK


rule transfer_schematics:
    input:
        notebook=project("notebooks/transfer/schematics.ipynb"),
        sources=NOTEBOOK_SOURCES + sources("smallsat.studies.transfer.figures.schematics", "smallsat.drawing.figure"),
        trajectories=f"{TRANSFER}/indirect.parquet",
    output:
        figure_files(*[f"figures/transfer/fig-{n:02d}" for n in range(1, 5)]),
        notebook=f"{TRANSFER}/notebooks/schematics.ipynb",
    log:
        "logs/transfer/schematics.log",
    benchmark:
        "logs/transfer/schematics.benchmark.tsv"
    params:
        parameters=lambda w, input: as_json(
            {
                "problem": config["transfer"]["problem"],
                "trajectories": input.trajectories,
                "stems": [f"figures/transfer/fig-{n:02d}" for n in range(1, 5)],
            }
        ),
    message:
        "transfer: draw the schematics"
    shell:
        NOTEBOOK


rule transfer_comparisons:
    input:
        notebook=project("notebooks/transfer/comparisons.ipynb"),
        sources=NOTEBOOK_SOURCES
        + sources(
            "smallsat.studies.transfer.figures.comparisons",
            "smallsat.studies.transfer.results",
            "smallsat.drawing.figure",
        ),
        results=[path for path in STUDY_RESULTS["transfer"] if "observations" not in path]
        + [f"{TRANSFER}/as-published.parquet", f"{TRANSFER}/converged.parquet"],
        ledger=project("data/published/values.csv"),
    output:
        figure_files(*[f"figures/transfer/fig-{n}" for n in range(65, 71)]),
        notebook=f"{TRANSFER}/notebooks/comparisons.ipynb",
    log:
        "logs/transfer/comparisons.log",
    benchmark:
        "logs/transfer/comparisons.benchmark.tsv"
    params:
        parameters=as_json({"results": TRANSFER}),
    message:
        "transfer: draw the comparisons"
    shell:
        NOTEBOOK


TRANSFER_EXTRAS = [
    f"figures/transfer/{name}.svg" for name in ("early-stopping", "continuity", "multistart")
]


rule transfer_beyond:
    input:
        notebook=project("notebooks/transfer/beyond.ipynb"),
        sources=NOTEBOOK_SOURCES
        + sources(
            "smallsat.studies.transfer.figures.comparisons",
            "smallsat.studies.transfer.results",
            "smallsat.drawing.figure",
        ),
        results=[path for path in STUDY_RESULTS["transfer"] if "observations" not in path],
        starts=f"{TRANSFER}/multistart-starts.csv",
        collocation=[f"{TRANSFER}/collocation.csv", f"{TRANSFER}/collocation-seconds.csv"],
        seconds=[
            f"{TRANSFER}/{name}-seconds.csv"
            for name in ("indirect", "multistart", "converged", "continuous")
        ],
        ledger=project("data/published/values.csv"),
    output:
        figure_files(*[path.removesuffix(".svg") for path in TRANSFER_EXTRAS]),
        tables=[
            f"{TRANSFER}/tables/{name}.csv"
            for name in ("methods", "methods-seconds", "prose-against-table-4")
        ],
        notebook=f"{TRANSFER}/notebooks/beyond.ipynb",
    log:
        "logs/transfer/beyond.log",
    benchmark:
        "logs/transfer/beyond.benchmark.tsv"
    params:
        parameters=as_json({"results": TRANSFER}),
    message:
        "transfer: draw what goes beyond the document"
    shell:
        NOTEBOOK


rule transfer:
    input:
        targets("transfer", "table", "figure"),
        TRANSFER_EXTRAS,
        rules.transfer_beyond.output.tables,
        f"{TRANSFER}/verdicts.csv",
        f"{TRANSFER}/timings.csv",
    log:
        "logs/transfer/all.log",
    message:
        "transfer: all tables, figures and verdicts are there"
