"""Columns of relative states and velocity changes in tables, by components in the Hill frame.

The target's Hill frame, also called local-vertical local-horizontal (LVLH), has x radially
outwards, y along the motion and z along the orbit's normal (section 2.1.1).
"""

STATE = ["x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s"]
CHANGE = ["dvx_m_s", "dvy_m_s", "dvz_m_s"]
