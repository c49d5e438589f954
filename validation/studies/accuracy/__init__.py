"""Speed against error: integrators on fixed tasks, theories against true waves."""
