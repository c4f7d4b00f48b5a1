# Notebooks, run by papermill: which draws what, from which results, says notebooks/<study>/figures.yaml.

for study in STUDIES:
    for run in [run for run in RUNS[study] if run.figures or run.film]:
        MADE[study] += [*figure_files(*run.stems), *results(study, *run.makes)]
        ANIMATIONS += [f"figures/{study}/{run.film}.mp4"] * bool(run.film)

        rule:
            name:
                rule_name(study, run.name)
            input:
                notebook=project(f"notebooks/{study}/{run.notebook}.ipynb"),
                sources=sources(
                    "smallsat.workflow.notebook",
                    *notebook_modules(ROOT / f"notebooks/{study}/{run.notebook}.ipynb"),
                ),
                published=published_files(study, "values.csv") if run.published else [],
                results=results(study, *run.reads),
            output:
                figure_files(*run.stems),
                [f"figures/{study}/{run.film}.mp4"] * bool(run.film),
                results(study, *run.makes),
                notebook=f"data/results/{study}/notebooks/{run.film or run.name}.ipynb",
            log:
                f"logs/{study}/{run.name}.log",
            benchmark:
                f"logs/{study}/{run.name}.benchmark.tsv"
            priority: urgency(rule_name(study, run.name))
            params:
                parameters=as_json(
                    run.given(
                        CONFIG[study],
                        f"data/results/{study}",
                        project(f"data/published/{study}"),
                    )
                ),
            message:
                f"{study}: draw {run.name}"
            shell:
                NOTEBOOK
