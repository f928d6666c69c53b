"""The proof on LinuxCNC without LinuxCNC: its verdict on records with planted faults, and where it cannot run."""
