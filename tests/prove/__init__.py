"""The proof on LinuxCNC, as far as it can be tested without LinuxCNC."""
