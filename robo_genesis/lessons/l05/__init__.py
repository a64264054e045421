"""L05, forward and inverse kinematics, and cameras as sensors."""
