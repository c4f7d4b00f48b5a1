# A target that no rule makes is answered with what there is. This file is included last.
import difflib

KNOWN_FILES = {str(path) for rule in workflow.rules for path in rule.output}
KNOWN_WORDS = {rule.name for rule in workflow.rules if not rule.output}


def refuse(wildcards):
    target = wildcards.target
    known = KNOWN_FILES if "/" in target else KNOWN_WORDS
    folder = os.path.dirname(target)
    suffix = os.path.splitext(target)[1]
    beside = sorted(
        os.path.basename(path)
        for path in known
        if os.path.dirname(path) == folder and path.endswith(suffix)
    )
    close = difflib.get_close_matches(target, known, n=1)
    hint = f"did you mean '{close[0]}'?" if close else "`snakemake --list` names all rules"
    if folder and beside:
        allowed = f"{folder} has {', '.join(beside[:3])}, ... {beside[-1]}"
    elif folder:
        allowed = "nothing is made in that folder"
    else:
        allowed = (
            f"studies: {', '.join(STUDIES)}; also {', '.join(sorted(KNOWN_WORDS - set(STUDIES)))}"
        )
    sys.exit(f"smallsat: target '{target}': unknown; {allowed}; {hint}")


rule unknown_target:
    input:
        refuse,
    output:
        "{target}",
    log:
        "logs/unknown/{target}.log",
    wildcard_constraints:
        target="(?!(?:{})$)(?:[A-Za-z_-]+|figures/.+|data/results/.+|report/build/.+)".format(
            "|".join(re.escape(path) for path in sorted(KNOWN_FILES))
        ),
    shell:
        "false > {log}"
