"""A spacecraft of Basilisk (pip install bsk): reaction wheels turn its y axis, and its camera, along the orbit. wheels.yaml starts it."""
import dmise
import numpy as np
from Basilisk.architecture import messaging
from Basilisk.fswAlgorithms import attTrackingError, hillPoint, mrpFeedback, rwMotorTorque
from Basilisk.simulation import reactionWheelStateEffector, simpleNav, spacecraft
from Basilisk.utilities import RigidBodyKinematics, SimulationBaseClass, macros, simIncludeGravBody, simIncludeRW

INERTIA_KG_M2 = np.diag([90.0, 80.0, 60.0])
gravity, rotors, sim = simIncludeGravBody.gravBodyFactory(), simIncludeRW.rwFactory(), SimulationBaseClass.SimBaseClass()
body, wheels, navigation = spacecraft.Spacecraft(), reactionWheelStateEffector.ReactionWheelStateEffector(), simpleNav.SimpleNav()
guidance, error = hillPoint.hillPoint(), attTrackingError.attTrackingError()
control, motors = mrpFeedback.mrpFeedback(), rwMotorTorque.rwMotorTorque()
body.hub.mHub, body.hub.IHubPntBc_B = 150.0, INERTIA_KG_M2
body.hub.r_CN_NInit, body.hub.v_CN_NInit = [7178137, 0, 0], [0, -1114.3121573, 7368.0457787]
body.hub.sigma_BNInit, body.hub.omega_BN_BInit = [0.35, 0.1, 0.0], [0.01, -0.005, 0.008]
gravity.createEarth().isCentralBody = True
gravity.addBodiesTo(body)
for axis in np.eye(3): rotors.create("Honeywell_HR16", axis, maxMomentum=50.0)
rotors.addToSpacecraft("wheels", wheels, body)
control.K, control.P, control.Ki, motors.controlAxes_B = 2.0, 15.0, -1.0, np.eye(3).ravel()
axes = rotors.getConfigMessage()
inertia = messaging.VehicleConfigMsg().write(messaging.VehicleConfigMsgPayload(ISCPntB_B=INERTIA_KG_M2.ravel()))
for hears, says in ((navigation.scStateInMsg, body.scStateOutMsg), (guidance.transNavInMsg, navigation.transOutMsg),
                    (error.attNavInMsg, navigation.attOutMsg), (error.attRefInMsg, guidance.attRefOutMsg),
                    (control.guidInMsg, error.attGuidOutMsg), (control.vehConfigInMsg, inertia), (motors.rwParamsInMsg, axes),
                    (motors.vehControlInMsg, control.cmdTorqueOutMsg), (wheels.rwMotorCmdInMsg, motors.rwMotorTorqueOutMsg)):
    hears.subscribeTo(says)
sim.CreateNewProcess("all").addTask(sim.CreateNewTask("all", macros.sec2nano(0.1)))
for model in (wheels, body, navigation, guidance, error, control, motors): sim.AddModelToTask("all", model)
sim.InitializeSimulation()

@dmise.actor("inspector")
def turned(t_s, world, options):
    sim.ConfigureStopTime(macros.sec2nano(t_s))
    sim.ExecuteSimulation()
    now = body.scStateOutMsg.read()
    return dmise.State(position_m=now.r_BN_N, velocity_m_per_s=now.v_BN_N, gcrs_from_body=RigidBodyKinematics.MRP2EP(now.sigma_BN),
                       rate_rad_per_s=RigidBodyKinematics.MRP2C(now.sigma_BN).T @ now.omega_BN_B)
dmise.serve(turned)
