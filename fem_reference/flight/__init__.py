"""Flights of the sphere after the impact by MuJoCo, a program of rigid bodies by others.

The partner of the reduced flight: another chamber (thin boxes), another contact (a damped spring,
hard and short), another time integration (small fixed steps). Nothing here is shared with it.

Units are mm, ms and g, in which forces are N: in SI the chamber's numbers are too small for
MuJoCo's own thresholds.
"""
