"""Attitude runs of the Mars study by Basilisk, as a reference for the tests.

Run with `python tests/references/basilisk_attitude.py` where the wheel `bsk` is installed; see the
README beside it. Settings are those of `config/default/mars.yaml`, the equations and integrators
Basilisk's own. It writes `basilisk-attitude.csv`.
"""

from pathlib import Path

import numpy as np
import yaml
from Basilisk.architecture import messaging, sysModel
from Basilisk.fswAlgorithms import (
    attTrackingError,
    hillPoint,
    inertial3D,
    mrpFeedback,
    mrpPD,
    rwMotorTorque,
)
from Basilisk.simulation import (
    GravityGradientEffector,
    extForceTorque,
    reactionWheelStateEffector,
    simpleNav,
    spacecraft,
)
from Basilisk.utilities import (
    RigidBodyKinematics,
    SimulationBaseClass,
    macros,
    simIncludeGravBody,
    simIncludeRW,
)

HERE = Path(__file__).parent
SETTINGS = yaml.safe_load((HERE.parents[1] / "config/default/mars.yaml").read_text())["mars"]

# The control is computed once a step and held over it; the dynamics take finer steps, by the
# classical Runge-Kutta method, Basilisk's default.
DYNAMICS_STEP_S = 0.005
# Rows of the table are so many seconds apart.
RECORD_S = 50.0
# So small that the wheels' momentum is that relative to the body, kg m^2.
WHEEL_INERTIA = 1e-7
SUN_FRAME = np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
# From the Hill frame to the nadir frame.
NADIR_IN_HILL = np.diag([-1.0, 1.0, -1.0])

INERTIA = np.diag(SETTINGS["spacecraft"]["inertia_kg_m2"])
P_GAIN = 2.0 * INERTIA.max() / SETTINGS["requirements"]["largest_decay_time_s"]
K_GAIN = P_GAIN**2 / (
    SETTINGS["requirements"]["largest_damping_ratio"] ** 2 * np.diag(INERTIA).min()
)


class Orbit:
    """A circular orbit of the settings: state at time zero, and the gravity that makes its rate."""

    def __init__(self, name):
        entry = SETTINGS["orbits"][name]
        self.radius = 1e3 * (SETTINGS["orbits"]["mars_radius_km"] + entry["altitude_km"])
        self.rate = entry["rate_rad_s"]
        self.mu = self.rate**2 * self.radius**3
        angles = np.radians(
            [entry["raan_deg"], entry["inclination_deg"], entry["argument_of_latitude_deg"]]
        )
        frame = RigidBodyKinematics.euler3132C(angles)
        self.position = self.radius * frame[0]
        self.velocity = self.radius * self.rate * frame[1]


def craft(simulation, name, orbit):
    """A spacecraft on its orbit, with the body of the settings and its attitude at time zero."""
    body = spacecraft.Spacecraft()
    body.ModelTag = name
    body.hub.mHub = 1.0
    body.hub.IHubPntBc_B = INERTIA.tolist()
    body.hub.r_CN_NInit = orbit.position
    body.hub.v_CN_NInit = orbit.velocity
    body.hub.sigma_BNInit = SETTINGS["spacecraft"]["initial_mrp"]
    body.hub.omega_BN_BInit = np.radians(SETTINGS["spacecraft"]["initial_rate_deg_s"])
    factory = simIncludeGravBody.gravBodyFactory()
    planet = factory.createCustomGravObject(f"mars-{name}", mu=orbit.mu)
    planet.isCentralBody = True
    factory.addBodiesTo(body)
    simulation.AddModelToTask("dynamics", body, 100)
    navigation = simpleNav.SimpleNav()
    navigation.scStateInMsg.subscribeTo(body.scStateOutMsg)
    # The whole position is the truth: no error is set.
    simulation.AddModelToTask("dynamics", navigation, 90)
    return body, navigation, factory


class Mission(sysModel.SysModel):
    """The mission's references: Table 7 and Eqs. 19, 24, 28 and 32 to 34, from positions."""

    def __init__(self, nano, mothercraft):
        super().__init__()
        self.nano, self.mothercraft = nano, mothercraft
        self.attRefOutMsg = messaging.AttRefMsg()

    def UpdateState(self, time):
        """Write the reference of the time."""
        states = [message.read() for message in (self.nano, self.mothercraft)]
        pairs = [(np.array(s.r_BN_N), np.array(s.v_BN_N)) for s in states]
        frame, rate = self.reference(*pairs)
        payload = messaging.AttRefMsgPayload()
        payload.sigma_RN = RigidBodyKinematics.C2MRP(frame)
        payload.omega_RN_N = rate
        self.attRefOutMsg.write(payload, time, self.moduleID)

    @staticmethod
    def reference(lmo, gmo):
        """[RN] and its inertial rate for position and velocity of both spacecraft."""
        (r, v), (r_gmo, _) = lmo, gmo
        if r[1] > 0.0:
            return SUN_FRAME, np.zeros(3)
        separation = np.arccos(r @ r_gmo / np.linalg.norm(r) / np.linalg.norm(r_gmo))
        if separation > np.radians(SETTINGS["visibility_deg"]):
            normal = np.cross(r, v)
            radial, normal = r / np.linalg.norm(r), normal / np.linalg.norm(normal)
            hill = np.array([radial, np.cross(normal, radial), normal])
            return NADIR_IN_HILL @ hill, np.linalg.norm(v) / np.linalg.norm(r) * normal
        span = SETTINGS["frame_difference_s"]["control"]
        now, later = (
            communication(r_l, r_g)
            for r_l, r_g in zip(
                *((pair[0], ahead(*pair, span)) for pair in (lmo, gmo)), strict=True
            )
        )
        tilde = -(later - now) / span @ now.T
        return now, now.T @ np.array([-tilde[1, 2], tilde[0, 2], -tilde[0, 1]])


def ahead(r, v, span):
    """Position on a circular orbit a time later."""
    rate = np.linalg.norm(v) / np.linalg.norm(r)
    return np.cos(rate * span) * r + np.sin(rate * span) / rate * v


def communication(r_lmo, r_gmo):
    """[RcN] of two positions."""
    sight = r_gmo - r_lmo
    first, second = -sight, np.cross(sight, [0.0, 0.0, 1.0])
    first, second = first / np.linalg.norm(first), second / np.linalg.norm(second)
    return np.array([first, second, np.cross(first, second)])


def simulate(duration, torque=None, gravity_gradient=False, control=None, wheels=False):
    """One run: times, s, MRPs and rates, rad/s, (n, 7), every `RECORD_S`.

    ``torque`` is a constant one, N m; ``control`` a pair of the reference's name and a function
    that makes the law.
    """
    simulation = SimulationBaseClass.SimBaseClass()
    process = simulation.CreateNewProcess("process")
    process.addTask(simulation.CreateNewTask("dynamics", macros.sec2nano(DYNAMICS_STEP_S)), 20)
    process.addTask(simulation.CreateNewTask("control", macros.sec2nano(SETTINGS["step_s"])), 10)
    alive = [craft(simulation, name, Orbit(name)) for name in ("lmo", "gmo")]
    body = alive[0][0]
    if torque is not None:
        actuator = extForceTorque.ExtForceTorque()
        actuator.extTorquePntB_B = torque
        body.addDynamicEffector(actuator)
        simulation.AddModelToTask("dynamics", actuator, 110)
    if gravity_gradient:
        gradient = GravityGradientEffector.GravityGradientEffector()
        gradient.addPlanetName("mars-lmo")
        body.addDynamicEffector(gradient)
        simulation.AddModelToTask("dynamics", gradient, 110)
    law = None
    if control is not None:
        reference, make = control
        law, *rest = make()
        alive += rest + controlled(simulation, *alive, reference, law)
        alive += (turned_by_wheels if wheels else turned_from_outside)(simulation, body, law)
    record = body.scStateOutMsg.recorder(macros.sec2nano(RECORD_S))
    simulation.AddModelToTask("dynamics", record, 0)
    simulation.InitializeSimulation()
    simulation.ConfigureStopTime(0)
    simulation.ExecuteSimulation()
    if hasattr(law, "priorTime"):
        # A call at time zero counts as none, and the integral would miss the first step.
        law.priorTime = 1
    simulation.ConfigureStopTime(macros.sec2nano(duration))
    simulation.ExecuteSimulation()
    return np.column_stack([record.times() * macros.NANO2SEC, record.sigma_BN, record.omega_BN_B])


def controlled(simulation, nano, mothercraft, name, law):
    """Reference, tracking error and law in the control task; what must be kept alive."""
    (body, navigation, _), (other, _, _) = nano, mothercraft
    error = attTrackingError.attTrackingError()
    if name == "sun":
        reference = inertial3D.inertial3D()
        reference.sigma_R0N = RigidBodyKinematics.C2MRP(SUN_FRAME)
    elif name == "nadir":
        reference = hillPoint.hillPoint()
        reference.transNavInMsg.subscribeTo(navigation.transOutMsg)
        error.sigma_R0R = RigidBodyKinematics.C2MRP(NADIR_IN_HILL)
    else:
        reference = Mission(body.scStateOutMsg, other.scStateOutMsg)
    error.attNavInMsg.subscribeTo(navigation.attOutMsg)
    error.attRefInMsg.subscribeTo(reference.attRefOutMsg)
    law.guidInMsg.subscribeTo(error.attGuidOutMsg)
    for priority, model in ((30, reference), (20, error), (10, law)):
        simulation.AddModelToTask("control", model, priority)
    return [reference, error, law]


def turned_from_outside(simulation, body, law):
    """The law's torque acts on the body as it is."""
    actuator = extForceTorque.ExtForceTorque()
    actuator.cmdTorqueInMsg.subscribeTo(law.cmdTorqueOutMsg)
    body.addDynamicEffector(actuator)
    simulation.AddModelToTask("dynamics", actuator, 110)
    return [actuator]


def turned_by_wheels(simulation, body, law):
    """The law's torque comes from three wheels along the axes of the body, without limits."""
    factory = simIncludeRW.rwFactory()
    for axis in np.eye(3):
        factory.create("custom", axis, Js=WHEEL_INERTIA, useMaxTorque=False, Omega_max=1e12)
    effector = reactionWheelStateEffector.ReactionWheelStateEffector()
    factory.addToSpacecraft("wheels", effector, body)
    motors = rwMotorTorque.rwMotorTorque()
    motors.controlAxes_B = np.eye(3).ravel().tolist()
    message = factory.getConfigMessage()
    motors.rwParamsInMsg.subscribeTo(message)
    motors.vehControlInMsg.subscribeTo(law.cmdTorqueOutMsg)
    effector.rwMotorCmdInMsg.subscribeTo(motors.rwMotorTorqueOutMsg)
    simulation.AddModelToTask("control", motors, 5)
    simulation.AddModelToTask("dynamics", effector, 110)
    return [factory, effector, motors, message]


def vehicle(inertia):
    """The message by which a law is told of the body."""
    payload = messaging.VehicleConfigMsgPayload()
    payload.ISCPntB_B = inertia.ravel().tolist()
    return messaging.VehicleConfigMsg().write(payload)


def document_law():
    """`mrpPD` with the document's gains, told of no inertia: -K sigma_B/R - P omega_B/R."""
    law, message = mrpPD.mrpPD(), vehicle(np.zeros((3, 3)))
    law.K, law.P = K_GAIN, P_GAIN
    law.vehConfigInMsg.subscribeTo(message)
    return law, message


def feedback(integral):
    """`mrpFeedback`, told of the body's inertia: with feed-forward and, if asked for, integral."""
    law, message = mrpFeedback.mrpFeedback(), vehicle(INERTIA)
    law.K, law.P = K_GAIN, P_GAIN
    law.controlLawType = 1
    laws = SETTINGS["beyond"]["laws"]
    law.Ki = 1.0 / (P_GAIN * laws["integral_time_s"]) if integral else -1.0
    law.integralLimit = laws["integral_limit_N_m_s"]
    law.vehConfigInMsg.subscribeTo(message)
    return law, message


def main():
    """Make all runs and write the table."""
    response, mission = (SETTINGS["durations_s"][name] for name in ("response", "mission"))
    runs = {
        "no torque": simulate(response),
        "fixed torque": simulate(response, torque=SETTINGS["fixed_torque_N_m"]),
        "gravity gradient": simulate(response, gravity_gradient=True),
        "sun": simulate(response, control=("sun", document_law)),
        "nadir": simulate(response, control=("nadir", document_law)),
        "mission": simulate(mission, control=("mission", document_law)),
        "sun by wheels": simulate(response, control=("sun", document_law), wheels=True),
        "nadir with feed-forward": simulate(response, control=("nadir", lambda: feedback(False))),
        "nadir with integral": simulate(response, control=("nadir", lambda: feedback(True))),
    }
    lines = ["run,time_s,sigma_1,sigma_2,sigma_3,omega_1,omega_2,omega_3"]
    for name, record in runs.items():
        lines += [",".join([name, *(f"{value:.13g}" for value in row)]) for row in record]
    (HERE / "basilisk-attitude.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
