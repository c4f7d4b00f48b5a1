# What stays on the machine that Snakemake runs on while a cluster has the rest (docs/scale.md): rules
# that took less than a minute in the accepted build, which a place in a queue would only slow down.
# The length of shards is the configuration's, and they are what a cluster is for.
SMALL_S = 60.0

workflow.localrules(
    *[
        made.name
        for made in workflow.rules
        if TOOK.get(made.name, SMALL_S) < SMALL_S and not re.search(r"_\d+_of_\d+$", made.name)
    ]
)
