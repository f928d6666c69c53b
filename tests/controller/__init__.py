"""`softkin live`: sources are asked against real servers on loopback, and docs/LIVE.md is executed."""
