"""Time for geometric paths: TOPP-RA under velocity, acceleration and torque limits, and sampling."""
