"""What is simulated: beads, contacts, sensors, and the files that describe them."""
