"""What is read off a motion: arrival, peak, widths, speeds and decay of pulses."""
