"""What models, meshes and plans are called in tables and figures."""

from smallsat.studies.slew.configuration import Configuration
from smallsat.studies.slew.methods.bound import impossible
from smallsat.studies.slew.parameters import Parameters

WHEELS, EULER = "wheels' momentum", "Euler's equation alone"
# Whether the wheels' momentum takes part in the gyroscopic torque.
MODELS = {WHEELS: True, EULER: False}
# The document's mesh and ours.
ONE_SEGMENT, SEGMENTS = "one segment", "segments"
# The models that a turn's figures show. About one axis there is no gyroscopic torque in either.
SHOWN = {"quarter": (WHEELS,), "half": (WHEELS, EULER)}


def plan_names(
    parameters: Parameters, case: str, kind: str, model: str = WHEELS
) -> tuple[str, str]:
    """What the plan of a turn is called on a mesh: of least torque, and the least infeasible."""
    name = parameters.names[case]
    if model != WHEELS:
        name = f"{name}, {model}"
    return f"{name}, {kind}", f"{name}, least infeasible, {kind}"


def plan_titles(section: Configuration, case: str) -> list[dict[str, str]]:
    """Titles of a turn's plans on the document's mesh: by the plan's name, for each model shown.

    The plan of least torque comes first, which is shown if there is one.
    """
    parameters = Parameters.from_section(section)
    several = len(SHOWN[case]) > 1
    titles = []
    for model in SHOWN[case]:
        feasible, least = plan_names(parameters, case, ONE_SEGMENT, model)
        beyond_reach = impossible(parameters, case, parameters.duration, carried=MODELS[model])
        why = "no plan can reach" if beyond_reach else "none was found that reaches"
        titles.append(
            {
                feasible: model if several else "",
                least: f"{model}: least infeasible plan; {why} the target "
                f"in {parameters.duration:g} s",
            }
        )
    return titles
