"""A robot arm: its joints, control, kinematics and dynamics, and the laws of its runs."""
