"""Two bodies of the rendezvous study's truth by Basilisk, as a reference for the tests.

Run with `python tests/references/basilisk_orbits.py` where the wheel `bsk` is installed; see the
README beside it. Settings are those of `orbits.yaml` and the gravity coefficients of the package;
gravity in spherical harmonics, air, wind and drag on facets are Basilisk's. It writes
`basilisk-orbits.csv`.
"""

import runpy
from pathlib import Path

import numpy as np
import yaml
from Basilisk.architecture import messaging, sysModel
from Basilisk.simulation import (
    exponentialAtmosphere,
    facetDragDynamicEffector,
    gravityEffector,
    spacecraft,
    sphericalHarmonicsGravityModel,
    zeroWindModel,
)
from Basilisk.utilities import RigidBodyKinematics, SimulationBaseClass, macros

HERE = Path(__file__).parent
SETTINGS = yaml.safe_load((HERE / "orbits.yaml").read_text())
TRUTH = SETTINGS["truth"]
FIELD = runpy.run_path(str(HERE.parents[1] / "src/smallsat/dynamics/environment/egm96.py"))
BODIES = ("target", "chaser")

# Basilisk holds air and wind over a step, and turns the planet linearly in it.
STEP_S = 0.05
# Rows of the table are so many seconds apart.
RECORD_S = 600.0


def gravity():
    """The gravity field, cut as the settings say."""
    degree, order = TRUTH["gravity_degree"], TRUTH["gravity_order"]
    c = [[0.0] * (n + 1) for n in range(degree + 1)]
    s = [[0.0] * (n + 1) for n in range(degree + 1)]
    c[0][0] = 1.0
    for n, m, cosine, sine in FIELD["COEFFICIENTS"]:
        if n <= degree and m <= order:
            c[n][m], s[n][m] = cosine, sine
    model = sphericalHarmonicsGravityModel.SphericalHarmonicsGravityModel()
    model.maxDeg = degree
    model.cBar, model.sBar = gravityEffector.MultiArray(c), gravityEffector.MultiArray(s)
    body = gravityEffector.GravBodyData()
    body.planetName = "earth"
    body.mu, body.radEquator = FIELD["MU"], FIELD["RADIUS"]
    body.isCentralBody = True
    body.gravityModel = model
    return body


class Surroundings(sysModel.SysModel):
    """Turns the Earth, and each body with its Hill frame, before every step."""

    def __init__(self, bodies):
        super().__init__()
        self.bodies = bodies
        self.planetOutMsg = messaging.SpicePlanetStateMsg()

    def UpdateState(self, time):
        """Write the Earth's attitude at the time, and set the bodies' for the step up to it."""
        rate = SETTINGS["earth_rate_rad_s"]
        angle = np.radians(TRUTH["earth_angle_deg"]) + rate * time * macros.NANO2SEC
        c, s = np.cos(angle), np.sin(angle)
        payload = messaging.SpicePlanetStateMsgPayload()
        payload.PlanetName = "earth"
        payload.computeOrient = 1
        payload.J20002Pfix = [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]
        payload.J20002Pfix_dot = [
            [-rate * s, rate * c, 0.0],
            [-rate * c, -rate * s, 0.0],
            [0.0] * 3,
        ]
        self.planetOutMsg.write(payload, time, self.moduleID)
        for body in self.bodies:
            state = body.scStateOutMsg.read()
            r, v = np.array(state.r_BN_N), np.array(state.v_BN_N)
            h = np.cross(r, v)
            radial, normal = r / np.linalg.norm(r), h / np.linalg.norm(h)
            frame = np.array([radial, np.cross(normal, radial), normal])
            turn = [[0.0], [0.0], [np.linalg.norm(h) / (r @ r)]]
            attitude = RigidBodyKinematics.C2MRP(frame)[:, None].tolist()
            body.dynManager.getStateObject(body.hub.nameOfHubSigma).setState(attitude)
            body.dynManager.getStateObject(body.hub.nameOfHubOmega).setState(turn)


def facets(drag, coefficient):
    """The six faces of the box, with the axes of the Hill frame."""
    size = [TRUTH["body_size_m"][name] for name in ("radial", "along", "normal")]
    for axis, (one, other) in enumerate([(1, 2), (0, 2), (0, 1)]):
        for sign in (1.0, -1.0):
            normal = sign * np.eye(3)[axis]
            drag.addFacet(size[one] * size[other], coefficient, normal, np.zeros(3))


def simulate(with_drag):
    """Times, s, and inertial states of both bodies, (n, 13), every `RECORD_S`."""
    simulation = SimulationBaseClass.SimBaseClass()
    process = simulation.CreateNewProcess("process")
    process.addTask(simulation.CreateNewTask("task", macros.sec2nano(STEP_S)))
    bodies = [spacecraft.Spacecraft() for _ in BODIES]
    surroundings = Surroundings(bodies)
    simulation.AddModelToTask("task", surroundings, 200)
    alive, records = [], []
    for name, body in zip(BODIES, bodies, strict=True):
        body.ModelTag = name
        body.hub.mHub = SETTINGS["mass_kg"]
        body.hub.IHubPntBc_B = np.eye(3).tolist()
        body.hub.r_CN_NInit, body.hub.v_CN_NInit = np.split(np.array(SETTINGS["states"][name]), 2)
        planet = gravity()
        planet.planetBodyInMsg.subscribeTo(surroundings.planetOutMsg)
        body.gravField.gravBodies = spacecraft.GravBodyVector([planet])
        simulation.AddModelToTask("task", body, 100)
        if with_drag:
            alive += air(simulation, name, body, surroundings)
        records.append(body.scStateOutMsg.recorder(macros.sec2nano(RECORD_S)))
        simulation.AddModelToTask("task", records[-1], 0)
        alive.append(planet)
    simulation.InitializeSimulation()
    simulation.ConfigureStopTime(macros.sec2nano(SETTINGS["duration_s"]))
    simulation.ExecuteSimulation()
    states = [part for one in records for part in (one.r_BN_N, one.v_BN_N)]
    return np.column_stack([records[0].times() * macros.NANO2SEC, *states])


def air(simulation, name, body, surroundings):
    """Air and wind at a body, and its drag; what must be kept alive."""
    atmosphere = exponentialAtmosphere.ExponentialAtmosphere()
    atmosphere.planetRadius = SETTINGS["air"]["radius_m"]
    atmosphere.baseDensity = SETTINGS["air"]["density_kg_m3"]
    atmosphere.scaleHeight = SETTINGS["air"]["scale_height_m"]
    # Heights are counted from the orbit's, and may be negative.
    atmosphere.envMinReach = -1e6
    wind = zeroWindModel.ZeroWindModel()
    wind.setPlanetOmega_N(np.array([0.0, 0.0, SETTINGS["earth_rate_rad_s"]]))
    drag = facetDragDynamicEffector.FacetDragDynamicEffector()
    facets(drag, TRUTH["drag_coefficient"][name])
    for model in (atmosphere, wind):
        model.addSpacecraftToModel(body.scStateOutMsg)
        model.planetPosInMsg.subscribeTo(surroundings.planetOutMsg)
        simulation.AddModelToTask("task", model, 150)
    drag.atmoDensInMsg.subscribeTo(atmosphere.envOutMsgs[0])
    drag.windVelInMsg.subscribeTo(wind.envOutMsgs[0])
    body.addDynamicEffector(drag)
    simulation.AddModelToTask("task", drag, 140)
    return [atmosphere, wind, drag]


def main():
    """Make both runs and write the table."""
    names = [f"{body}_{axis}" for body in BODIES for axis in ("x", "y", "z", "vx", "vy", "vz")]
    lines = [",".join(["run", "time_s", *names])]
    for run, with_drag in (("field", False), ("field and drag", True)):
        for row in simulate(with_drag):
            lines.append(",".join([run, *(f"{value:.16g}" for value in row)]))
    (HERE / "basilisk-orbits.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
