# Racing: CubeSats through rings, as published and as it should have been run.
from smallsat.studies.racing.parameters import course_files

RACING = "data/results/racing"
RACING_SECTION = config["racing"]
# Courses of the user's own, read by every command with the parameters.
RACING_COURSE_FILES = course_files(config)
RACING_SCENARIOS = ["scenario-1", "scenario-2"]
RACING_SHARDS = 2
RACING_PARTS = ["races.csv", "rings.csv", "segments.csv", "trajectories.parquet", "seconds.csv"]

# What each command of the study makes, with the arguments that it takes.
RACING_RUNS = {
    "courses": (
        "courses",
        "",
        [
            *[f"course-{scenario}.csv" for scenario in RACING_SCENARIOS],
            "start-positions.csv",
            "days-as-seeds.csv",
        ],
    ),
    **{
        f"{command}-{scenario}": (
            command,
            f"--scenario {scenario}",
            [f"{command}-{scenario}-{part}" for part in [*RACING_PARTS, *parts]],
        )
        for command, parts in (("as-published", []), ("optima", ["not-converged.csv"]))
        for scenario in RACING_SCENARIOS
    },
    "variants": ("variants", "", ["variants.csv"]),
    "checks": (
        "checks",
        "",
        [
            *["meshes.csv", "other-starts.csv", "thrust-sweep.csv", "random-positions.csv"],
            "checks-not-converged.csv",
        ],
    ),
    "dynamic-programming": (
        "dynamic-programming",
        "",
        ["dynamic-programming.csv", "dynamic-programming-not-converged.csv"],
    ),
    **{
        f"random-courses-{shard}": (
            "random",
            f"--shard {shard} --shards {RACING_SHARDS}",
            [f"random-courses-{shard}{part}.csv" for part in ("", "-seconds", "-not-converged")],
        )
        for shard in range(RACING_SHARDS)
    },
}
# Seconds differ from run to run, so nothing that is judged depends on them.
RACING_TABLES = [
    f"{RACING}/{name}"
    for _, _, names in RACING_RUNS.values()
    for name in names
    if "seconds" not in name
]
RACING_MERGED = [
    f"{RACING}/{name}"
    for name in ("races.csv", "rings.csv", "random-courses.csv", "observations.csv")
]

STUDY_RESULTS["racing"] = [*RACING_MERGED, *RACING_TABLES, *RACING_COURSE_FILES]

# Figures of each notebook run: few, so that one figure alone is made in seconds.
RACING_COURSES = {"scenario-1": ["fig-01", "fig-02"], "scenario-2": ["fig-07", "fig-08"]}
RACING_PATHS = {
    "scenario-1": {"Eeny": "fig-03", "Meeny": "fig-04", "Miny": "fig-05", "Mo": "fig-06"},
    "scenario-2": {"Eeny": "fig-09", "Meeny": "fig-10", "Miny": "fig-11", "Mo": "fig-12"},
}
# The first segment's figure and the number of segments that the document draws.
RACING_SEGMENTS = {"scenario-1": (13, 23), "scenario-2": (36, 26)}
# A course with fewer rings has fewer segments to draw.
RACING_LAST = {
    name: race.course.rings + 1 for name, race in racing_parameters(RACING_SECTION).races.items()
}
LEFT_OUT += [
    f"figures/racing/fig-{start + segment:02d}.svg"
    for scenario, (start, count) in RACING_SEGMENTS.items()
    for segment in range(RACING_LAST[scenario], count)
]
RACING_SEGMENTS = {
    scenario: (start, min(count, RACING_LAST[scenario]))
    for scenario, (start, count) in RACING_SEGMENTS.items()
}
RACING_GROUP = 7
RACING_GROUPS = {
    f"{scenario}-segments-{first}": (
        scenario,
        {
            f"fig-{start + segment:02d}": segment
            for segment in range(first, min(first + RACING_GROUP, count))
        },
    )
    for scenario, (start, count) in RACING_SEGMENTS.items()
    for first in range(0, count, RACING_GROUP)
}
RACING_BEYOND = ["missed-rings", "scores", "random-courses", "meshes", "thrust"]
RACING_DRAWING = NOTEBOOK_SOURCES + sources(
    "smallsat.studies.racing.figures.drawing",
    "smallsat.studies.racing.figures.plots",
    "smallsat.studies.racing.evidence.scores",
    "smallsat.drawing.figure",
    "smallsat.drawing.style",
    "smallsat.results",
)


for name, (command, arguments, files) in RACING_RUNS.items():

    rule:
        name:
            f"racing_{name.replace('-', '_')}"
        input:
            sources=sources("smallsat.studies.racing.steps"),
            courses=RACING_COURSE_FILES,
        output:
            [f"{RACING}/{file}" for file in files],
        log:
            f"logs/racing/{name}.log",
        benchmark:
            f"logs/racing/{name}.benchmark.tsv"
        params:
            command=command,
            arguments=arguments,
            config=as_json(RACING_SECTION),
            folder=lambda _, output: os.path.dirname(output[0]),
        message:
            f"racing: {name}"
        shell:
            "python -m smallsat.studies.racing.steps {params.command} --config {params.config:q}"
            " --output-folder {params.folder} {params.arguments} > {log} 2>&1"


rule racing_observations:
    input:
        sources=sources("smallsat.studies.racing.steps"),
        courses=RACING_COURSE_FILES,
        tables=RACING_TABLES,
        seconds=[f"{RACING}/{kind}-scenario-2-seconds.csv" for kind in ("as-published", "optima")],
    output:
        RACING_MERGED,
        f"{RACING}/not-converged.csv",
        f"{RACING}/timings.csv",
    log:
        "logs/racing/observations.log",
    benchmark:
        "logs/racing/observations.benchmark.tsv"
    params:
        config=as_json(RACING_SECTION),
        folder=lambda _, output: os.path.dirname(output[0]),
    message:
        "racing: put the races together, observe the published values"
    shell:
        "python -m smallsat.studies.racing.steps observe --config {params.config:q}"
        " --output-folder {params.folder} > {log} 2>&1"


for scenario, figures in RACING_COURSES.items():

    rule:
        name:
            f"racing_course_{scenario.replace('-', '_')}"
        input:
            notebook=project("notebooks/racing/course.ipynb"),
            sources=RACING_DRAWING,
            tables=[
                f"{RACING}/course-{scenario}.csv",
                f"{RACING}/optima-{scenario}-trajectories.parquet",
                f"{RACING}/as-published-{scenario}-trajectories.parquet",
                f"{RACING}/races.csv",
            ],
        output:
            figure_files(*[f"figures/racing/{figure}" for figure in figures]),
            notebook=f"{RACING}/notebooks/course-{scenario}.ipynb",
        log:
            f"logs/racing/course-{scenario}.log",
        benchmark:
            f"logs/racing/course-{scenario}.benchmark.tsv"
        params:
            parameters=as_json(
                {
                    "results": RACING,
                    "scenario": scenario,
                    "folder": "figures/racing",
                    "figures": dict(zip(["course", "race"], figures, strict=True)),
                }
            ),
        message:
            f"racing: draw the course of {scenario}"
        shell:
            NOTEBOOK


for scenario, figures in RACING_PATHS.items():

    rule:
        name:
            f"racing_paths_{scenario.replace('-', '_')}"
        input:
            notebook=project("notebooks/racing/paths.ipynb"),
            sources=RACING_DRAWING,
            tables=[
                f"{RACING}/course-{scenario}.csv",
                f"{RACING}/optima-{scenario}-trajectories.parquet",
                f"{RACING}/as-published-{scenario}-trajectories.parquet",
            ],
        output:
            figure_files(*[f"figures/racing/{figure}" for figure in figures.values()]),
            notebook=f"{RACING}/notebooks/paths-{scenario}.ipynb",
        log:
            f"logs/racing/paths-{scenario}.log",
        benchmark:
            f"logs/racing/paths-{scenario}.benchmark.tsv"
        params:
            parameters=as_json(
                {
                    "results": RACING,
                    "scenario": scenario,
                    "folder": "figures/racing",
                    "figures": figures,
                }
            ),
        message:
            f"racing: draw the trajectories of {scenario}"
        shell:
            NOTEBOOK


for name, (scenario, figures) in RACING_GROUPS.items():

    rule:
        name:
            f"racing_{name.replace('-', '_')}"
        input:
            notebook=project("notebooks/racing/segments.ipynb"),
            sources=RACING_DRAWING,
            tables=[
                f"{RACING}/course-{scenario}.csv",
                f"{RACING}/optima-{scenario}-trajectories.parquet",
                f"{RACING}/as-published-{scenario}-trajectories.parquet",
            ],
        output:
            figure_files(*[f"figures/racing/{figure}" for figure in figures]),
            notebook=f"{RACING}/notebooks/{name}.ipynb",
        log:
            f"logs/racing/{name}.log",
        benchmark:
            f"logs/racing/{name}.benchmark.tsv"
        params:
            parameters=as_json(
                {
                    "results": RACING,
                    "scenario": scenario,
                    "folder": "figures/racing",
                    "figures": figures,
                }
            ),
        message:
            f"racing: draw {name}"
        shell:
            NOTEBOOK


rule racing_beyond:
    input:
        notebook=project("notebooks/racing/beyond.ipynb"),
        sources=RACING_DRAWING,
        tables=[
            f"{RACING}/{name}.csv"
            for name in ("races", "rings", "random-courses", "meshes", "thrust-sweep")
        ],
    output:
        figure_files(*[f"figures/racing/{figure}" for figure in RACING_BEYOND]),
        scores=f"{RACING}/scores.csv",
        missed=f"{RACING}/missed-rings.csv",
        notebook=f"{RACING}/notebooks/beyond.ipynb",
    log:
        "logs/racing/beyond.log",
    benchmark:
        "logs/racing/beyond.benchmark.tsv"
    params:
        parameters=as_json({"results": RACING, "folder": "figures/racing"}),
    message:
        "racing: draw what goes beyond the document"
    shell:
        NOTEBOOK


RACING_FILMS = {"scenario-1": "animation-1", "scenario-2": "animation-2"}

for scenario, film in RACING_FILMS.items():
    ANIMATIONS.append(f"figures/racing/{film}.mp4")

    rule:
        name:
            f"racing_film_{scenario.replace('-', '_')}"
        input:
            notebook=project("notebooks/racing/animation.ipynb"),
            sources=NOTEBOOK_SOURCES
            + sources("smallsat.studies.racing.figures.animation", "smallsat.drawing.style", "smallsat.results"),
            tables=[
                f"{RACING}/course-{scenario}.csv",
                f"{RACING}/optima-{scenario}-trajectories.parquet",
                f"{RACING}/as-published-{scenario}-trajectories.parquet",
            ],
        output:
            f"figures/racing/{film}.mp4",
            notebook=f"{RACING}/notebooks/{film}.ipynb",
        log:
            f"logs/racing/{film}.log",
        benchmark:
            f"logs/racing/{film}.benchmark.tsv"
        params:
            parameters=as_json(
                {
                    "section": RACING_SECTION,
                    "results": RACING,
                    "scenario": scenario,
                    "film": f"figures/racing/{film}.mp4",
                }
            ),
        message:
            f"racing: film {scenario}"
        shell:
            NOTEBOOK


rule racing:
    input:
        targets("racing", "table", "figure"),
        figure_files(*[f"figures/racing/{figure}" for figure in RACING_BEYOND]),
        RACING_TABLES,
        f"{RACING}/verdicts.csv",
        f"{RACING}/errata.csv",
        f"{RACING}/claims.csv",
    log:
        "logs/racing/racing.log",
    message:
        "racing: all tables, figures and verdicts are there"
