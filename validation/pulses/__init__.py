"""Measurements of motions: arrival, peak, width, speed and decay of pulses."""
