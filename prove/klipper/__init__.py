"""Klipper reads a program without hardware, and writes every step: these are decoded, and compared with the package."""
