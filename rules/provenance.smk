# The record of a finished build, which `make verify` holds it against. A what-if run has none: much of
# what it rests on lies outside of its folder.
if not WHAT_IF:

    rule crate:
        input:
            sources=sources("smallsat.workflow.crate"),
            # What no job declares as its input, and belongs to the build all the same; by whole
            # paths, since some of the names by themselves would pass for those of targets.
            besides=[
                str(path)
                for pattern in (
                    "Snakefile",
                    "rules/*.smk",
                    "config/default/*.yaml",
                    "requirements.lock",
                    "pyproject.toml",
                    "CITATION.cff",
                    "LICENSE",
                    "codecheck.yml",
                    "README.md",
                    "data/results/README.md",
                    "figures/README.md",
                )
                for path in sorted(ROOT.glob(pattern))
            ],
            built=BUILT,
        output:
            "ro-crate-metadata.json",
        log:
            "logs/crate.log",
        benchmark:
            "logs/crate.benchmark.tsv"
        message:
            "Record what was built, from what and how, with hashes"
        shell:
            "python -m smallsat crate {input.built} --besides {input.besides:q} --output {output}"
            " > {log} 2>&1"
