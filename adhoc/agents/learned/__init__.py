"""The learned team: what its networks see, the networks, and the robot that follows them."""
