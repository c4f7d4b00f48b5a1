# A target that nothing makes is answered with what there is. This file is included last.

KNOWN_FILES = {str(path) for known in workflow.rules for path in known.output}
KNOWN_WORDS = {known.name for known in workflow.rules if not known.output}


rule unknown_target:
    input:
        lambda w: sys.exit(f"smallsat: {refusal(w.target, KNOWN_FILES, KNOWN_WORDS, STUDIES)}"),
    output:
        "{target}",
    log:
        "logs/unknown/{target}.log",
    wildcard_constraints:
        target="(?!(?:{})$)(?:[A-Za-z_-]+|figures/.+|data/results/.+|report/build/.+)".format(
            "|".join(re.escape(path) for path in sorted(KNOWN_FILES))
        ),
    message:
        "No such target"
    shell:
        "false > {log}"
